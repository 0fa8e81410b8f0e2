#!/usr/bin/env bash
# A project outside the tree finds the installed package and gets the same bits as one within, also where it is compiled for
# the machine at hand.
#
# usage: consumer_test.sh BUILD PROGRAM     PROGRAM: consumer/main.cpp, compiled within the tree
set -euo pipefail
build=$1 program=$2
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/consumer" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$program" >"$work/expected"
for flags in -O2 "-O3 -march=native"; do
  if ! { cmake -S "$source" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_FLAGS="$flags" &&
    cmake --build "$work/build" --clean-first; } >"$work/log" 2>&1; then
    cat "$work/log"
    exit 1
  fi
  if ! "$work/build/consumer" | cmp - "$work/expected"; then
    echo "with $flags the bits differ"
    exit 1
  fi
done
echo "$(wc -l <"$work/expected") impacts: the same bits"
