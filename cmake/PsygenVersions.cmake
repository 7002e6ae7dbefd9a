# Versions of packages. psygen_check_version(PACKAGE) stops cmake with a sentence if the version that was found
# is outside of the range below. README.md says with which systems psygen was tried.
#
# Each item: package of find_package(), name for people, oldest version, newest version (may be empty).
set(PSYGEN_VERSIONS
  "imgui|Dear ImGui|1.86|1.91"
  "hwy|Highway|1.0.3|"
  "tomlplusplus|toml++|3.3|"
  "glfw3|GLFW|3.3|"
  "fmt|fmt|9|"
  "spdlog|spdlog|1.10|"
  "CLI11|CLI11|2.1|"
  "nlohmann_json|nlohmann_json|3.11|"
  "OpenImageIO|OpenImageIO|2.4|")

function(psygen_check_version package)
  set(version "${${package}_VERSION}")
  foreach(item IN LISTS PSYGEN_VERSIONS)
    if(NOT item MATCHES "^${package}[|]([^|]*)[|]([^|]*)[|]([^|]*)$")
      continue()
    endif()
    set(title "${CMAKE_MATCH_1}")
    set(oldest "${CMAKE_MATCH_2}")
    set(newest "${CMAKE_MATCH_3}")
    if(newest STREQUAL "")
      set(range "${oldest} or newer")
    else()
      set(range "${oldest} to ${newest}")
    endif()
    string(FIND "${version}." "${newest}." same)  # 1.91.9 is a version 1.91
    if(version STREQUAL "")
      message(WARNING "psygen needs ${title} ${range}; the package does not tell its version")
    elseif(version VERSION_LESS oldest OR (newest AND NOT same EQUAL 0 AND version VERSION_GREATER newest))
      message(FATAL_ERROR "psygen needs ${title} ${range}, found ${version}")
    endif()
  endforeach()
endfunction()
