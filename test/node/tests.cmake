# The node, run as a user runs it, and those of its parts that need no master.

# node/NAME_test.py: the files of a line run one after another with one master, as the rostest of the first name
set(node_tests
  "client"
  "steering reset_pause_step"
  "ending shutdown examples"
  "expect"
  "faults replay"
  "load"
  "lockstep levels diagnostics"
  "panel"
  "recording full_disk repeats"
  "scenes"
  "shipped_files bad_parameters loopback lever"
  "spoiled_bags bag_to_csv"
  "view interface")
set(needed afm_emulator_node afm_view_node afm_examples_ros afm_replay_check afm_bag_to_csv)
if(TARGET afm_python_module)  # where it is built
  list(APPEND node_tests "python_module")
  list(APPEND needed afm_python)
endif()
foreach(suite IN LISTS node_tests)
  string(REGEX MATCH "^[a-z_]+" name ${suite})
  configure_file(node/suite.test.in node/${name}.test @ONLY)
  get_property(before DIRECTORY PROPERTY TESTS)
  add_rostest(${CMAKE_CURRENT_BINARY_DIR}/node/${name}.test DEPENDENCIES ${needed})
  get_property(test DIRECTORY PROPERTY TESTS)  # sorted; the name of the new one depends on where the build directory is
  list(REMOVE_ITEM test ${before})
  set_tests_properties(${test} PROPERTIES TIMEOUT 300)
  if(name STREQUAL load)  # keeps every core busy: what ran beside it would starve
    set_tests_properties(${test} PROPERTIES RUN_SERIAL TRUE)
  endif()
endforeach()

# nodes to copy have tests of their own, as a user writes them
foreach(arguments "hold_force.test language:=python" "hold_force.test language:=cpp" "hold_force.test pace:=real_time"
        "seek_peak.test" "seek_peak.test start:=7.3e-6")
  separate_arguments(arguments)
  list(POP_FRONT arguments file)
  add_rostest(${PROJECT_SOURCE_DIR}/examples/ros/test/${file} ARGS ${arguments}
    DEPENDENCIES afm_emulator_node afm_examples_ros)
endforeach()

# node/NAME_test.cpp: parts of the node that need no master
foreach(name diagnosis messages parameters recorder runner)
  afm_add_gtest(${name}_test node/${name}_test.cpp)
  target_include_directories(afm_${name}_test SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_link_libraries(afm_${name}_test afm_emulator_ros)
  set_tests_properties(${gtest_prefix}${name}_test PROPERTIES TIMEOUT 60)
endforeach()
target_compile_definitions(afm_parameters_test PRIVATE AFM_CONFIG="${PROJECT_SOURCE_DIR}/config")

# preloaded by the faults' test
add_library(afm_disturbances SHARED EXCLUDE_FROM_ALL node/disturbances.c)
target_link_libraries(afm_disturbances ${CMAKE_DL_LIBS})
add_dependencies(tests afm_disturbances)

# driven by the test of the clients; beside the node's directory, where rosrun does not offer it
afm_add_program(client_calls EXCLUDE_FROM_ALL node/client_calls.cpp)
add_dependencies(afm_client_calls ${PROJECT_NAME}_generate_messages_cpp)
set_target_properties(afm_client_calls PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib)
target_include_directories(afm_client_calls PRIVATE ${PROJECT_SOURCE_DIR}/include)
target_include_directories(afm_client_calls SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(afm_client_calls PRIVATE ${catkin_LIBRARIES})
add_dependencies(tests afm_client_calls)

# a short form; scripts/soak alone runs for an hour
set(soak ${PROJECT_SOURCE_DIR}/scripts/soak --duration 6 --stages 0 3 --part 3 --rate 50)
add_test(NAME soak COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${soak})
set_tests_properties(soak PROPERTIES TIMEOUT 120 ENVIRONMENT "AFM_SOAK=1;ROS_HOSTNAME=localhost")

if(NOT AFM_SANITIZE)
  afm_add_test(my_controller 600 ${CMAKE_CURRENT_SOURCE_DIR}/my_controller_test.sh ${PROJECT_SOURCE_DIR}
    ${CATKIN_DEVEL_PREFIX})

  # it stands between the program and its allocator itself
  afm_add_gtest(stepping_path_test node/stepping_path_test.cpp)
  target_include_directories(afm_stepping_path_test SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_link_libraries(afm_stepping_path_test afm_emulator_ros ${CMAKE_DL_LIBS})
  set_tests_properties(${gtest_prefix}stepping_path_test PROPERTIES TIMEOUT 60)
endif()
