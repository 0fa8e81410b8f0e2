#!/usr/bin/env bash
# What others build beside us stays theirs: their targets' names, their Python, their kind of build, their warnings.
# Only configures: once within another project, and where there is catkin twice in a workspace with a neighbour.
#
# usage: neighbours_test.sh ROOT [CATKIN]     CATKIN: its share directory; none without ROS
set -euo pipefail
export PATH=/usr/bin:/bin:$PATH  # another python3 may be first
export ROS_LANG_DISABLE=genlisp:geneus:gennodejs:genpy  # whatever languages messages are generated for
root=$1 catkin=${2:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "neighbours_test: $1" >&2
  cat "$work/log" >&2
  exit 1
}

# configure SOURCE CMAKE_ARGUMENT...
configure() {
  cmake -S "$1" -B "$1/build" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "${@:2}" >"$work/log" 2>&1 || fail "cmake failed"
}

# theirs NAME: a project whose targets have names of ours
theirs() {
  cat <<END
cmake_minimum_required(VERSION 3.16)
project($1 LANGUAGES CXX)
message(STATUS "$1: kind of build '\${CMAKE_BUILD_TYPE}'")
file(WRITE \${CMAKE_CURRENT_BINARY_DIR}/main.cpp "int main() {}")
foreach(name emulator emulator_node friction_curve hold_force stress tip_test)
  add_executable(\${name} \${CMAKE_CURRENT_BINARY_DIR}/main.cpp)
endforeach()
END
}

# within another project
mkdir "$work/project"
{
  theirs project
  echo "enable_testing()"
  echo "add_custom_target(tests)"
  echo "add_subdirectory(\"$root\" afm_emulator)"
  echo "target_link_libraries(stress PRIVATE afm::core)"
} >"$work/project/CMakeLists.txt"
configure "$work/project" -DAFM_ROS=OFF
cache=$work/project/build/CMakeCache.txt
! grep -E '^(PYTHON_EXECUTABLE|Python3_EXECUTABLE|BUILD_TESTING)' "$cache" || fail "these came into the cache"
grep -q '^CMAKE_BUILD_TYPE:STRING=$' "$cache" || fail "another kind of build: $(grep ^CMAKE_BUILD_TYPE "$cache")"
commands=$(grep '"command".*stress' "$work/project/build/compile_commands.json")
[[ $commands == *-ffp-contract=off* ]] || fail "without the option that the bits need: $commands"
[[ $commands != *-Wconversion* ]] || fail "with our warnings: $commands"
! grep -q "install($root" "$work/project/build/afm_emulator/cmake_install.cmake" || fail "something of ours would be installed"
configure "$work/project" -DAFM_ROS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON

if [[ ! -e $catkin/cmake/toplevel.cmake ]]; then
  exit
fi

# in a workspace, where one CMake configures all
toplevel=$catkin/cmake/toplevel.cmake
mkdir -p "$work/workspace/neighbour"
cp "$toplevel" "$work/workspace/CMakeLists.txt"
ln -s "$root" "$work/workspace/afm_emulator"
theirs neighbour >"$work/workspace/neighbour/CMakeLists.txt"
echo "find_package(catkin REQUIRED)
catkin_package()" >>"$work/workspace/neighbour/CMakeLists.txt"
cat >"$work/workspace/neighbour/package.xml" <<'END'
<package format="2"><name>neighbour</name><version>0.0.1</version><description>.</description>
<maintainer email="a@b.example">a</maintainer><license>BSD</license><buildtool_depend>catkin</buildtool_depend>
<depend>afm_emulator</depend></package>
END
for time in first second; do
  configure "$work/workspace" -DCATKIN_ENABLE_TESTING=ON
  grep -q "neighbour: kind of build ''" "$work/log" || fail "the $time time the neighbour is configured as ours"
  grep -q "^CMAKE_BUILD_TYPE:STRING=$" "$work/workspace/build/CMakeCache.txt" || fail "the cache has our kind of build"
done
grep '"command".*src/core/tip/tip.cpp' "$work/workspace/build/compile_commands.json" | grep -qe '-O3' || fail "ours is not optimised"

# a package of a workspace that takes the libraries into itself
mkdir -p "$work/other/taker"
cp "$toplevel" "$work/other/CMakeLists.txt"
{
  theirs taker
  echo "find_package(catkin REQUIRED)
catkin_package()
add_subdirectory(\"$root\" afm_emulator)
target_link_libraries(stress PRIVATE afm::core)"
} >"$work/other/taker/CMakeLists.txt"
sed 's/neighbour/taker/; s/<depend>.*depend>//' "$work/workspace/neighbour/package.xml" >"$work/other/taker/package.xml"
configure "$work/other"
