# cpack runs this script between installing into its own folder and packing: it gives each .deb the files that Debian's
# policy demands, and all files the time $SOURCE_DATE_EPOCH.
set(time $ENV{SOURCE_DATE_EPOCH})

# finish_debian(PACKAGE)   in the folder of the package
function(finish_debian package)
  set(usr ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${package}/usr)
  set(doc ${usr}/share/doc/${package})
  configure_file(${CPACK_PSYGEN_LICENCES} ${doc}/copyright COPYONLY)
  file(REMOVE ${usr}/share/doc/psygen/LICENSE ${usr}/share/psygen/licences.txt)  # copyright has their texts
  execute_process(COMMAND date -R -u -d @${time} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE)
  file(WRITE ${doc}/changelog "psygen (${CPACK_PACKAGE_VERSION}) stable; urgency=medium

  * CHANGELOG.md of the package psygen-doc lists the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  if(EXISTS ${usr}/share/zsh/site-functions)
    file(RENAME ${usr}/share/zsh/site-functions ${usr}/share/zsh/vendor-completions)
  endif()
  if(package STREQUAL "psygen")
    # It replaces one function of another library and calls none.
    file(WRITE ${usr}/share/lintian/overrides/psygen
         "psygen: shared-library-lacks-prerequisites [usr/lib/*/psygen/libpsygen_countable.so]\n")
  endif()
  if(package STREQUAL "psygen-game")
    file(RENAME ${usr}/bin ${usr}/games)
  endif()
  file(GLOB_RECURSE pages ${usr}/share/man/*)
  execute_process(COMMAND gzip -9n ${doc}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE archives ${usr}/lib/*.a)
  if(archives)
    execute_process(COMMAND ${CPACK_PSYGEN_STRIP} --strip-debug --enable-deterministic-archives ${archives}
                    COMMAND_ERROR_IS_FATAL ANY)
  endif()
endfunction()

if(CPACK_GENERATOR STREQUAL "DEB")
  file(GLOB packages RELATIVE ${CPACK_TEMPORARY_INSTALL_DIRECTORY} ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
  foreach(package IN LISTS packages)
    finish_debian(${package})
  endforeach()
endif()
execute_process(COMMAND find ${CPACK_TEMPORARY_INSTALL_DIRECTORY} -exec touch -h -d @${time} {} +
                COMMAND_ERROR_IS_FATAL ANY)
