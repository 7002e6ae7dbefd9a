include(${CMAKE_CURRENT_LIST_DIR}/find_one_library.cmake)
find_one_library(imgui imgui/imgui.h)
