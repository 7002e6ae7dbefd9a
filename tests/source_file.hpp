// The files of the project that tests read. Only source_file.cpp knows where the project lies, so
// that the compiler's cache serves every clone.
#pragma once

#include <string>
#include <string_view>

namespace psygen {

// The path of a file of the project: source_file("game/worlds/paper.toml").
std::string source_file(std::string_view name);

}  // namespace psygen
