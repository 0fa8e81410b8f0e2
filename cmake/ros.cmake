# What catkin adds: messages, and the package's own CMake files.
find_package(catkin REQUIRED COMPONENTS
  diagnostic_msgs diagnostic_updater dynamic_reconfigure geometry_msgs message_generation rosbag roscpp std_msgs std_srvs
  visualization_msgs)

add_message_files(FILES
  AppliedDrag.msg
  AppliedParameters.msg
  Checkpoint.msg
  Configuration.msg
  Deflection.msg
  Digest.msg
  EmulatorStatus.msg
  Friction.msg
  Impact.msg
  ImpactArray.msg
  ModelTime.msg
  Recording.msg)
add_service_files(FILES StartRecording.srv Step.srv)
generate_messages(DEPENDENCIES std_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES afm_emulator_core afm_emulator_dynamics
  CFG_EXTRAS afm_targets_here.cmake
  DEPENDS EIGEN3
  CATKIN_DEPENDS diagnostic_msgs diagnostic_updater dynamic_reconfigure geometry_msgs message_runtime rosbag roscpp std_msgs
  std_srvs visualization_msgs)
