#!/usr/bin/env bash
# examples/my_controller in a workspace of its own, as a user has it: its rostests pass. With the wrong sign of the
# gain one fails, with a sentence, a picture, and a bag that replay_check calls identical.
# usage: my_controller_test.sh SOURCE_DIRECTORY DEVEL_DIRECTORY
set -euo pipefail
source_directory=$1 devel=$2
workspace=$(mktemp -d)
trap 'rm -rf "$workspace"' EXIT
mkdir "$workspace/src"
cp -r "$source_directory/examples/my_controller" "$workspace/src"
cd "$workspace"
export ROS_HOME=$workspace/home ROS_HOSTNAME=localhost PATH=/usr/bin:/bin:$PATH
set +u
# shellcheck disable=SC1091
source "$devel/setup.bash"
set -u

# usage: tests TARGET
tests() {
  rm -rf build/test_results
  catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3 "$1" >log 2>&1 || { cat log; exit 1; }
  catkin_test_results build/test_results
}

tests run_tests_my_controller || { cat log; exit 1; }
sed -i 's/height - gain/height + gain/' src/my_controller/scripts/my_controller
if tests run_tests_my_controller_rostest_test_holds_force.test >verdict; then
  echo "the wrong sign of the gain passes"
  exit 1
fi
grep -rhom1 'friction/mean_lateral_force = [-0-9.e]* at model time [0-9.]* s: expected [^.]*' build/test_results |
  head -1 | grep . || { echo "no sentence says what failed"; cat log; exit 1; }
picture=$(find build/test_results -name '*.png')
[[ -n $picture ]] || { echo "no picture"; exit 1; }
bag=$(grep -rhoE 'the bag that repeats it: [^ <]*\.bag' build/test_results | head -1 | sed 's/.*: //')
rosrun afm_emulator replay_check "$bag"
