// The JSON and the bytes of a file as TinyGLTF gives them, with the files that it names. Indices in
// it are not checked, and pictures are not decoded. Private to engine/gltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/gltf/read_file.hpp"

namespace psygen::gltf {

// `image` of a picture with a URI holds the bytes of its file. Fails like read_file(). Throws
// std::bad_alloc, and what TinyGLTF may throw. Appends the files that it names to `named`.
core::Result<tinygltf::Model> parse(const std::filesystem::path& path, const Limits& limits,
                                    std::vector<std::filesystem::path>& named);

// Whether an extension of glTF is read.
bool is_supported(std::string_view extension);

}  // namespace psygen::gltf
