// Writes documents as files: binary glTF 2.0 (.glb), or Wavefront OBJ with its materials in a .mtl
// and their colours in a .png next to it. Every file is replaced as a whole, so it is never
// half-written. Any thread, linear in the document.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/exchange/document.hpp"
#include "engine/image/image.hpp"

namespace psygen::exchange {

// File formats; and their names, which are also their extensions.
enum class Format : std::uint8_t { kGlb, kObj };
std::optional<Format> format_from(std::string_view name);  // "glb", "obj"
std::string_view name_of(Format format);

// The bytes of a .glb: one node with one mesh per object, one primitive per part. Colours are
// linear albedo (COLOR_0, 16 bits each). Fails with kOverBudget beyond the 4 GiB of the format.
core::Result<std::vector<std::uint8_t>> glb_bytes(const Document& document);

// The names of the files next to an .obj: NAME.mtl and NAME.colours.png for NAME.obj. Line breaks,
// which would end the lines that name them, become escapes.
struct ObjNames {
  std::string mtl, image;
};
ObjNames obj_names(const std::filesystem::path& obj);

// The contents of an OBJ file, of its materials file, and of the image that both refer to.
struct ObjFiles {
  std::string obj, mtl;
  image::Image colours;
};
// The files of a document. The colour of each vertex follows its coordinates, as sRGB, which other
// programs expect. The image has them too, for programs that read only images (Blender): exact at
// the corners, and linear between them with bilinear filtering (triangle_colours.hpp). Fails with
// kOverBudget beyond 2^24 triangles of different colours.
core::Result<ObjFiles> obj_files(const Document& document, const ObjNames& names);
// The last line of both texts, by which is_cut_short() recognises a whole file. And the first line
// of an .obj, a comment with the document's name.
inline constexpr std::string_view kObjLastLine = "# end\n";
std::string obj_first_line(std::string_view document_name);

// Writes `path`. For kObj it first replaces the files of obj_names(); if the disk has no room for
// all, all stay unchanged. Fails with kIo, and like glb_bytes(), obj_files() and
// image::encode_png().
core::Result<void> write_scene(const std::filesystem::path& path, Format format,
                               const Document& document);

// True if a file that write_scene() wrote for a document of this name is truncated, for example
// because a disk was full while it was copied: `path` is empty or ends early (a .glb: shorter than
// its header states), or the .mtl or the .png of an .obj is missing or empty. Does not detect
// damage within a file. False for a whole file, even with additions to it or to its materials, and
// for a file that starts differently, does not exist or cannot be read. Reads a whole .obj, but
// only the head of a .glb.
bool is_cut_short(const std::filesystem::path& path, Format format, std::string_view document_name);

}  // namespace psygen::exchange
