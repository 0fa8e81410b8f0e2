# The node, run as a user runs it, and those of its parts that need no master.

# node/NAME.test: a launch file run by rostest, with a master of its own
function(afm_add_rostest name)
  add_rostest(node/${name}.test DEPENDENCIES ${ARGN})
  set_tests_properties(${rostest_prefix}${name}.test PROPERTIES TIMEOUT 180)
endfunction()

set(node_tests
  commands
  ending
  lever
  lockstep
  panel
  replay
  scenes
  shipped_files)
foreach(name IN LISTS node_tests)
  afm_add_rostest(${name} afm_emulator_node)
endforeach()

# of the picture
set(view_tests pair view)
foreach(name IN LISTS view_tests)
  afm_add_rostest(${name} afm_emulator_node afm_view_node)
endforeach()

# nodes to copy
set(example_tests examples)
afm_add_rostest(examples afm_emulator_node afm_view_node afm_examples_ros)
# their own tests, as a user writes them
foreach(arguments "hold_force.test language:=python" "hold_force.test language:=cpp" "hold_force.test pace:=real_time"
        "seek_peak.test language:=python" "seek_peak.test language:=cpp start:=7.3e-6")
  separate_arguments(arguments)
  list(POP_FRONT arguments file)
  add_rostest(${PROJECT_SOURCE_DIR}/examples/ros/test/${file} ARGS ${arguments}
    DEPENDENCIES afm_emulator_node afm_examples_ros)
endforeach()

# of the tools that read recordings
set(recording_tests
  faults
  load
  recording
  repeats
  spoiled_bags)
foreach(name IN LISTS recording_tests)
  afm_add_rostest(${name} afm_emulator_node afm_replay_check afm_bag_to_csv)
endforeach()
# keeps every core busy: what ran beside it would starve
set_tests_properties(${rostest_prefix}load.test PROPERTIES RUN_SERIAL TRUE)

# of the Python module, where it is built
if(TARGET afm_python_module)
  afm_add_rostest(python_module afm_emulator_node afm_replay_check afm_python)
endif()

# node/NAME_test.cpp: parts of the node that need no master
foreach(name diagnosis messages parameters recorder)
  afm_add_gtest(${name}_test node/${name}_test.cpp)
  target_include_directories(afm_${name}_test SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_link_libraries(afm_${name}_test afm_emulator_ros)
  set_tests_properties(${gtest_prefix}${name}_test PROPERTIES TIMEOUT 60)
endforeach()

# preloaded by the faults' test
add_library(afm_clock_jump SHARED EXCLUDE_FROM_ALL node/clock_jump.c)
add_dependencies(tests afm_clock_jump)

# rostest starts what is executable: in a clone that is what git says, whatever it is in this tree
execute_process(COMMAND git ls-files --stage -- "node/*_test.py" WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
  OUTPUT_VARIABLE staged ERROR_QUIET)
if(staged MATCHES "100644 [0-9a-f]+ [0-9]\t([^\n]+)")
  message(FATAL_ERROR "git holds test/${CMAKE_MATCH_1} as a file that rostest cannot start: "
    "git update-index --chmod=+x test/${CMAKE_MATCH_1}")
endif()

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
