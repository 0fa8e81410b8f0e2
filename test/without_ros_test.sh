#!/usr/bin/env bash
# Without ROS, Eigen and the laboratory the tree gives the core and the tools of the emulator that need no bag.
#
# usage: without_ros_test.sh ROOT BUILD     BUILD: a directory that is kept, so that the next run builds only what changed
set -euo pipefail
root=$1 build=$2
mkdir -p "$build"
if ! { cmake -S "$root" -B "$build" -DAFM_ROS=OFF -DAFM_DYNAMICS=OFF -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=Release &&
  cmake --build "$build" --target afm_next_impact afm_friction_curve --parallel 2; } >"$build/log" 2>&1; then
  tail -n 30 "$build/log"
  exit 1
fi
cut -d, -f1-7 "$root/test/data/next_impact.csv" | "$build/bin/next_impact" >"$build/impacts.csv"
lines=$(wc -l <"$build/impacts.csv")
[[ $lines -gt 100 ]] || { echo "only $lines lines of impacts"; exit 1; }
echo "$lines lines of impacts"
"$build/bin/friction_curve" --eta 2:3:0.5 --duration 100 --transient 100 >"$build/curve.csv"
[[ $(grep -c ',nan,unknown,' "$build/curve.csv") -eq 3 ]] || { echo "not the curve of three points"; cat "$build/curve.csv"; exit 1; }
