# psygen_add_frame_test(NAME FILE [PROGRAM target] [LABELS ...])
# Adds a CTest entry that runs the frame test FILE (docs/frame-tests.md) and fails if it misses a budget.
# It is skipped without a device, and if the machine was too busy to judge it. PROGRAM is your target that calls frametest::frame_test_main(); without
# it `psygen test` flies without a game. Its summaries tell its revision (psygen_revision()). Labels: frames, and LABELS. Outputs are in frame_tests/NAME of the
# build folder, with images of the worst frames of a failed test. Tests on the wall clock run alone, because
# other tests would take their time.
include(${CMAKE_CURRENT_LIST_DIR}/PsygenRevision.cmake)

function(psygen_add_frame_test name file)
  cmake_parse_arguments(PARSE_ARGV 2 ARG "" "PROGRAM" "LABELS")
  cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  if(ARG_PROGRAM)
    set(program ${ARG_PROGRAM})
    psygen_revision(${ARG_PROGRAM})
  elseif(TARGET psygen)
    set(program psygen test)
  else()
    set(program ${psygen_EXECUTABLE} test)
  endif()
  string(MAKE_C_IDENTIFIER "${name}" folder)
  add_test(NAME "${name}" COMMAND ${program} ${file} --out ${CMAKE_CURRENT_BINARY_DIR}/frame_tests/${folder})
  set_tests_properties("${name}" PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 3600 LABELS "frames;${ARG_LABELS}"
                       SKIP_REGULAR_EXPRESSION "(^|\n)not judged: no budget is missed")
  file(READ ${file} text)
  if(NOT text MATCHES "clock *= *\"virtual\"")
    set_tests_properties("${name}" PROPERTIES RUN_SERIAL ON)
  endif()
endfunction()
