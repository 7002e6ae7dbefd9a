# psygen_revision(TARGET)
# The program TARGET tells the revision of its own source in summary.json (build.revision), and whether files
# under version control had changed: psygen::telemetry finds two symbols that a source made at each build
# defines. The program exports its symbols if psygen::telemetry is shared. Nothing is told outside of a git
# repository, and if git fails.
if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  execute_process(COMMAND git rev-parse --short=12 HEAD WORKING_DIRECTORY ${SOURCE_DIR}
                  OUTPUT_VARIABLE revision ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE no_revision)
  # Without git's index.lock, which would fail the user's own commands.
  execute_process(COMMAND git --no-optional-locks status --porcelain --untracked-files=no
                  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE changes ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE no_status)
  if(no_revision OR no_status)
    set(revision "")
  endif()
  string(COMPARE EQUAL "${changes}" "" clean)
  file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
extern "C" {
__attribute__((visibility("default"))) extern const char psygen_program_revision[];
__attribute__((visibility("default"))) extern const int psygen_program_is_clean;
const char psygen_program_revision[] = "@revision@";
const int psygen_program_is_clean = @clean@;
}
]])
  return()
endif()

set(PSYGEN_REVISION_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(psygen_revision target)
  if(TARGET ${target}_revision)
    return()
  endif()
  get_target_property(folder ${target} SOURCE_DIR)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_revision.cpp)
  add_custom_target(${target}_revision BYPRODUCTS ${source}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} -DSOURCE_DIR=${folder} -P ${PSYGEN_REVISION_SCRIPT} VERBATIM)
  add_dependencies(${target} ${target}_revision)
  target_sources(${target} PRIVATE ${source})
  set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(TARGET psygen::telemetry)
    get_target_property(type psygen::telemetry TYPE)
    if(type STREQUAL "SHARED_LIBRARY")
      set_target_properties(${target} PROPERTIES ENABLE_EXPORTS ON)
    endif()
  endif()
endfunction()
