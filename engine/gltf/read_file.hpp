// Reads glTF 2.0: .gltf with its buffers and images, and .glb. Files are not trusted: sizes and
// numbers are checked before any allocation for them, and only files in the file's folder or below
// are read, and only those in use. psygen::image decodes images. Any thread; too slow for the
// tick.
#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/gltf/model.hpp"
#include "engine/image/image_io.hpp"

namespace psygen::gltf {

// The limits for files that read_file() accepts.
struct Limits {
  std::uint64_t bytes = std::uint64_t{256} << 20;  // of the file and all files that it names
  std::uint32_t json_values = 1 << 20;             // in the file's JSON
  std::uint32_t nodes = 1 << 16;
  std::uint32_t vertices = 1 << 22;  // of all meshes together
  std::uint32_t indices = 3 << 22;   // of all meshes together
  std::uint32_t keys = 1 << 20;      // values of all animations together
  image::ImageLimits images{8192, 8192, std::uint64_t{64} << 20, std::uint64_t{64} << 20};
  std::uint64_t pixel_bytes = std::uint64_t{256} << 20;  // of all images together, 4 per pixel
};

// The content of a file. Strips and fans become triangles, compressed meshes (meshopt, Draco) plain
// ones; texture coordinates are transformed (KHR_texture_transform). Fails with kIo (the file or a
// buffer that it uses cannot be read), kParse (damaged, not glTF 2.0, or out of range),
// kInvalidArgument (a required extension that is not supported, names of files outside its folder),
// kOverBudget (larger than the limits) or kOutOfMemory. The message starts with the path and names
// the faulty part. Images that `shared` knows are not decoded again; null: it knows none.
core::Result<Model> read_file(const std::filesystem::path& path, const Limits& limits = {},
                              image::ImageCache* shared = nullptr);

}  // namespace psygen::gltf
