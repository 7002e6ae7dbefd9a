#include <algorithm>
#include <span>

#include "engine/core/hash.hpp"
#include "engine/core/read_file.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/handmade/files.hpp"
#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {

namespace fs = std::filesystem;

namespace {
constexpr std::uint64_t kMaxHashedBytes = std::uint64_t{1} << 30;
}  // namespace

core::Result<std::vector<fs::path>> files_named_by(const world::World& world,
                                                   const fs::path& world_file) {
  std::vector<fs::path> names;
  const auto note = [&names](const fs::path& name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const world::HandmadeModel& model : world.models) {
    note(model.file);
    const fs::path file = world_file.parent_path() / model.file;
    const auto read = gltf::read_file(file, gltf_limits());
    if (!read) return tl::unexpected(read.error());
    for (const fs::path& named : read->files)
      note(fs::path(model.file).parent_path() / named.lexically_relative(file.parent_path()));
  }
  for (const world::Scatter& scatter : world.scatter)
    note(scatter.mask.image);
  for (const world::Stamp& stamp : world.shaped.stamps)
    note(stamp.image);
  for (const std::string& image : world.palette.images)
    note(image);
  return names;
}

core::Result<std::uint64_t> hash_of_files(const world::World& world, const fs::path& world_file) {
  const auto names = files_named_by(world, world_file);
  if (!names) return tl::unexpected(names.error());
  std::uint64_t hash = 0;
  for (const fs::path& name : *names) {
    const auto bytes = core::read_file(world_file.parent_path() / name, kMaxHashedBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    hash = core::hash_bytes(std::as_bytes(std::span(*bytes)), hash);
  }
  return hash;
}

}  // namespace psygen::handmade
