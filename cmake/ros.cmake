# What catkin adds: messages, and the package's own CMake files.
find_package(catkin REQUIRED COMPONENTS
  diagnostic_msgs diagnostic_updater dynamic_reconfigure geometry_msgs message_generation rosbag roscpp rosgraph_msgs
  std_msgs std_srvs
  visualization_msgs)

catkin_python_setup()  # python/client: the client library

add_message_files(FILES
  Applied.msg
  Configuration.msg
  Deflection.msg
  EmulatorStatus.msg
  Friction.msg
  Impact.msg
  ImpactArray.msg
  ModelTime.msg
  Snapshot.msg)
add_service_files(FILES Control.srv StartRecording.srv Step.srv)
generate_messages(DEPENDENCIES std_msgs)
generate_dynamic_reconfigure_options(config/Emulator.cfg)

if(AFM_DYNAMICS)
  set(afm_dynamics_exports INCLUDE_DIRS include dynamics/include LIBRARIES afm_emulator_core afm_emulator_dynamics
    DEPENDS EIGEN3)
else()
  set(afm_dynamics_exports INCLUDE_DIRS include LIBRARIES afm_emulator_core)
endif()
catkin_package(
  ${afm_dynamics_exports}
  CFG_EXTRAS afm_targets_here.cmake
  CATKIN_DEPENDS diagnostic_msgs diagnostic_updater dynamic_reconfigure geometry_msgs message_runtime rosbag roscpp
  rosgraph_msgs std_msgs std_srvs visualization_msgs)
