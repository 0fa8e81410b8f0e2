# What the documents tell users to paste, against the install space: scripts/build and scripts/test install, catkin's run_tests does not.

if(NOT AFM_SANITIZE)  # what these run, other tests run under sanitizers
  set(mpirun)
  if(MPI_CXX_FOUND)
    set(mpirun ${MPIEXEC_EXECUTABLE})
  endif()
  add_test(NAME documented_commands
    COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/commands_test.py
      ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CMAKE_INSTALL_PREFIX} ${mpirun})
  # three documents at a time, and with scripts/build it installs again
  set_tests_properties(documented_commands PROPERTIES TIMEOUT 600 SKIP_RETURN_CODE 77 RUN_SERIAL TRUE)

  add_test(NAME rosrun COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/docs/rosrun_test.sh ${CMAKE_INSTALL_PREFIX}
    friction_curve next_impact replay_check)
  set_tests_properties(rosrun PROPERTIES TIMEOUT 60 SKIP_RETURN_CODE 77)
endif()
