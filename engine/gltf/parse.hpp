// Parses the JSON and the bytes of a file with TinyGLTF, and lists the files that it names. Indices
// in the result are not checked, and images are not decoded. Private to engine/gltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/gltf/read_file.hpp"

namespace psygen::gltf {

// The member `image` of an image with a URI has the bytes of its file. Appends the files that it
// names to `named`. Fails like read_file(). Throws std::bad_alloc and exceptions of TinyGLTF.
core::Result<tinygltf::Model> parse(const std::filesystem::path& path, const Limits& limits,
                                    std::vector<std::filesystem::path>& named);

// True if the reader supports this extension of glTF.
bool is_supported(std::string_view extension);

}  // namespace psygen::gltf
