# Sourced by the scripts beside it: where things are, and an environment in which ROS's tools work.
# shellcheck disable=SC2034  # the variables are used where this is sourced

# without symbolic links: cmake must find the paths of the build before, whichever way it is called
afm_root=$(CDPATH='' cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
scripts=$afm_root/scripts
if [[ -n ${AFM_BUILD_DIR:-} ]]; then
  AFM_BUILD_DIR=$(realpath -m "$AFM_BUILD_DIR")
  export AFM_BUILD_DIR
fi
afm_build=${AFM_BUILD_DIR:-$afm_root/build}
# what is sourced: rosrun finds no executable below PACKAGE/build, and roslaunch finds files of an install space below
# the package twice
afm_devel=${AFM_BUILD_DIR:-$afm_root}/devel

# another python3 may be first on PATH (pyenv, conda); ROS's modules belong to the system's
export PATH=/usr/bin:/bin:$PATH

# everything talks over loopback unless the user has said otherwise; a host's own name may not resolve
if [[ -z ${ROS_IP:-} ]]; then
  export ROS_HOSTNAME=${ROS_HOSTNAME:-localhost}
fi
export ROS_MASTER_URI=${ROS_MASTER_URI:-http://localhost:11311}

# logs and bags need a home that can be written to
if [[ ! -w ${HOME:-/nonexistent} ]]; then
  export ROS_HOME=${ROS_HOME:-$afm_build/ros_home}
fi

# the comment at the head of a script is its help
print_help() {
  awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
}

# from here on, unless the user has said otherwise: roscpp binds every node's slave API to all interfaces. By its name
# alone: LD_PRELOAD ends a path at a space
listen_on_loopback_only() {
  if [[ -z ${ROS_IP:-} && $ROS_HOSTNAME == localhost ]]; then
    export LD_PRELOAD=libafm_loopback.so${LD_PRELOAD:+:$LD_PRELOAD}
    export LD_LIBRARY_PATH=$afm_devel/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
  fi
}

# ROS's and our own setup files use unset variables
source_setup() {
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}

if [[ -f /opt/ros/noetic/setup.bash ]]; then
  source_setup /opt/ros/noetic/setup.bash
fi
