# Each target takes any bytes. Without a fuzzer it is run over the inputs that are kept in data/fuzz; with clang's
# libFuzzer (AFM_FUZZ, scripts/fuzz) it looks for new ones by what they reach.
option(AFM_FUZZ "Build the fuzzers too: needs clang, and what is fuzzed must be built with -fsanitize=fuzzer-no-link"
  OFF)

function(afm_add_fuzz_target name)
  add_executable(afm_replay_fuzz_${name} EXCLUDE_FROM_ALL fuzz/${name}.cpp fuzz/replay_main.cpp)
  set(programs afm_replay_fuzz_${name})
  if(AFM_FUZZ)
    add_executable(afm_fuzz_${name} EXCLUDE_FROM_ALL fuzz/${name}.cpp)
    target_link_options(afm_fuzz_${name} PRIVATE -fsanitize=fuzzer)
    list(APPEND programs afm_fuzz_${name})
  endif()
  foreach(program IN LISTS programs)
    target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR}/test/fuzz ${PROJECT_SOURCE_DIR}/test
      ${PROJECT_SOURCE_DIR}/benchmark ${PROJECT_SOURCE_DIR}/src)
    target_include_directories(${program} SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
    target_link_libraries(${program} PRIVATE afm_options ${ARGN})
    add_dependencies(tests ${program})
  endforeach()
  afm_add_test(fuzz_${name} 60 afm_replay_fuzz_${name} ${PROJECT_SOURCE_DIR}/test/data/fuzz/${name})
endfunction()

afm_add_fuzz_target(tip afm_emulator_core)
afm_add_fuzz_target(csv_filter afm_impact_filter)
if(catkin_FOUND)
  afm_add_fuzz_target(parameters afm_emulator_ros)
  afm_add_fuzz_target(bag_messages afm_bags)
endif()
