#!/usr/bin/env bash
# Without ROS, Eigen and the laboratory the tree gives the core and the tools of the emulator that need no bag. And `pip
# install .` gives the Python module from the same build, in an environment of its own and without a network.
#
# usage: without_ros_test.sh ROOT BUILD [PYTHON]    BUILD: a directory that is kept, so that the next run builds only what changed;
#   PYTHON: of the module; none where that is not built
set -euo pipefail
root=$1 build=$2 python=${3:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# that it builds is the question, not how fast it runs
arguments=(-DAFM_DYNAMICS=OFF -DCMAKE_CXX_FLAGS_RELEASE=-O0 -DCMAKE_C_FLAGS_RELEASE=-O0 -DCMAKE_UNITY_BUILD=ON
  -DCMAKE_UNITY_BUILD_BATCH_SIZE=100)

# run COMMAND...: what it prints only if it fails
run() {
  if ! "$@" >"$work/log" 2>&1; then
    tail -n 40 "$work/log"
    exit 1
  fi
}

tools() {
  run cmake -S "$root" -B "$build" -DAFM_ROS=OFF -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=Release "${arguments[@]}"
  run cmake --build "$build" --target afm_next_impact afm_friction_curve --parallel 2
  cut -d, -f1-7 "$root/test/data/next_impact.csv" | "$build/bin/next_impact" >"$work/impacts.csv"
  lines=$(wc -l <"$work/impacts.csv")
  [[ $lines -gt 100 ]] || { echo "only $lines lines of impacts"; exit 1; }
  echo "$lines lines of impacts"
  "$build/bin/friction_curve" --eta 2:3:0.5 --duration 100 --transient 100 >"$work/curve.csv"
  [[ $(grep -c ',nan,unknown,' "$work/curve.csv") -eq 3 ]] || { echo "not the curve of three points"; cat "$work/curve.csv"; exit 1; }
}

by_pip() {
  AFM_WHEEL_BUILD=$build CMAKE_ARGS="${arguments[*]}" run "$python" -m pip install --no-index --no-deps --target "$work/site" "$root"
  # what is missing is said in a sentence
  if PYTHONPATH=$root/python "$python" -c "
import build_wheel
build_wheel.configure('$work/without', '-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON')" >"$work/log" 2>&1; then
    echo "without pybind11 nothing is said"
    exit 1
  fi
  grep -q '^afm_emulator: pybind11 .* were not found' "$work/log" || { cat "$work/log"; exit 1; }
  if grep -q Traceback "$work/log"; then cat "$work/log"; exit 1; fi
  # by itself it is built with the laboratory
  grep -qx 'AFM_DYNAMICS:BOOL=ON' "$work/without/CMakeCache.txt"
  cd "$work"
  PYTHONPATH=$work/site "$python" -c "
import afm
assert afm.__file__.startswith('$work/site'), afm.__file__
print(afm.__version__, len(afm.Tip().advance(100)), 'events')
try:
    afm.lyapunov()
except NotImplementedError as error:
    print(error)
else:
    raise AssertionError('the laboratory is there')"
  ls "$work/site"/afm_emulator-*.dist-info/RECORD "$work/site/afm/py.typed"
}

tools
if [[ -z $python ]]; then
  exit
fi
if ! "$python" -m pip --version >/dev/null 2>&1; then
  echo "pip is not installed: what it makes is not tested"
  exit
fi
by_pip
