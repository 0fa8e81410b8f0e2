# The laboratory: NAME_test.cpp with its library, NAME_test.py with its tools.

set(here ${PROJECT_SOURCE_DIR}/dynamics/test)
file(GLOB dynamics_tests CONFIGURE_DEPENDS ${here}/*_test.cpp)
foreach(file IN LISTS dynamics_tests)
  get_filename_component(name ${file} NAME_WE)
  afm_add_gtest(${name} ${file})
  target_include_directories(afm_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/benchmark
    ${PROJECT_SOURCE_DIR}/dynamics/src ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(afm_${name} afm_emulator_dynamics afm_quad)
  set_tests_properties(${gtest_prefix}${name} PROPERTIES TIMEOUT 120)
endforeach()

# afm_add_study_test(NAME ARGUMENT...): NAME_test.py with these arguments
function(afm_add_study_test name)
  afm_add_test(${name} 180 ${CMAKE_COMMAND} -E env PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/tools
    ${PYTHON_EXECUTABLE} ${here}/${name}_test.py ${ARGN})
endfunction()
afm_add_study_test(studies $<TARGET_FILE_DIR:afm_continue_orbits>)
afm_add_study_test(scene_levels $<TARGET_FILE:afm_model_error> ${PROJECT_SOURCE_DIR}/config/scenes)
afm_add_study_test(shipped_levels $<TARGET_FILE:afm_level_table> ${PROJECT_SOURCE_DIR}/config/levels.csv)
