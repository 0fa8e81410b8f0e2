#!/usr/bin/env bash
# `pip install .` gives the module, in an environment of its own and without a network.
#
# usage: pip_test.sh ROOT BUILD PYTHON     BUILD: a directory that is kept, so that the next run builds only what changed
set -euo pipefail
root=$1 build=$2 python=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if ! "$python" -m pip --version >/dev/null 2>&1; then
  echo "pip is not installed"
  exit 77
fi
# that it builds is the question, not how fast it runs
if ! AFM_WHEEL_BUILD=$build CMAKE_ARGS="-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DCMAKE_C_FLAGS_RELEASE=-O0" "$python" -m pip install --no-index --no-deps --target "$work/site" "$root" >"$work/log" 2>&1; then
  tail -n 40 "$work/log"
  exit 1
fi
# what is missing is said in a sentence
if PYTHONPATH=$root/python "$python" -c "
import build_wheel
build_wheel.configure('$work/without', '-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON')" >"$work/log" 2>&1; then
  echo "without pybind11 nothing is said"
  exit 1
fi
grep -q '^afm_emulator: pybind11 .* were not found' "$work/log" || { cat "$work/log"; exit 1; }
if grep -q Traceback "$work/log"; then cat "$work/log"; exit 1; fi
cd "$work"
PYTHONPATH=$work/site "$python" -c "
import afm
assert afm.__file__.startswith('$work/site'), afm.__file__
print(afm.__version__, len(afm.Tip().advance(100)), 'events')"
ls "$work/site"/afm_emulator-*.dist-info/RECORD "$work/site/afm/py.typed"
