# cpack reads this file for each generator. All packages have the time of the last commit, unless SOURCE_DATE_EPOCH is
# set, so that two builds have the same bytes.
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  execute_process(COMMAND git log -1 --format=%ct WORKING_DIRECTORY ${CPACK_PSYGEN_SOURCE_DIR}
                  OUTPUT_VARIABLE time OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(time STREQUAL "")
    message(FATAL_ERROR "${CPACK_PSYGEN_SOURCE_DIR} is no git repository: set SOURCE_DATE_EPOCH to the time of the release, in seconds since 1970")
  endif()
  set(ENV{SOURCE_DATE_EPOCH} ${time})
endif()

if(CPACK_GENERATOR STREQUAL "TZST")
  # One archive of the programs and their data. All other components are for Debian.
  set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
  set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
  set(CPACK_STRIP_FILES ON)
  list(FILTER CPACK_COMPONENTS_ALL INCLUDE REGEX "^psygen_(tools|game|editor|data|pictures|mpi)$")
endif()
