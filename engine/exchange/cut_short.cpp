#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "engine/exchange/write_document.hpp"

namespace psygen::exchange {
namespace {

// Up to `count` bytes from the start of the file; nothing if it cannot be read.
std::optional<std::string> first_bytes(const std::filesystem::path& path, std::size_t count) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(count, '\0');
  if (!file || (!file.read(bytes.data(), static_cast<std::streamsize>(count)) && !file.eof()))
    return std::nullopt;
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

bool agree(std::string_view a, std::string_view b) {
  const std::size_t common = std::min(a.size(), b.size());
  return a.substr(0, common) == b.substr(0, common);
}

// A .glb starts with "glTF", the version and the length of the whole file, little-endian.
bool glb_is_cut_short(const std::filesystem::path& path, std::uintmax_t size) {
  constexpr std::size_t kHead = 12;
  const auto head = first_bytes(path, kHead);
  if (!head || !agree(*head, std::string_view("glTF\2\0\0\0", 8))) return false;
  if (head->size() < kHead) return true;
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i)
    length |= std::uint32_t{static_cast<unsigned char>((*head)[8 + i])} << (8 * i);
  return size < length;
}

bool is_missing_or_empty(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? error == std::errc::no_such_file_or_directory : size == 0;
}

// Text after the last line of write_scene() is allowed.
bool obj_is_cut_short(const std::filesystem::path& path, std::string_view document_name) {
  const std::string first = obj_first_line(document_name);
  const auto head = first_bytes(path, first.size());
  if (!head || !agree(*head, first)) return false;
  const ObjNames names = obj_names(path);
  for (const std::string& name : {names.mtl, names.image}) {
    if (is_missing_or_empty(path.parent_path() / name)) return true;
  }
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return !file.bad() && text.size() >= head->size() && text.find(kObjLastLine) == std::string::npos;
}

}  // namespace

bool is_cut_short(const std::filesystem::path& path, Format format,
                  std::string_view document_name) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return false;
  if (size == 0) return true;
  return format == Format::kGlb ? glb_is_cut_short(path, size)
                                : obj_is_cut_short(path, document_name);
}

}  // namespace psygen::exchange
