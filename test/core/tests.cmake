# The core: physics without ROS.

# core/FOLDER/NAME_test.cpp: one executable each, with the core and nothing else (and quad floats to compare with)
function(afm_add_core_test path)
  get_filename_component(name ${path} NAME)
  afm_add_gtest(${name}_test core/${path}_test.cpp)
  target_include_directories(afm_${name}_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/benchmark
    ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(afm_${name}_test afm_emulator_core afm_quad ${ARGN})
  target_compile_definitions(afm_${name}_test PRIVATE AFM_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/data")
  set_tests_properties(${gtest_prefix}${name}_test PROPERTIES TIMEOUT 120)
endfunction()

set(core_tests
  contact/chatter
  contact/chatter_end
  contact/contact
  contact/contact_energy
  contact/contact_step
  contact/slide
  contact/slide_release
  run/batch_means
  run/run
  run/run_limits
  run/snapshot
  run/ensemble
  run/friction
  run/live_changes
  run/pacer
  levels/level_table
  model
  number_text
  search/double_double
  search/first_fall
  search/flight
  search/grazing
  search/hard_starts
  search/impact_search
  search/reference_flights
  search/reflection
  search/short_bounce
  search/slow_departure
  search/surface
  search/turns
  state
  tip/corners
  tip/deflection
  tip/energy
  tip/equilibrium
  tip/hammer
  tip/kick
  tip/known_orbits
  tip/set_model
  tip/set_parameters
  tip/segment
  tip/split
  tip/thermostat
  tip/tip
  units)
foreach(name IN LISTS core_tests)
  afm_add_core_test(${name})
endforeach()
# The bits of a run depend on no compiler and no option: reference runs as shipped and without any optimisation, against
# digests that are written down. scripts/platforms --digests does it for every compiler there is.
get_target_property(core_sources afm_emulator_core SOURCES)
list(FILTER core_sources EXCLUDE REGEX "^\\$<")  # objects of lanes
list(TRANSFORM core_sources PREPEND ${PROJECT_SOURCE_DIR}/src/core/)
add_executable(afm_reference_digest EXCLUDE_FROM_ALL core/reference_digest.cpp)
target_link_libraries(afm_reference_digest afm_emulator_core)
add_executable(afm_reference_digest_O0 EXCLUDE_FROM_ALL core/reference_digest.cpp ${core_sources})
target_compile_options(afm_reference_digest_O0 PRIVATE -O0)
target_compile_definitions(afm_reference_digest_O0 PRIVATE AFM_SINGLE_VERSION)
target_include_directories(afm_reference_digest_O0 PRIVATE ${PROJECT_SOURCE_DIR}/include)
target_link_libraries(afm_reference_digest_O0 afm_options Threads::Threads)
foreach(program afm_reference_digest afm_reference_digest_O0)
  target_include_directories(${program} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
  add_dependencies(tests ${program})
endforeach()
add_test(NAME reference_digest
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/core/reference_digest_test.sh
  ${CMAKE_CURRENT_SOURCE_DIR}/data/reference_digest.txt
    $<TARGET_FILE:afm_reference_digest> $<TARGET_FILE:afm_reference_digest_O0>)
set_tests_properties(reference_digest PROPERTIES TIMEOUT 120)

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND NOT AFM_SANITIZE)
  add_test(NAME older_machines
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/core/older_machines_test.sh
    ${CMAKE_CURRENT_SOURCE_DIR}/data/reference_digest.txt
      $<TARGET_FILE:afm_reference_digest> $<TARGET_FILE:afm_next_impact> $<TARGET_FILE:afm_friction_curve>
      ${CMAKE_CURRENT_SOURCE_DIR}/data/next_impact.csv)
  set_tests_properties(older_machines PROPERTIES TIMEOUT 180 SKIP_RETURN_CODE 77)
endif()

# what is compiled for lanes must not be linked into the rest: without optimization nothing is inlined away
set(lane_objects)
foreach(lanes IN LISTS afm_lanes)
  get_target_property(sources afm_lanes_${lanes} SOURCES)
  list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/src/core/)
  set_source_files_properties(${sources} core/lanes/lane_probe_${lanes}.cpp
    PROPERTIES COMPILE_OPTIONS -fno-sanitize=all)
  add_library(afm_lanes_${lanes}_unoptimized OBJECT ${sources})
  target_include_directories(afm_lanes_${lanes}_unoptimized PRIVATE ${PROJECT_SOURCE_DIR}/include
    ${PROJECT_SOURCE_DIR}/src)
  target_compile_options(afm_lanes_${lanes}_unoptimized PRIVATE ${afm_lanes_${lanes}_options} ${afm_lanes_options} -O0)
  target_link_libraries(afm_lanes_${lanes}_unoptimized PRIVATE afm_options)
  list(APPEND lane_objects $<TARGET_OBJECTS:afm_lanes_${lanes}> $<TARGET_OBJECTS:afm_lanes_${lanes}_unoptimized>)
endforeach()
if(lane_objects)
  afm_add_core_test(lanes/lanes)
  foreach(lanes IN LISTS afm_lanes)
    set(probe afm_lane_probe_${lanes})
    add_library(${probe} OBJECT core/lanes/lane_probe_${lanes}.cpp)
    target_include_directories(${probe} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
    target_compile_options(${probe} PRIVATE ${afm_lanes_${lanes}_options} ${afm_lanes_options})
    target_link_libraries(${probe} PRIVATE afm_options)
    target_sources(afm_lanes_test PRIVATE $<TARGET_OBJECTS:${probe}>)
  endforeach()
  if("avx512" IN_LIST afm_lanes)
    target_compile_definitions(afm_lanes_test PRIVATE AFM_WIDE_LANES)
  endif()
  add_test(NAME lane_symbols COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/core/lane_symbols_test.sh ${lane_objects}
    COMMAND_EXPAND_LISTS)
  set_tests_properties(lane_symbols PROPERTIES TIMEOUT 30)
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64" AND NOT AFM_SANITIZE AND
   CMAKE_BUILD_TYPE STREQUAL "Release")
  add_test(NAME hot_symbols COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/core/hot_symbols_test.sh
    $<TARGET_FILE:afm_emulator_core>)
  set_tests_properties(hot_symbols PROPERTIES TIMEOUT 30)
endif()

add_test(NAME no_ros_in_core COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/core/no_ros_test.sh)
set_tests_properties(no_ros_in_core PROPERTIES TIMEOUT 30)
