# The module as a user has it: in the folder that setup.bash puts on PYTHONPATH.
if(TARGET afm_python_module AND AFM_DYNAMICS)
  function(afm_add_python_test name)
    afm_add_test(python_${name} 300 ${CMAKE_COMMAND} -E env PYTHONPATH=${afm_python_path} PYTHONDONTWRITEBYTECODE=1
      ${PYTHON_EXECUTABLE} ${PROJECT_SOURCE_DIR}/python/tests/${name}_test.py ${ARGN})
  endfunction()
  afm_add_python_test(interface)
  afm_add_python_test(interrupt)
  afm_add_python_test(bits ${CMAKE_CURRENT_SOURCE_DIR}/data $<TARGET_FILE:afm_friction_curve>
    $<TARGET_FILE:afm_attractors>
    $<TARGET_FILE:afm_periodic_orbits> $<TARGET_FILE:afm_next_impact> $<TARGET_FILE:afm_example_impacts_to_csv>
    $<TARGET_FILE:afm_example_warm_scene>)
  afm_add_python_test(examples ${PROJECT_SOURCE_DIR}/examples/python)
  afm_add_python_test(many_machines ${PROJECT_SOURCE_DIR}/examples/python/many_machines.py)
endif()

# the signals of the panel need no module
if(catkin_FOUND)
  afm_add_test(panel_signals 60 ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 ${PYTHON_EXECUTABLE}
    ${PROJECT_SOURCE_DIR}/python/tests/panel_signals_test.py ${PROJECT_SOURCE_DIR}/python/client)
endif()
