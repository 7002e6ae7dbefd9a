# Writes a C++ source with functions that return the texts of files. The build runs it:
#
# cmake -DOUTPUT=out.cpp -DHEADER=engine/telemetry/page.hpp -DNAMESPACE=psygen::telemetry
#       "-DTEXTS=page_style=page_style.css;page_script=page_script.js" -P PsygenEmbed.cmake
set(source "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n")
foreach(text IN LISTS TEXTS)
  string(REGEX MATCH "^([a-z_]+)=(.+)$" matched "${text}")
  set(function "${CMAKE_MATCH_1}")
  file(READ "${CMAKE_MATCH_2}" content)
  string(APPEND source "\nstd::string_view ${function}() {\n  return R\"embed(${content})embed\";\n}\n")
endforeach()
string(APPEND source "\n}  // namespace ${NAMESPACE}\n")
file(WRITE "${OUTPUT}" "${source}")
