// Writes documents as files: binary glTF 2.0 (.glb), or Wavefront OBJ with its materials in a .mtl
// next to it. Every file is replaced as a whole, so it is never half-written. Any thread, linear in
// the document.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/exchange/document.hpp"

namespace psygen::exchange {

// File formats; and their names, which are also their extensions.
enum class Format : std::uint8_t { kGlb, kObj };
std::optional<Format> format_from(std::string_view name);  // "glb", "obj"
std::string_view name_of(Format format);

// The bytes of a .glb: one node with one mesh per object, one primitive per part. Colours are
// linear albedo (COLOR_0, 16 bits each). Fails with kOverBudget beyond the 4 GiB of the format.
core::Result<std::vector<std::uint8_t>> glb_bytes(const Document& document);

// The texts of an OBJ file and of its materials file.
struct ObjText {
  std::string obj, mtl;
};
// The texts of a document. The colour of each vertex follows its coordinates, as sRGB, which other
// programs expect. The Kd of a material is the mean linear albedo of its vertices, as Blender reads
// it.
ObjText obj_text(const Document& document, std::string_view mtl_file_name);
// The last line of both texts, by which is_cut_short() recognises a whole file. And the first line
// of an .obj, a comment with the document's name.
inline constexpr std::string_view kObjLastLine = "# end\n";
std::string obj_first_line(std::string_view document_name);

// Writes `path`. For kObj it first replaces the .mtl of the same stem; if the disk has no room for
// both, both files stay unchanged. Fails with kIo, and like glb_bytes().
core::Result<void> write_scene(const std::filesystem::path& path, Format format,
                               const Document& document);

// True if a file that write_scene() wrote for a document of this name is truncated, for example
// because a disk was full while it was copied: `path` is empty or ends early (a .glb: shorter than
// its header states), or the .mtl of an .obj is missing or empty. Does not detect damage within a
// file. False for a whole file, even with additions to it or to its materials, and for a file that
// starts differently, does not exist or cannot be read. Reads a whole .obj, but only the head of a
// .glb.
bool is_cut_short(const std::filesystem::path& path, Format format, std::string_view document_name);

}  // namespace psygen::exchange
