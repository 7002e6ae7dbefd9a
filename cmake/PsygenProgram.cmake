# psygen_install_program(PROGRAM COMPONENT [DESKTOP FOLDER])
# Installs an executable of psygen_executable() with its manual page and its completions for bash and zsh. The build
# makes them from the program's --help (tools/command_pages.py). A build without Python, for another machine or with
# sanitizers has none.
#   DESKTOP   a folder with PROGRAM.desktop, PROGRAM.metainfo.xml, PROGRAM.svg (the icon) and, for types of files,
#             PROGRAM.xml
if(PSYGEN_INSTALL)
  find_package(Python3 QUIET COMPONENTS Interpreter)
endif()
if(PSYGEN_INSTALL AND NOT Python3_FOUND)
  message(STATUS "Manual pages and completions are not built: Python 3 was not found")
endif()

function(psygen_install_program program component)
  cmake_parse_arguments(ARG "" "DESKTOP" "" ${ARGN})
  if(NOT PSYGEN_INSTALL)
    return()
  endif()
  install(TARGETS ${program} COMPONENT ${component})
  if(ARG_DESKTOP)
    cmake_path(ABSOLUTE_PATH ARG_DESKTOP OUTPUT_VARIABLE folder)
    foreach(pair applications=desktop metainfo=metainfo.xml icons/hicolor/scalable/apps=svg mime/packages=xml)
      string(REPLACE "=" ";" pair ${pair})
      list(GET pair 0 destination)
      list(GET pair 1 ending)
      if(EXISTS ${folder}/${program}.${ending})
        install(FILES ${folder}/${program}.${ending}
                DESTINATION ${CMAKE_INSTALL_DATADIR}/${destination} COMPONENT ${component})
      endif()
    endforeach()
  endif()

  if(NOT Python3_FOUND OR CMAKE_CROSSCOMPILING OR PSYGEN_SANITIZE)
    return()
  endif()
  set(pages ${PROJECT_BINARY_DIR}/manual)
  set(script ${PROJECT_SOURCE_DIR}/tools/command_pages.py)
  set(made ${pages}/${program}.1 ${pages}/${program}.bash ${pages}/_${program})
  add_custom_command(OUTPUT ${made} DEPENDS ${program} ${script} VERBATIM
    COMMAND Python3::Interpreter ${script} ${PROJECT_VERSION} ${pages} $<TARGET_FILE:${program}>)
  add_custom_target(${program}-manual ALL DEPENDS ${made})
  install(FILES ${pages}/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
  install(FILES ${pages}/${program}.bash RENAME ${program}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component})
  install(FILES ${pages}/_${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT ${component})
endfunction()
