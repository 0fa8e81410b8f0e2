# The targets afm::core and afm::dynamics of an installed package or a devel space: the package config without ROS, and an
# extra of catkin's config.
if(EXISTS ${afm_emulator_DIR}/afm_core.cmake AND NOT TARGET afm::core)
  include(CMakeFindDependencyMacro)
  find_dependency(Threads)
  include(${afm_emulator_DIR}/afm_core.cmake)
  find_package(Eigen3 QUIET NO_MODULE)
  if(TARGET Eigen3::Eigen)
    include(${afm_emulator_DIR}/afm_dynamics.cmake)
  else()
    message(STATUS "afm_emulator: no Eigen (Debian: libeigen3-dev), so there is no target afm::dynamics")
  endif()
endif()
