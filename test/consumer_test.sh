#!/usr/bin/env bash
# The examples in C++, copied out of the tree: they find the installed package, or that of the devel space, and give the
# same bits as within the tree, also where they are compiled for the machine at hand.
#
# usage: consumer_test.sh BUILD DEVEL EXAMPLES PROGRAM...
#   DEVEL: the devel space, empty without ROS; EXAMPLES: their folder; PROGRAM: each of them, compiled within the tree
set -euo pipefail
export PATH=/usr/bin:/bin:$PATH  # another python3 may be first
build=$1 devel=$2 examples=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/expected"

[[ $# -eq $(find "$examples" -name '*.cpp' | wc -l) ]] || { echo "not every example is tested"; exit 1; }
cp -r --no-preserve=mode "$examples" "$work/source"  # the tree may be read-only
# as a workspace without a build type installs it
cmake -DCMAKE_INSTALL_CONFIG_NAME= -DCMAKE_INSTALL_PREFIX="$work/prefix" -P "$build/cmake_install.cmake" >"$work/log" \
  2>&1 || { cat "$work/log"; exit 1; }
if grep -v "^$work/prefix/" "$build/install_manifest.txt"; then
  echo "these were installed outside the prefix"
  exit 1
fi
for program in "$@"; do
  "$program" >"$work/expected/${program##*/}"
done
# build_in FOLDER SOURCE PREFIX TARGET CMAKE_ARGUMENT...
build_in() {
  local folder=$work/$1 source=$2 prefix=$3 target=$4
  shift 4
  if ! { cmake -S "$source" -B "$folder" -DCMAKE_PREFIX_PATH="$prefix" "$@" &&
    cmake --build "$folder" --target "$target" --parallel 2; } >"$work/log" 2>&1; then
    cat "$work/log"
    exit 1
  fi
}

# compare FOLDER [PROGRAM]: all of them, or one
compare() {
  local expected
  for expected in "$work/expected/"*"${2:-}"; do
    name=${expected##*/}
    if ! "$work/$1/${name#afm_example_}" | cmp - "$expected"; then
      echo "$1: $name: the bits differ"
      exit 1
    fi
  done
}

build_in installed "$work/source" "$work/prefix" all -DCMAKE_CXX_FLAGS="-march=native"
compare installed
# the core needs no Eigen; and without optimization the bits are the same
mkdir "$work/core"
cp "$work/source/one_tip.cpp" "$work/core"
cat >"$work/core/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(core_alone LANGUAGES CXX)
find_package(afm_emulator 0.2 REQUIRED)
add_executable(one_tip one_tip.cpp)
target_link_libraries(one_tip PRIVATE afm::core)
END
build_in core_alone "$work/core" "$work/prefix" one_tip -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON
compare core_alone one_tip
# a version that is still to come is refused
sed -i 's/afm_emulator 0.2/afm_emulator 99.0/' "$work/core/CMakeLists.txt"
for prefix in "$work/prefix" ${devel:+"$devel"}; do
  if cmake -S "$work/core" -B "$work/core_alone" -DCMAKE_PREFIX_PATH="$prefix" -Uafm_emulator_DIR >"$work/log" 2>&1 ||
    ! grep -q "version: 0\.2" "$work/log"; then
    echo "version 99.0 is not refused in favour of ours"
    exit 1
  fi
done

if [[ -n $devel ]]; then
  build_in devel "$work/source" "$devel" one_tip -DCMAKE_BUILD_TYPE=Debug
  compare devel one_tip
  # another package of catkin
  mkdir "$work/package"
  cp "$work/source/"{one_tip,periodic_orbit}.cpp "$work/package"
  cat >"$work/package/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(neighbour LANGUAGES CXX)
find_package(catkin REQUIRED COMPONENTS afm_emulator)
add_executable(one_tip one_tip.cpp)
target_link_libraries(one_tip PRIVATE afm::core)
add_executable(periodic_orbit periodic_orbit.cpp)
target_link_libraries(periodic_orbit PRIVATE ${catkin_LIBRARIES})  # which were files, without the flags for the bits
target_include_directories(periodic_orbit PRIVATE ${catkin_INCLUDE_DIRS})
END
  build_in neighbour "$work/package" "$devel" all -DCMAKE_CXX_FLAGS="-O3 -march=native"
  compare neighbour one_tip
  compare neighbour periodic_orbit
fi
# an installed tool knows the levers beside it, not those of the sources
cp "$work/prefix/share/afm_emulator/config/levers/"{ppp_cont,mine}.yaml
"$(find "$work/prefix" -name friction_curve -type f)" --si --lever nobody >"$work/log" 2>&1 || true
grep -q " mine" "$work/log" || { cat "$work/log"; exit 1; }
# the module of Python is installed too, where it was built
if [[ -d $work/prefix/lib/python3/dist-packages/afm ]]; then
  PYTHONPATH=$work/prefix/lib/python3/dist-packages /usr/bin/python3 -c "
import afm
assert afm.__file__.startswith('$work'), afm.__file__"
fi
wc -l "$work"/expected/*
echo "the same bits"
