# Compiler settings, and the functions that every folder uses:
#   psygen_library(NAME ...)                        the library of a folder: target, headers, component
#   psygen_executable(NAME SOURCES ... PRIVATE ...) a program in bin/ of the build folder
#   psygen_install_program(NAME COMPONENT ...)      the program with its pages (cmake/PsygenProgram.cmake)
# All presets but dev use CMAKE_UNITY_BUILD: the files of a target are compiled together, in a third of the
# time. Files that repeat private names of others are compiled alone (cmake/PsygenUnity.cmake). All settings
# apply to this project's targets only. Projects that use or contain this one keep theirs.
include(GNUInstallDirs)
include(PsygenProgram)
include(PsygenRevision)
include(PsygenUnity)
include(PsygenVersions)

if(NOT CMAKE_CXX_STANDARD OR CMAKE_CXX_STANDARD LESS 20)
  set(CMAKE_CXX_STANDARD 20)
endif()
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)  # targets that link a folder see its packages
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
  endif()
endif()

if(PSYGEN_REPRODUCIBLE)
  add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}=.)
endif()

# One compiler cache for all clones: paths in it are relative to the clone. Files from a cache may name another folder
# of a build, so that reproducible builds do without.
find_program(PSYGEN_CCACHE ccache)
if(PSYGEN_CCACHE AND NOT PSYGEN_REPRODUCIBLE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${PSYGEN_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()

# Sources that call the operating system end in its name: NAME_posix.cpp, NAME_windows.cpp.
set(PSYGEN_SYSTEM posix)
if(WIN32)
  set(PSYGEN_SYSTEM windows)
endif()

# The library of dlopen(); none if it is part of the C library (glibc 2.34).
include(CheckFunctionExists)
check_function_exists(dlopen PSYGEN_DLOPEN_IN_LIBC)
set(PSYGEN_DL "")
if(NOT PSYGEN_DLOPEN_IN_LIBC)
  set(PSYGEN_DL ${CMAKE_DL_LIBS})
endif()

# Settings of this project's own compilation. None of them reaches projects that use its libraries.
add_library(psygen_settings INTERFACE)
add_library(psygen::settings ALIAS psygen_settings)
if(WIN32)
  target_compile_definitions(psygen_settings INTERFACE _WIN32_WINNT=0x0A00 WIN32_LEAN_AND_MEAN NOMINMAX)  # Windows 10
endif()
# Same bits everywhere: no fused multiply-add unless the source asks for it (docs/models.md).
target_compile_options(psygen_settings INTERFACE -ffp-contract=off)

add_library(psygen_warnings INTERFACE)
target_compile_options(psygen_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow
                       $<$<BOOL:${PSYGEN_WERROR}>:-Werror>)

# Sanitizers must be in every file of a program.
add_library(psygen_sanitizers INTERFACE)
if(PSYGEN_SANITIZE)
  target_compile_options(psygen_sanitizers INTERFACE -fsanitize=${PSYGEN_SANITIZE}
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(psygen_sanitizers INTERFACE -fsanitize=${PSYGEN_SANITIZE})
endif()
target_link_libraries(psygen_settings INTERFACE psygen_sanitizers)

# psygen_library(NAME SOURCES ... HEADERS ... PUBLIC ... PRIVATE ... [PUBLIC_PACKAGES ...] [PACKAGES ...])
# Target psygen_NAME with alias psygen::NAME. It is static, or shared with BUILD_SHARED_LIBS.
#   HEADERS           the public headers, which are installed. They include only each other, which a
#                     test enforces; all other headers are private.
#   PUBLIC, PRIVATE   the libraries that it may use. Folders are added in the order of their layers.
#   PUBLIC_PACKAGES, PACKAGES   arguments of find_package(), one package an item ("fmt 9"): packages of
#                     public headers, and packages of the sources only. This function and
#                     find_package(psygen COMPONENTS NAME) find them; projects that use shared libraries
#                     do not need PACKAGES.
# With PSYGEN_INSTALL it is installed as component psygen_NAME and exported as component NAME of the
# package, without another list. cmake/PsygenPkgConfig.cmake makes its file for pkg-config.
function(psygen_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE;PUBLIC_PACKAGES;PACKAGES" ${ARGN})
  psygen_find_packages(${ARG_PUBLIC_PACKAGES} ${ARG_PACKAGES})
  set(target psygen_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(psygen::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    PSYGEN_OWN ON  # a target of this project, not of one that contains it
    EXPORT_NAME ${name} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH "$ORIGIN;$ORIGIN/psygen")
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target}
    PUBLIC $<BUILD_INTERFACE:psygen_sanitizers> ${ARG_PUBLIC}
    PRIVATE $<BUILD_INTERFACE:psygen_settings> $<BUILD_INTERFACE:psygen_warnings> ${ARG_PRIVATE})
  psygen_separate_repeated_names(${target})
  psygen_note_component(${name} "${ARG_PUBLIC};${ARG_PRIVATE}" "${ARG_PUBLIC_PACKAGES}" "${ARG_PACKAGES}")
  if(PSYGEN_INSTALL)
    install(TARGETS ${target} EXPORT psygen_${name} COMPONENT psygen_${name}
            FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/psygen COMPONENT psygen_${name})
    install(EXPORT psygen_${name} NAMESPACE psygen:: FILE psygen-${name}-targets.cmake
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/psygen COMPONENT psygen_${name})
  endif()
endfunction()

# Finds packages of versions that fit; each item is a string of arguments to find_package().
function(psygen_find_packages)
  foreach(package IN LISTS ARGN)
    separate_arguments(package)
    find_package(${package} REQUIRED)
    list(GET package 0 name)
    psygen_check_version(${name})
    psygen_note_version(${name})
  endforeach()
endfunction()

# Records the version of a package that was found, for psygen doctor.
macro(psygen_note_version name)
  if(NOT "${${name}_VERSION}" STREQUAL "")
    set_property(TARGET psygen_settings APPEND PROPERTY PSYGEN_PACKAGE_VERSIONS "${name}=${${name}_VERSION}")
  endif()
endmacro()

# Records the data that cmake/PsygenInstall.cmake writes into the package: components in the order of their
# declaration, and for each its packages and the components that it needs, itself last.
function(psygen_note_component name libraries public_packages packages)
  set(needs "")
  foreach(library IN LISTS libraries)
    if(library MATCHES "^psygen::(.+)$")
      get_target_property(more psygen_${CMAKE_MATCH_1} PSYGEN_NEEDS)
      if(NOT more)
        message(FATAL_ERROR "psygen_library(${name}): add the folder of ${library} before this one")
      endif()
      list(APPEND needs ${more})
    endif()
  endforeach()
  list(APPEND needs ${name})
  list(REMOVE_DUPLICATES needs)
  if(NOT BUILD_SHARED_LIBS)
    list(APPEND public_packages ${packages})
  endif()
  set_target_properties(psygen_${name} PROPERTIES PSYGEN_NEEDS "${needs}" PSYGEN_PACKAGES "${public_packages}")
  set_property(TARGET psygen_settings APPEND PROPERTY PSYGEN_COMPONENTS ${name})
endfunction()

# Links folders of data beside the programs, which look for them there: in the folder of each configuration if a
# build has several.
function(psygen_link_data)
  foreach(configuration "" ${CMAKE_CONFIGURATION_TYPES})
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/bin/${configuration})
    foreach(folder IN LISTS ARGN)
      file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${folder} ${PROJECT_BINARY_DIR}/bin/${configuration}/${folder}
           SYMBOLIC)
    endforeach()
  endforeach()
endfunction()

# Program NAME. PRIVATE lists the libraries that it uses.
function(psygen_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PRIVATE" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE psygen::settings psygen_warnings ${ARG_PRIVATE})
  # psygen::image finds its library in these folders. Old dynamic tags make them work inside the dlopen()
  # of sanitizers too.
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin
    PSYGEN_OWN ON
    BUILD_RPATH $<TARGET_FILE_DIR:psygen_openimageio>
    INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/psygen")
  target_link_options(${name} PRIVATE LINKER:--disable-new-dtags)
  psygen_separate_repeated_names(${name})
endfunction()
