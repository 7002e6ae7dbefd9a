// Reads glTF 2.0: .gltf with its buffers and pictures, and .glb. Files are not trusted: sizes and
// numbers are checked before anything is allocated for them, and nothing outside the file's
// folder is read. TinyGLTF parses the JSON and stays hidden here; psygen::image decodes pictures.
// Any thread; too slow for the tick.
#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/gltf/model.hpp"
#include "engine/image/image_io.hpp"

namespace psygen::gltf {

// The largest files that read_file() accepts.
struct Limits {
  std::uint64_t bytes = std::uint64_t{256} << 20;  // of the file and all that it names
  std::uint32_t json_values = 1 << 20;             // in its JSON
  std::uint32_t nodes = 1 << 16;
  std::uint32_t vertices = 1 << 22;  // of all meshes together
  std::uint32_t indices = 3 << 22;   // of all meshes together
  std::uint32_t keys = 1 << 20;      // values of all animations together
  image::ImageLimits images{8192, 8192, std::uint64_t{64} << 20, std::uint64_t{64} << 20};
  std::uint64_t pixel_bytes = std::uint64_t{256} << 20;  // of all pictures together, 4 a pixel
};

// The content of a file. Strips and fans become triangles. Fails with kIo (it or a file that it
// names cannot be read), kParse (damaged, not glTF 2.0, or out of range), kInvalidArgument (an
// extension is required that is not supported, sparse accessors, names of files outside its
// folder), kOverBudget (larger than the limits) or kOutOfMemory. The message starts with the path
// and says what is wrong where.
core::Result<Model> read_file(const std::filesystem::path& path, const Limits& limits = {});

}  // namespace psygen::gltf
