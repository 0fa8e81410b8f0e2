#!/usr/bin/env bash
# The tab key completes options in a shell that has nothing but devel/setup.bash.
#
# usage: completion_test.sh PREFIX
set -euo pipefail
prefix=$1
if [[ ! -x $prefix/lib/afm_emulator/friction_curve ]]; then
  echo "nothing is built in $prefix"
  exit 77
fi
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
failed=0

# usage: completed WORD...: what the tab key offers for the last of the words, a line each, by the function that bash would call
completed() {
  env -i HOME="$home" PATH=/usr/bin:/bin bash --norc --noprofile -c '
    source "$0/setup.bash"
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    function=$(complete -p "${1##*/}" | sed -E "s/.* -F ([^ ]+) .*/\1/")
    previous=${COMP_WORDS[COMP_CWORD - 1]}
    "$function" "$1" "${COMP_WORDS[COMP_CWORD]}" "$previous" && printf "%s\n" "${COMPREPLY[@]}"' "$prefix" "$@"
}

# usage: expect OFFERED WORD...: it is among what is offered for the words
expect() {
  local wanted=$1 offered
  shift
  offered=$(completed "$@" || true)
  if ! grep -qx -- "$wanted" <<<"$offered"; then
    echo "$*<TAB> does not offer $wanted, but:"
    echo "$offered"
    failed=1
  fi
}

expect --temperature rosrun afm_emulator friction_curve --te
expect --si rosrun afm_emulator friction_curve --eta 2 --
expect --topic rosrun afm_emulator bag_to_csv run.bag --t
expect --gamma "$prefix/lib/afm_emulator/periodic_orbits" --g
if [[ -n $(completed rosrun afm_emulator friction_curve --no-such) ]]; then
  echo "an option is offered that does not exist"
  failed=1
fi
if [[ -f /usr/share/bash-completion/completions/rosbash ]]; then
  expect friction_curve rosrun afm_emulator friction_cur  # what rosbash completes stays
fi
exit "$failed"
