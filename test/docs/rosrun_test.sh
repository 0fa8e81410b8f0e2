#!/usr/bin/env bash
# In a shell that has nothing but devel/setup.bash, rosrun finds the tools, and the tab key completes their names and
# options.
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

# usage: clean_shell SCRIPT WORD...: with the words as its arguments
clean_shell() {
  local script=$1
  shift
  env -i HOME="$home" PATH=/usr/bin:/bin:/usr/sbin:/sbin bash --norc --noprofile -c "source \"\$0/setup.bash\"; $script" \
    "$prefix" "$@"
}

# usage: completed WORD...: what the tab key offers for the last of the words, a line each, by the function that bash
# would call
completed() {
  clean_shell '
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    function=$(complete -p "${1##*/}" | sed -E "s/.* -F ([^ ]+) .*/\1/")
    previous=${COMP_WORDS[COMP_CWORD - 1]}
    "$function" "$1" "${COMP_WORDS[COMP_CWORD]}" "$previous" && printf "%s\n" "${COMPREPLY[@]}"' "$@"
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
for tool in "$@"; do
  if ! clean_shell 'rosrun afm_emulator "$1" --help' "$tool" >"$home/help" 2>&1; then
    echo "rosrun afm_emulator $tool --help fails:"
    cat "$home/help"
    failed=1
  fi
  # by rosbash, where it is installed
  if [[ -f /usr/share/bash-completion/completions/rosbash || -f /opt/ros/noetic/share/rosbash/rosbash ]]; then
    expect "$tool" rosrun afm_emulator "${tool:0:-1}"
  fi
done
exit "$failed"
