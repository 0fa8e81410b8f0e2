# The targets afm::core and afm::dynamics of an installed package or a devel space: the package config without ROS, and an extra of catkin's config.
if(EXISTS ${afm_emulator_DIR}/afm_targets.cmake AND NOT TARGET afm::core)
  include(CMakeFindDependencyMacro)
  find_dependency(Threads)
  find_dependency(Eigen3)
  include(${afm_emulator_DIR}/afm_targets.cmake)
endif()
