# What the documents tell users to paste.

if(NOT AFM_SANITIZE)  # what these run, other tests run under sanitizers
  add_test(NAME documented_commands
    COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/commands_test.py
      ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CATKIN_DEVEL_PREFIX})
  # three documents at a time, each for the most part waiting
  set_tests_properties(documented_commands PROPERTIES TIMEOUT 800 SKIP_RETURN_CODE 77)

  add_test(NAME rosrun COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/docs/rosrun_test.sh ${CATKIN_DEVEL_PREFIX}
    friction_curve next_impact replay_check)
  set_tests_properties(rosrun PROPERTIES TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()

add_test(NAME document_tables COMMAND ${PROJECT_SOURCE_DIR}/workflow/documents.py --check)
set_tests_properties(document_tables PROPERTIES TIMEOUT 30)

add_test(NAME interface_tables
  COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/interface_tables_test.py ${PROJECT_SOURCE_DIR})
add_test(NAME links COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/links_test.py ${PROJECT_SOURCE_DIR})
set_tests_properties(interface_tables links PROPERTIES TIMEOUT 30)

# the site, where its parts are installed as Debian 12 has them: a warning of Sphinx or Doxygen is an error
find_program(DOXYGEN_PROGRAM doxygen)
execute_process(COMMAND ${PYTHON_EXECUTABLE} -c
  "import breathe, furo, myst_parser, sphinx, sphinx_copybutton; assert sphinx.version_info[0] == 5"
  RESULT_VARIABLE sphinx_result OUTPUT_QUIET ERROR_QUIET)
if(DOXYGEN_PROGRAM AND sphinx_result EQUAL 0 AND TARGET afm_python)
  add_test(NAME site COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/site_test.py
    ${PROJECT_SOURCE_DIR} ${CATKIN_DEVEL_PREFIX} ${PROJECT_BINARY_DIR}/docs)
  set_tests_properties(site PROPERTIES TIMEOUT 300)
endif()

# every rule of the Snakefile by a dry run; one table that is measured, one that is made, and one picture
find_program(SNAKEMAKE_PROGRAM snakemake)
if(SNAKEMAKE_PROGRAM AND AFM_DYNAMICS)
  add_test(NAME laboratory COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/laboratory_test.py
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} $<TARGET_FILE_DIR:afm_friction_curve>)
  set_tests_properties(laboratory PROPERTIES TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()
