# The packages that cpack makes (tools/package.sh): for Debian a .deb for each group of components, with debug symbols
# apart, and an archive of the programs that runs from any folder. cmake/package/options.cmake has settings that cpack
# reads when it runs.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(PSYGEN_MAINTAINER "The psygen authors <psygen@example.org>" CACHE STRING "Maintainer of the .deb files")

# Licences of psygen, and of the font and the libraries that its programs contain, as Debian has them.
file(READ LICENSE licences)
foreach(used fonts-dejavu-core libcli11-dev libexpected-dev libglm-dev libimgui-dev libtomlplusplus-dev libvulkan-volk-dev
             nlohmann-json3-dev)
  if(EXISTS /usr/share/doc/${used}/copyright)
    file(READ /usr/share/doc/${used}/copyright more)
    string(APPEND licences "\n\n${used}\n\n${more}")
  endif()
endforeach()
set(CPACK_PSYGEN_LICENCES ${PROJECT_BINARY_DIR}/licences.txt)
file(WRITE ${CPACK_PSYGEN_LICENCES} "${licences}")
install(FILES ${CPACK_PSYGEN_LICENCES} DESTINATION ${CMAKE_INSTALL_DATADIR}/psygen COMPONENT psygen_data)

set(CPACK_GENERATOR DEB TZST)
set(CPACK_PACKAGE_CONTACT ${PSYGEN_MAINTAINER})
set(CPACK_PACKAGE_FILE_NAME ${PROJECT_NAME}-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PSYGEN_SOURCE_DIR ${PROJECT_SOURCE_DIR})
set(CPACK_PSYGEN_STRIP ${CMAKE_STRIP})
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/package/options.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/finish_files.cmake)
set(CPACK_POST_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/finish_symbols.cmake)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEBUGINFO_PACKAGE ON)

# psygen_package(NAME SECTION DESCRIPTION COMPONENTS ... [DEPENDS ...] [RECOMMENDS ...] [SUGGESTS ...] [ALL])
# The package NAME with these components; components that are not built are left out. DESCRIPTION begins with a line of
# its own. ALL: it has no programs, so that it serves all architectures.
macro(psygen_package name section description)
  cmake_parse_arguments(ARG "ALL" "" "COMPONENTS;DEPENDS;RECOMMENDS;SUGGESTS" ${ARGN})
  foreach(component IN LISTS ARG_COMPONENTS)
    string(TOUPPER ${component} upper)
    set(CPACK_COMPONENT_${upper}_GROUP ${name})
    list(APPEND CPACK_COMPONENTS_ALL ${component})
  endforeach()
  string(TOUPPER ${name} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}")
  foreach(field DEPENDS RECOMMENDS SUGGESTS)
    list(JOIN ARG_${field} ", " CPACK_DEBIAN_${upper}_PACKAGE_${field})
  endforeach()
  if(ARG_ALL)
    set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE all)
  endif()
endmacro()

set(data "psygen-data (>= ${PROJECT_VERSION})")
set(driver "mesa-vulkan-drivers | vulkan-icd")
set(about "psygen is an engine for worlds that are far larger than memory: it makes\nonly the geometry that the camera is about to see.\n\n")
psygen_package(psygen graphics "procedural worlds larger than memory - command line
${about}This package has the command psygen, which flies through worlds, renders
images, exports models, regions and 3D Tiles, and tests frame times."
  COMPONENTS psygen_tools DEPENDS libvulkan1 "${data}" RECOMMENDS "${driver}" psygen-pictures SUGGESTS psygen-mpi psygen-doc)
psygen_package(psygen-data graphics "procedural worlds larger than memory - worlds
${about}This package has the worlds, camera paths and presets that come with psygen."
  COMPONENTS psygen_data ALL)
psygen_package(psygen-pictures graphics "procedural worlds larger than memory - image files
${about}This package reads and writes image files for the programs of psygen. They
need it to save images, and for worlds with masks and heights in image files."
  COMPONENTS psygen_pictures)
if(TARGET psygen_mpi)
  psygen_package(psygen-mpi graphics "procedural worlds larger than memory - MPI
${about}This package lets psygen run under mpirun, on many machines."
    COMPONENTS psygen_mpi DEPENDS psygen)
endif()
if(TARGET psygen-game)
  psygen_package(psygen-game games "walk through an endless land that hides twelve cairns
Shores with birches, oak woods, spruce woods, moor and snowy rock blend into
each other. Every word or number names another land. The land, its creatures,
all sounds and the music are made by code while the game runs."
    COMPONENTS psygen_game DEPENDS libvulkan1 "${data}" RECOMMENDS "${driver}" SUGGESTS psygen-pictures)
endif()
if(TARGET psygen-editor)
  psygen_package(psygen-editor graphics "procedural worlds larger than memory - editor
${about}This package has the editor. Each parameter of a world has a control, the
land follows at once, and a strip under each slider shows what values cost."
    COMPONENTS psygen_editor DEPENDS libvulkan1 psygen "${data}" RECOMMENDS "${driver}" psygen-pictures qt6-wayland
    SUGGESTS psygen-doc)
endif()
list(TRANSFORM psygen_components PREPEND psygen_ OUTPUT_VARIABLE libraries)
psygen_package(psygen-dev libdevel "procedural worlds larger than memory - development files
${about}This package has the libraries, headers, and files for CMake and pkg-config, to
build games and tools on psygen."
  COMPONENTS psygen_package ${libraries}
  DEPENDS libglm-dev libexpected-dev
  RECOMMENDS libfmt-dev libspdlog-dev libxxhash-dev libhwy-dev libmeshoptimizer-dev libtinygltf-dev libglfw3-dev
             libimgui-dev libstb-dev libcli11-dev nlohmann-json3-dev libsqlite3-dev libopenal-dev libsndfile1-dev
             libbullet-dev psygen psygen-pictures
  SUGGESTS psygen-doc)
psygen_package(psygen-doc doc "procedural worlds larger than memory - documents and examples
${about}This package has the guide, the pages on all parts of psygen, and examples."
  COMPONENTS psygen_docs ALL)
include(CPack)
