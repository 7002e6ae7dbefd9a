# Installs the package files, for `find_package(psygen COMPONENTS ...)` in other projects. Libraries
# and headers are installed by psygen_library(), a file of targets for each.
include(CMakePackageConfigHelpers)

get_target_property(psygen_components psygen_settings PSYGEN_COMPONENTS)
set(psygen_tables "")
foreach(component IN LISTS psygen_components)
  get_target_property(needs psygen_${component} PSYGEN_NEEDS)
  get_target_property(packages psygen_${component} PSYGEN_PACKAGES)
  string(APPEND psygen_tables "set(psygen_${component}_needs \"${needs}\")\n"
                              "set(psygen_${component}_packages \"${packages}\")\n")
endforeach()

set(psygen_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/psygen)
set(psygen_bin_dir ${CMAKE_INSTALL_BINDIR})
set(psygen_module_dir ${CMAKE_INSTALL_LIBDIR}/psygen)
set(psygen_data_dir ${CMAKE_INSTALL_DATADIR}/psygen)
configure_package_config_file(cmake/psygen-config.cmake.in psygen-config.cmake
  INSTALL_DESTINATION ${psygen_package_dir} PATH_VARS psygen_data_dir psygen_bin_dir psygen_module_dir)
write_basic_package_version_file(psygen-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/psygen-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/psygen-config-version.cmake
        DESTINATION ${psygen_package_dir} COMPONENT psygen_package)
install(FILES cmake/PsygenFrameTest.cmake cmake/PsygenRevision.cmake DESTINATION ${psygen_package_dir} COMPONENT psygen_package)
install(DIRECTORY cmake/modules DESTINATION ${psygen_package_dir} COMPONENT psygen_package)
install(FILES tools/gdb/psygen.py DESTINATION ${CMAKE_INSTALL_DATADIR}/psygen/gdb COMPONENT psygen_package)
include(PsygenPkgConfig)

# The documents, and all files that they link.
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT psygen_docs)
install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md LICENSE SECURITY.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT psygen_docs)
install(FILES ecs/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/ecs COMPONENT psygen_docs)
include(PsygenPackages)
