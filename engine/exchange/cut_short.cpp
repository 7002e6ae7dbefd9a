#include "engine/exchange/cut_short.hpp"

#include <algorithm>
#include <fstream>
#include <string>

namespace psygen::exchange {
namespace {

// Up to `count` bytes of the file from its start, or the last ones.
std::string bytes_of(const std::filesystem::path& path, std::size_t count, bool last) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  const auto size = static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0));
  std::string bytes(std::min(count, size), '\0');
  file.seekg(static_cast<std::streamoff>(last ? size - bytes.size() : 0));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

bool agree(std::string_view a, std::string_view b) {
  const std::size_t common = std::min(a.size(), b.size());
  return a.substr(0, common) == b.substr(0, common);
}

// A .glb starts with its name, its version and the length of the whole, little-endian.
bool glb_is_cut_short(const std::filesystem::path& path, std::uintmax_t size) {
  constexpr std::size_t kHead = 12;
  const std::string head = bytes_of(path, kHead, false);
  if (!agree(head, std::string_view("glTF\2\0\0\0", 8))) return false;
  if (head.size() < kHead) return true;
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i)
    length |= std::uint32_t{static_cast<unsigned char>(head[8 + i])} << (8 * i);
  return size < length;
}

bool obj_is_cut_short(const std::filesystem::path& path, std::string_view document_name) {
  const std::string first = obj_first_line(document_name);
  if (!agree(bytes_of(path, first.size(), false), first)) return false;
  std::filesystem::path mtl = path;
  mtl.replace_extension(".mtl");
  return bytes_of(path, kObjLastLine.size(), true) != kObjLastLine ||
         bytes_of(mtl, kObjLastLine.size(), true) != kObjLastLine;
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
