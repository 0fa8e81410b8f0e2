#!/usr/bin/env bash
# rosrun completes and finds the tools in a shell that has nothing but devel/setup.bash.
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

clean_shell() {
  env -i HOME="$home" PATH=/usr/bin:/bin:/usr/sbin:/sbin bash --norc --noprofile -c "source '$prefix/setup.bash' && $1"
}

failed=0
for tool in "$@"; do
  if ! clean_shell "rosrun afm_emulator $tool --help" >"$home/help" 2>&1; then
    echo "rosrun afm_emulator $tool --help fails:"
    cat "$home/help"
    failed=1
  fi
done

completions=
for file in /usr/share/bash-completion/completions/rosbash /opt/ros/noetic/share/rosbash/rosbash; do
  if [[ -f $file ]]; then
    completions=$file
  fi
done
if [[ -z $completions ]]; then
  echo "rosbash is not installed: completion is not tested"
  exit "$failed"
fi

# usage: completed PREFIX_OF_WORD: what the tab key offers after `rosrun afm_emulator`, a line each
completed() {
  clean_shell "source '$completions' && COMP_WORDS=(rosrun afm_emulator '$1') COMP_CWORD=2 && _roscomplete_exe;
    printf '%s\n' \"\${COMPREPLY[@]}\""
}

offered=$(completed '')
for tool in emulator_node "$@"; do
  if ! grep -qx "$tool" <<<"$offered"; then
    echo "rosrun afm_emulator <TAB> does not offer $tool, but:"
    echo "$offered"
    failed=1
  fi
  if [[ $(completed "${tool:0:-1}") != *"$tool"* ]]; then
    echo "rosrun afm_emulator ${tool:0:-1}<TAB> does not complete $tool"
    failed=1
  fi
done
exit "$failed"
