# Tools on the command line, and programs that measure.

if(catkin_FOUND)
  afm_add_test(plot_run 180 ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/plot_run_test.py
    ${PROJECT_SOURCE_DIR}/scripts/plot_run.py)
  afm_add_test(live_status 60 ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/live_status_test.py
    ${PROJECT_SOURCE_DIR}/scripts/live_status)
endif()

afm_add_test(next_impact 120 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/next_impact_test.py
  $<TARGET_FILE:afm_next_impact> ${CMAKE_CURRENT_SOURCE_DIR}/data)

afm_add_test(friction_curve 180 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/friction_curve_test.py
  $<TARGET_FILE:afm_friction_curve>)

afm_add_test(real_time 120 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/real_time_test.py
  $<TARGET_FILE:afm_real_time>)

if(AFM_DYNAMICS)
  afm_add_test(si 120 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/si_test.py
    $<TARGET_FILE_DIR:afm_friction_curve>)
endif()

# a short form; for longer ones give the program more --scenes and --seconds
afm_add_test(stress 120 afm_stress --tau 60 --scenes 1500 --seconds 100)
afm_add_test(stress_shipped 120 afm_stress --shipped --tau 100000 --scenes 3)
afm_add_test(stress_levers 120 afm_stress --levers --tau 30 --scenes 300 --seconds 100)

# the scenes of docs/stability.md that ours must pass; not `glide`: put exactly on it, the tip stays at its first
# instant
afm_add_test(stability 120 afm_stability_matrix --quick --methods exact)

afm_add_test(arrows 30 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/arrows_test.py ${PROJECT_SOURCE_DIR})

afm_add_test(package 30 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/package_test.py
  ${PROJECT_SOURCE_DIR})

# every program answers --help, and refuses an option that it does not have
get_property(tools GLOBAL PROPERTY AFM_COMMAND_LINES)
list(TRANSFORM tools REPLACE "(.+)" "$<TARGET_FILE:afm_\\1>")
afm_add_test(help 60 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/help_test.py ${tools})

# common/NAME_test.cpp: what tools share
foreach(name command_line decimal_range table_writer)
  afm_add_gtest(${name}_test common/${name}_test.cpp)
  target_link_libraries(afm_${name}_test afm_common)
  set_tests_properties(${gtest_prefix}${name}_test PROPERTIES TIMEOUT 60)
endforeach()

# sweep/curve_test.cpp: the rows of curves and maps
afm_add_gtest(curve_test sweep/curve_test.cpp)
target_link_libraries(afm_curve_test afm_curves)
set_tests_properties(${gtest_prefix}curve_test PROPERTIES TIMEOUT 60)

# projects outside the tree
if(NOT AFM_SANITIZE AND AFM_DYNAMICS)
  set(examples)
  foreach(name impacts_to_csv one_tip periodic_orbit ten_thousand_tips warm_scene)
    add_executable(afm_example_${name} EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/examples/cpp/${name}.cpp)
    target_link_libraries(afm_example_${name} afm_emulator_dynamics)
    add_dependencies(tests afm_example_${name})
    list(APPEND examples $<TARGET_FILE:afm_example_${name}>)
  endforeach()
  # not by afm_add_test, which would drop an empty argument
  add_test(NAME consumer COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/consumer_test.sh ${PROJECT_BINARY_DIR}
    "${CATKIN_DEVEL_PREFIX}"
    ${PROJECT_SOURCE_DIR}/examples/cpp ${examples})
  set_tests_properties(consumer PROPERTIES TIMEOUT 300)
  afm_add_test(neighbours 300 ${CMAKE_CURRENT_SOURCE_DIR}/neighbours_test.sh ${PROJECT_SOURCE_DIR}
    ${catkin_EXTRAS_DIR}/..)
endif()

# a tree that is without ROS itself proves it by being built
if(NOT AFM_SANITIZE AND catkin_FOUND)
  set(without_ros ${CMAKE_CURRENT_SOURCE_DIR}/without_ros_test.sh ${PROJECT_SOURCE_DIR}
    ${PROJECT_BINARY_DIR}/without_ros)
  if(TARGET afm_python_module)
    list(APPEND without_ros ${PYTHON_EXECUTABLE})
  endif()
  afm_add_test(without_ros 600 ${without_ros})
endif()
