# cpack runs this script after packing. It makes the packages of debug symbols again: cpack extracts the symbols while it
# packs, and writes its own folder into their md5sums. dpkg-deb gives no file a later time than $SOURCE_DATE_EPOCH.
foreach(package IN LISTS CPACK_PACKAGE_FILES)
  if(package MATCHES "\\.ddeb$")
    set(files ${CPACK_TOPLEVEL_DIRECTORY}/symbols)
    execute_process(COMMAND dpkg-deb --raw-extract ${package} ${files} COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND sh -c "find usr -type f -exec md5sum {} + | sort -k 2 >DEBIAN/md5sums"
                    WORKING_DIRECTORY ${files} COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND dpkg-deb --root-owner-group --build ${files} ${package} OUTPUT_QUIET
                    COMMAND_ERROR_IS_FATAL ANY)
    file(REMOVE_RECURSE ${files})
  endif()
endforeach()
