// The bytes of a glTF file's buffers, views and images. Each is read or decompressed at its first
// use, so what nothing uses may be missing. Only files in the file's folder or below are read.
// Private to engine/gltf.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gltf/document.hpp"
#include "engine/gltf/read_file.hpp"

namespace psygen::gltf {

// Reads and keeps bytes for one reader.
class Source {
 public:
  using Bytes = std::vector<std::uint8_t>;
  using View = std::span<const std::uint8_t>;

  // `binary` is the part of the file's bytes that is its first buffer; empty: none. All must
  // outlive this object. Appends the files that it reads to `out.files`, and those that do not
  // exist to `out.missing`.
  Source(const std::filesystem::path& path, const Document& file, View binary, Model& out,
         std::uint64_t left_bytes);

  // The bytes of a view. `what` names its user. Fails if they are not within its buffer.
  core::Result<View> of_view(int view, std::string_view what);
  // The bytes of a URI: base64, or a file. Fails with kIo if there is no such file.
  core::Result<Bytes> of_uri(const std::string& uri);
  // The files of images and buffers that do not exist, or may not be read, and that nothing has
  // asked for, among the first 1,024 of each.
  std::vector<std::string> unused_missing() const;

 private:
  bool lacks(const std::string& uri) const;
  core::Result<View> of_buffer(int buffer, std::string_view what);
  core::Result<View> part_of(int buffer, std::uint64_t offset, std::uint64_t bytes,
                             const std::string& what);
  core::Result<View> unpack(const PackedJson& packed, std::size_t view);

  const std::filesystem::path& path_;
  const Document& file_;
  View binary_;
  Model& out_;
  std::uint64_t left_bytes_;
  std::vector<std::optional<Bytes>> buffers_, unpacked_;  // those in use; the second by view
};

}  // namespace psygen::gltf
