# Compiler settings, and the two functions that every folder uses:
#   psygen_library(NAME SOURCES ... PUBLIC ... PRIVATE ...)   a static library, one per layer
#   psygen_executable(NAME SOURCES ... PRIVATE ...)           a program in bin/ of the build folder
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(PSYGEN_CCACHE ccache)
if(PSYGEN_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PSYGEN_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${PSYGEN_CCACHE})
endif()

add_library(psygen_settings INTERFACE)
add_library(psygen::settings ALIAS psygen_settings)
target_compile_features(psygen_settings INTERFACE cxx_std_20)
# Same bits everywhere: no fused multiply-add unless the source asks for it (docs/models.md).
target_compile_options(psygen_settings INTERFACE -ffp-contract=off)
target_compile_definitions(psygen_settings INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_XYZW_ONLY)

add_library(psygen_warnings INTERFACE)
target_compile_options(psygen_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow
                       $<$<BOOL:${PSYGEN_WERROR}>:-Werror>)

if(PSYGEN_SANITIZE)
  target_compile_options(psygen_settings INTERFACE -fsanitize=${PSYGEN_SANITIZE}
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(psygen_settings INTERFACE -fsanitize=${PSYGEN_SANITIZE})
endif()

set_property(GLOBAL PROPERTY PSYGEN_LIBRARIES "")

# Target psygen_NAME with alias psygen::NAME. PUBLIC and PRIVATE list the libraries that it may use.
function(psygen_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target psygen_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(psygen::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/psygen>)
  target_link_libraries(${target} PUBLIC psygen::settings ${ARG_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:psygen_warnings> ${ARG_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY PSYGEN_LIBRARIES ${target})
endfunction()

# Target NAME. PRIVATE lists the libraries that it uses.
function(psygen_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PRIVATE" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE psygen::settings psygen_warnings ${ARG_PRIVATE})
  # The folders in which psygen::image finds its library. Old dynamic tags make them work inside the
  # dlopen() of sanitizers too.
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin
    BUILD_RPATH ${PROJECT_BINARY_DIR}/engine/image
    INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR}/psygen)
  target_link_options(${name} PRIVATE LINKER:--disable-new-dtags)
endfunction()
