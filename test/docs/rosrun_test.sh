#!/usr/bin/env bash
# In a shell that has nothing but devel/setup.bash, rosrun finds the tools.
#
# usage: rosrun_test.sh PREFIX [TOOL...]
set -euo pipefail
prefix=$1
shift
if [[ ! -x $prefix/lib/afm_emulator/emulator_node ]]; then
  echo "nothing is built in $prefix"
  exit 77
fi
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
failed=0
for tool in "$@"; do
  # shellcheck disable=SC2016  # for the shell without anything
  if ! env -i HOME="$home" PATH=/usr/bin:/bin:/usr/sbin:/sbin bash --norc --noprofile -c \
    'source "$0/setup.bash"; rosrun afm_emulator "$1" --help' "$prefix" "$tool" >"$home/help" 2>&1; then
    echo "rosrun afm_emulator $tool --help fails:"
    cat "$home/help"
    failed=1
  fi
done
exit "$failed"
