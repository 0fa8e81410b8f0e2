# Of the package without ROS: the targets afm::core and afm::dynamics.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3)
include(${CMAKE_CURRENT_LIST_DIR}/afm_targets.cmake)
