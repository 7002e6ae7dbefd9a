# The reference: Doxygen makes pages of all public headers in reference/html of the build folder.
#   cmake --build --preset release --target reference
# The target exists only if Doxygen was found.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()

get_target_property(components psygen_settings PSYGEN_COMPONENTS)
foreach(component IN LISTS components)
  get_target_property(headers psygen_${component} HEADER_SET)
  list(APPEND public_headers ${headers})
endforeach()

set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/reference)
# Runs once a header: the interpreter itself, not a launcher that looks for one each time.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sys; print(sys.executable)"
                OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE)
set(DOXYGEN_INPUT_FILTER "\"${python}\" \"${PROJECT_SOURCE_DIR}/tools/reference_filter.py\"")
set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_STRIP_FROM_INC_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_EXTRACT_ALL YES)  # one comment often stands above several declarations
set(DOXYGEN_HIDE_FRIEND_COMPOUNDS YES)
set(DOXYGEN_MACRO_EXPANSION YES)
set(DOXYGEN_BUILTIN_STL_SUPPORT YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(reference ${public_headers}
                 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Reference of the public headers")
