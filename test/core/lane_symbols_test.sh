#!/usr/bin/env bash
# Files compiled for newer machines than the rest must share no code with it: of an inline function that both define the
# linker keeps either, and the program would stop on an older machine. Of each object given, one function may be seen
# outside.
set -euo pipefail

failed=0
for object in "$@"; do
  # T: a function of its own; W, V, u: shared. DW.ref names a function of the C++ library, and holds no code
  seen=$(nm --demangle --defined-only "$object" | grep -E '^[0-9a-f]+ [A-Z] |^[0-9a-f]+ [vwui] ' | grep -v ' V DW\.ref\.' || true)
  count=$(grep -c . <<<"$seen" || true)
  if [[ $count -ne 1 || ! $seen =~ " T afm::lanes::"sample_ ]]; then
    printf '%s\nmust show one function, afm::lanes::sample_*, and shows\n%s\n' "$object" "$seen"
    failed=1
  fi
done
exit "$failed"
