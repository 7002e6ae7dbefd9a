#include "engine/exchange/write_document.hpp"

#include <fmt/format.h>

#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/image/image_io.hpp"

namespace psygen::exchange {

std::string material_name(std::uint8_t material) {
  switch (material) {
    case kSolid:
      return "solid";
    case kLeaf:
      return "leaf";
    case kWater:
      return "water";
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

ObjNames obj_names(const std::filesystem::path& obj) {
  const std::string stem = core::shown(obj.stem().string());
  return {stem + ".mtl", stem + ".colours.png"};
}

namespace {

core::Result<void> write_obj(const std::filesystem::path& path, const Document& document) {
  const ObjNames names = obj_names(path);
  const auto files = obj_files(document, names);
  if (!files) return tl::unexpected(files.error());
  const std::filesystem::path folder = path.parent_path();
  const auto png = image::encode_png(folder / names.image, files->colours);
  if (!png) return tl::unexpected(png.error());
  core::FileReplacement materials(folder / names.mtl), colours(folder / names.image), objects(path);
  materials.write(files->mtl);
  colours.write({reinterpret_cast<const char*>(png->data()), png->size()});
  objects.write(files->obj);
  if (auto ok = objects.flush(); !ok) return ok;
  if (auto ok = colours.flush(); !ok) return ok;
  if (auto ok = materials.commit(); !ok) return ok;
  if (auto ok = colours.commit(); !ok) return ok;
  return objects.commit();
}

}  // namespace

core::Result<void> write_scene(const std::filesystem::path& path, Format format,
                               const Document& document) {
  if (format == Format::kObj) return write_obj(path, document);
  const auto bytes = glb_bytes(document);
  if (!bytes) return tl::unexpected(bytes.error());
  return core::replace_file(path, *bytes);
}

}  // namespace psygen::exchange
