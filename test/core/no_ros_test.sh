#!/usr/bin/env bash
# The core names no ROS header. The compiler would not notice: some systems keep ROS headers where it always looks.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

ros_include='#[[:space:]]*include[[:space:]]*[<"](ros|rosbag|std_msgs|std_srvs|diagnostic_[a-z]+|dynamic_reconfigure)/|#[[:space:]]*include[[:space:]]*[<"]afm_emulator/[A-Z]'

# the pattern works: it finds what the node includes
if ! grep -rqE "$ros_include" src/node; then
  echo "no ROS include found in src/node: the pattern of this test no longer fits"
  exit 1
fi

# grep: 0 found, 1 not found, 2 could not look
found=0
grep -rnE "$ros_include" include/afm src/core test/core test/support --include='*.h' --include='*.cpp' || found=$?
case $found in
  0) echo "ROS includes in the core (listed above)"; exit 1 ;;
  1) echo "no ROS include in include/afm, src/core, test/core" ;;
  *) exit "$found" ;;
esac
