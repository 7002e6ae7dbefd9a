#include "engine/exchange/write_document.hpp"

#include <fmt/format.h>

#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::exchange {

std::string material_name(std::uint8_t material) {
  switch (material) {
    case kSolid:
      return "solid";
    case kLeaf:
      return "leaf";
    case kGround:
      return "ground";
    default:
      return fmt::format("material_{}", material);
  }
}

std::uint64_t Document::vertex_count() const {
  std::uint64_t count = 0;
  for (const Object& object : objects) {
    for (const Part& part : object.parts)
      count += part.positions.size();
  }
  return count;
}

std::uint64_t Document::triangle_count() const {
  std::uint64_t count = 0;
  for (const Object& object : objects) {
    for (const Part& part : object.parts)
      count += part.indices.size() / 3;
  }
  return count;
}

std::optional<Format> format_from(std::string_view name) {
  if (name == "glb") return Format::kGlb;
  if (name == "obj") return Format::kObj;
  return std::nullopt;
}

std::string_view name_of(Format format) {
  return format == Format::kGlb ? "glb" : "obj";
}

core::Result<void> write_scene(const std::filesystem::path& path, Format format,
                               const Document& document) {
  if (format == Format::kGlb) {
    const auto bytes = glb_bytes(document);
    if (!bytes) return tl::unexpected(bytes.error());
    return core::replace_file(path, *bytes);
  }
  std::filesystem::path mtl = path;
  // One line of the OBJ names it, so a line break in its name becomes an escape.
  mtl.replace_filename(core::shown(path.stem().string()) + ".mtl");
  const ObjText text = obj_text(document, mtl.filename().string());
  core::FileReplacement materials(mtl), objects(path);
  materials.write(text.mtl);
  objects.write(text.obj);
  if (auto ok = objects.flush(); !ok) return ok;
  if (auto ok = materials.commit(); !ok) return ok;
  return objects.commit();
}

}  // namespace psygen::exchange
