// Documents as files: binary glTF 2.0 (.glb) and Wavefront OBJ with its materials (.mtl beside it).
// A file is there as a whole or not at all. Any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/exchange/document.hpp"

namespace psygen::exchange {

enum class Format : std::uint8_t { kGlb, kObj };
std::optional<Format> format_from(std::string_view name);  // "glb", "obj"
std::string_view name_of(Format format);

// The bytes of a .glb: one node with one mesh per object, one primitive per part. Colours are
// linear albedo (COLOR_0, 16 bits each). Fails with kOverBudget beyond the 4 GiB of the format.
core::Result<std::vector<std::uint8_t>> glb_bytes(const Document& document);

// Colours stand behind the coordinates of each vertex, as sRGB, which is what programs expect
// there; a material's Kd is the mean of its vertices.
struct ObjText {
  std::string obj, mtl;
};
ObjText obj_text(const Document& document, std::string_view mtl_file_name);
// Both texts end with this line, so that one that was cut short can be told from a whole one; an
// .obj starts with a comment that names the document.
inline constexpr std::string_view kObjLastLine = "# end\n";
std::string obj_first_line(std::string_view document_name);

// Writes `path`, and for kObj the .mtl of the same stem before it; where the disk has no room for
// both it leaves both as they were. Fails with kIo.
core::Result<void> write_document(const std::filesystem::path& path, Format format,
                                  const Document& document);

}  // namespace psygen::exchange
