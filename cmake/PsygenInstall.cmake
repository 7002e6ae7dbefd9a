# Installs libraries, headers and the package files, for `find_package(psygen)` in other projects.
include(CMakePackageConfigHelpers)

get_property(psygen_libraries GLOBAL PROPERTY PSYGEN_LIBRARIES)
install(TARGETS ${psygen_libraries} psygen_settings EXPORT psygen_targets)
set_target_properties(psygen_settings PROPERTIES EXPORT_NAME settings)
install(EXPORT psygen_targets NAMESPACE psygen:: FILE psygen-targets.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/psygen)
install(DIRECTORY ecs engine shaders DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/psygen
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h" PATTERN cli EXCLUDE)
configure_package_config_file(cmake/psygen-config.cmake.in psygen-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/psygen)
write_basic_package_version_file(psygen-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/psygen-config.cmake
              ${CMAKE_CURRENT_SOURCE_DIR}/cmake/FindBulletDouble.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/psygen-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/psygen)
