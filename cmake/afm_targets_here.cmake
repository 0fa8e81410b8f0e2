# Included by the package's config of catkin where it is installed: the targets afm::core and afm::dynamics.
if(EXISTS ${afm_emulator_DIR}/afm_targets.cmake AND NOT TARGET afm::core)
  include(CMakeFindDependencyMacro)
  find_dependency(Threads)
  find_dependency(Eigen3)
  include(${afm_emulator_DIR}/afm_targets.cmake)
endif()
