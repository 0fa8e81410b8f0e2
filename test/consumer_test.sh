#!/usr/bin/env bash
# The examples in C++, copied out of the tree: they find the installed package, and give the same bits as within the tree, also
# where they are compiled for the machine at hand.
#
# usage: consumer_test.sh BUILD EXAMPLES PROGRAM...     EXAMPLES: their folder; PROGRAM: each of them, compiled within the tree
set -euo pipefail
build=$1 examples=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/expected"

[[ $# -eq $(find "$examples" -name '*.cpp' | wc -l) ]] || { echo "not every example is tested"; exit 1; }
cp -r "$examples" "$work/source"
cmake --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
for program in "$@"; do
  "$program" >"$work/expected/${program##*/}"
done
for flags in -O2 "-O3 -march=native"; do
  if ! { cmake -S "$work/source" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_FLAGS="$flags" &&
    cmake --build "$work/build" --clean-first --parallel 2; } >"$work/log" 2>&1; then
    cat "$work/log"
    exit 1
  fi
  for expected in "$work"/expected/*; do
    name=${expected##*/}
    if ! "$work/build/${name#example_}" | cmp - "$expected"; then
      echo "$name: with $flags the bits differ"
      exit 1
    fi
  done
done
# the module of Python is installed too, where it was built
if [[ -d $work/prefix/lib/python3/dist-packages/afm ]]; then
  PYTHONPATH=$work/prefix/lib/python3/dist-packages /usr/bin/python3 -c "
import afm
assert afm.__file__.startswith('$work'), afm.__file__"
fi
wc -l "$work"/expected/*
echo "the same bits"
