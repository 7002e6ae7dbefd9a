# Dear ImGui: target imgui::imgui. Debian's static library takes its fonts from libstb.
include(${CMAKE_CURRENT_LIST_DIR}/find_one_library.cmake)
find_one_library(imgui imgui/imgui.h)
find_package(stb REQUIRED)
set_target_properties(imgui::imgui PROPERTIES INTERFACE_LINK_LIBRARIES stb::stb)
