# The core: physics without ROS.

# NAME_test.cpp: one executable each, with the core and nothing else (and quad floats to compare with)
file(GLOB_RECURSE core_tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/core/*_test.cpp)
foreach(file IN LISTS core_tests)
  get_filename_component(name ${file} NAME_WE)
  afm_add_gtest(${name} ${file})
  target_include_directories(afm_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/benchmark
    ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(afm_${name} afm_emulator_core afm_quad)
  target_compile_definitions(afm_${name} PRIVATE AFM_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/data")
  set_tests_properties(${gtest_prefix}${name} PROPERTIES TIMEOUT 120)
endforeach()

# The bits of a run depend on no compiler and no option: reference runs as built here and, portable, without any
# optimization, against digests that are written down. scripts/platforms --digests does it for every compiler there is,
# and for older machines.
get_target_property(core_sources afm_emulator_core SOURCES)
list(TRANSFORM core_sources PREPEND ${PROJECT_SOURCE_DIR}/src/core/)
add_executable(afm_reference_digest EXCLUDE_FROM_ALL core/reference_digest.cpp)
target_link_libraries(afm_reference_digest afm_options afm_emulator_core)
add_executable(afm_reference_digest_portable EXCLUDE_FROM_ALL core/reference_digest.cpp ${core_sources})
target_compile_features(afm_reference_digest_portable PRIVATE cxx_std_17)
target_compile_options(afm_reference_digest_portable PRIVATE ${afm_bits} -O0)
target_include_directories(afm_reference_digest_portable PRIVATE ${PROJECT_SOURCE_DIR}/include)
target_link_libraries(afm_reference_digest_portable Threads::Threads)
foreach(program afm_reference_digest afm_reference_digest_portable)
  target_include_directories(${program} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
  add_dependencies(tests ${program})
endforeach()
afm_add_test(reference_digest 120 ${CMAKE_CURRENT_SOURCE_DIR}/core/reference_digest_test.sh
    ${CMAKE_CURRENT_SOURCE_DIR}/data/reference_digest.txt
    $<TARGET_FILE:afm_reference_digest> $<TARGET_FILE:afm_reference_digest_portable>)
