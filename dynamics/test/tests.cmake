# The laboratory: NAME_test.cpp with its library, NAME_test.py with its tools.

set(dynamics_tests attractor chatter_jacobian contact_jacobian continuation cycle_expansion hammer_orbits
  heated_sweep jacobian lyapunov periodic_orbit poincare_map sweep symbolic_dynamics)
set(here ${PROJECT_SOURCE_DIR}/dynamics/test)
foreach(name IN LISTS dynamics_tests)
  afm_add_gtest(${name}_test ${here}/${name}_test.cpp)
  target_include_directories(afm_${name}_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/benchmark
    ${PROJECT_SOURCE_DIR}/dynamics/src ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(afm_${name}_test afm_emulator_dynamics afm_quad)
  set_tests_properties(${gtest_prefix}${name}_test PROPERTIES TIMEOUT 120)
endforeach()
target_link_libraries(afm_sweep_test afm_emulator_sweep)

# afm_add_study_test(NAME ARGUMENT...): NAME_test.py with these arguments
function(afm_add_study_test name)
  afm_add_test(${name} 180 ${CMAKE_COMMAND} -E env PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/tools
    ${PYTHON_EXECUTABLE} ${here}/${name}_test.py ${ARGN})
endfunction()
afm_add_study_test(studies $<TARGET_FILE_DIR:afm_continue_orbits>)
afm_add_study_test(scene_levels $<TARGET_FILE:afm_model_error> ${PROJECT_SOURCE_DIR}/config/scenes)
afm_add_study_test(shipped_levels $<TARGET_FILE:afm_level_table> ${PROJECT_SOURCE_DIR}/config/levels.csv)
