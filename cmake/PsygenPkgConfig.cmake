# Installs psygen-COMPONENT.pc for each component, for pkg-config. Its lines come from the component's target: includes,
# definitions and link options for installations, and libraries. Static libraries name all that they need, shared ones
# only what their public headers need. The files may be moved together with the installation.

# Sets `flags` to the linker's flags of a library: an imported target, a file, or a flag.
function(psygen_link_flags flags library)
  set(found "")
  if(library MATCHES "^\\$<LINK_ONLY:(.*)>$")
    set(library ${CMAKE_MATCH_1})
  endif()
  if(TARGET ${library})
    get_target_property(type ${library} TYPE)
    if(NOT type STREQUAL "INTERFACE_LIBRARY")
      get_target_property(file ${library} LOCATION)
      psygen_link_flags(found ${file})
    endif()
    get_target_property(needs ${library} INTERFACE_LINK_LIBRARIES)
    if(needs AND NOT type STREQUAL "SHARED_LIBRARY")
      foreach(need IN LISTS needs)
        psygen_link_flags(more ${need})
        list(APPEND found ${more})
      endforeach()
    endif()
  elseif(IS_ABSOLUTE "${library}")
    cmake_path(GET library PARENT_PATH folder)
    cmake_path(GET library STEM name)
    string(REGEX REPLACE "^lib" "-l" found ${name})
    if(NOT folder IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
      list(PREPEND found -L${folder})
    endif()
  elseif(library MATCHES "^-")
    set(found ${library})
  elseif(NOT library MATCHES "^\\$<|::")  # the condition of a generator expression, or no library
    set(found -l${library})
  endif()
  set(${flags} ${found} PARENT_SCOPE)
endfunction()

# Sets `settings` to a target's items $<INSTALL_INTERFACE:...> of a property, each after `before`.
function(psygen_installed_settings settings target property before)
  set(found "")
  get_target_property(items ${target} ${property})
  string(REPLACE "$<INSTALL_PREFIX>" "\${prefix}" items "${items}")
  foreach(item IN LISTS items)
    if(item MATCHES "^\\$<INSTALL_INTERFACE:(.*)>$")
      string(REPLACE "LINKER:" "-Wl," item "${CMAKE_MATCH_1}")
      string(REPLACE "\"" "\\\"" item "${item}")
      list(APPEND found "${before}${item}")
    endif()
  endforeach()
  set(${settings} ${found} PARENT_SCOPE)
endfunction()

file(RELATIVE_PATH prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix ${prefix})
foreach(component IN LISTS psygen_components)
  set(target psygen_${component})
  set(property LINK_LIBRARIES)
  if(BUILD_SHARED_LIBS)
    set(property INTERFACE_LINK_LIBRARIES)
  endif()
  get_target_property(libraries ${target} ${property})
  set(requires "")
  psygen_installed_settings(cflags ${target} INTERFACE_COMPILE_DEFINITIONS -D)
  psygen_installed_settings(libs ${target} INTERFACE_LINK_OPTIONS "")
  foreach(library IN LISTS libraries)
    if(library MATCHES "^psygen::(.+)$")
      list(APPEND requires psygen-${CMAKE_MATCH_1})
    elseif(NOT library MATCHES "^\\$<")
      psygen_link_flags(flags ${library})
      list(APPEND libs ${flags})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES libs)
  list(JOIN requires " " requires)
  list(JOIN cflags " " cflags)
  list(JOIN libs " " libs)
  file(WRITE ${PROJECT_BINARY_DIR}/pkgconfig/psygen-${component}.pc
"prefix=\${pcfiledir}/${prefix}

Name: psygen-${component}
Description: ${PROJECT_DESCRIPTION}: component ${component}
Version: ${PROJECT_VERSION}
Requires: ${requires}
Cflags: -I\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}/psygen ${cflags}
Libs: -L\${prefix}/${CMAKE_INSTALL_LIBDIR} -lpsygen_${component} ${libs}
")
  install(FILES ${PROJECT_BINARY_DIR}/pkgconfig/psygen-${component}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT psygen_${component})
endforeach()
