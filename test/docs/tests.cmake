# What the documents tell users to paste.

if(NOT AFM_SANITIZE)  # what these run, other tests run under sanitizers
  # three documents at a time, each for the most part waiting
  afm_add_test(documented_commands 800 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/commands_test.py
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CATKIN_DEVEL_PREFIX})
endif()

afm_add_test(document_tables 30 ${PROJECT_SOURCE_DIR}/workflow/documents.py --check)
afm_add_test(interface_tables 30 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/interface_tables_test.py
  ${PROJECT_SOURCE_DIR})
afm_add_test(links 30 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/links_test.py ${PROJECT_SOURCE_DIR})

# the site, where its parts are installed as Debian 12 has them: a warning of Sphinx or Doxygen is an error
find_program(DOXYGEN_PROGRAM doxygen)
execute_process(COMMAND ${PYTHON_EXECUTABLE} -c
  "import breathe, furo, myst_parser, sphinx, sphinx_copybutton; assert sphinx.version_info[0] == 5"
  RESULT_VARIABLE sphinx_result OUTPUT_QUIET ERROR_QUIET)
if(DOXYGEN_PROGRAM AND sphinx_result EQUAL 0 AND TARGET afm_python)
  afm_add_test(site 300 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/site_test.py
    ${PROJECT_SOURCE_DIR} ${CATKIN_DEVEL_PREFIX} ${PROJECT_BINARY_DIR}/docs)
endif()

# every rule of the Snakefile by a dry run; one table that is measured, one that is made, and one picture
find_program(SNAKEMAKE_PROGRAM snakemake)
if(SNAKEMAKE_PROGRAM AND AFM_DYNAMICS)
  afm_add_test(laboratory 120 ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/laboratory_test.py
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} $<TARGET_FILE_DIR:afm_friction_curve>)
endif()
