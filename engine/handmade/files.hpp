// Reads the files that a world file names beside itself (world/files/files_beside.hpp): glTF models
// as model types with levels of detail, and pictures as grey values. Not for objects of a game with
// textures and animations (engine/prefab). Any thread; too slow for the tick.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/files/files_beside.hpp"
#include "engine/world/world.hpp"

namespace psygen::handmade {

// The reader of this program. Models that some registry still has, and pictures in use, are not
// read again, unless their file or one that it names has changed: another size, or another time.
const world::FilesBeside& files();

// Pictures in memory, by the names that a world file has for them.
using NamedPictures = std::map<std::string, std::shared_ptr<const world::GreyPicture>>;
struct MemoryPictures {
  NamedPictures in_place;       // in place of what the files hold, or of files that are not there
  NamedPictures where_missing;  // only where a file cannot be read
};
using MemoryPicturesPtr = std::shared_ptr<const MemoryPictures>;
using FilesPtr = std::shared_ptr<const world::FilesBeside>;

// files(), with pictures that an editor has not written yet; null: files() alone.
FilesPtr files_with(const std::filesystem::path& world_file, MemoryPicturesPtr pictures);

// All files that a world names beside its own, as paths from the folder of its file, each once:
// models, what their .gltf files name, masks, stamps and pictures of the ground. Reads the models.
// Fails like gltf::read_file(). Pictures are not looked for.
core::Result<std::vector<std::filesystem::path>> files_named_by(
    const world::World& world, const std::filesystem::path& world_file);

// The hash of what these files hold, in this order; 0 without any. Fails like files_named_by() and
// core::read_file().
core::Result<std::uint64_t> hash_of_files(const world::World& world,
                                          const std::filesystem::path& world_file);

}  // namespace psygen::handmade
