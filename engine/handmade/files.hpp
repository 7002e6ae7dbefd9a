// Reads the files that a world file names (world/files/resource_loader.hpp): glTF models as model
// types with levels of detail, and images as grey values. Not for objects of a game with textures
// and animations (engine/prefab). Any thread; too slow for the tick.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/files/resource_loader.hpp"
#include "engine/world/world.hpp"

namespace psygen::handmade {

// The reader of this program. Models that a registry still has, and images in use, are not read
// again unless their file, or a file that it names, has changed in size or time.
const world::ResourceLoader& files();

// Images in memory, by their names in a world file.
using NamedPictures = std::map<std::string, std::shared_ptr<const world::GreyPicture>>;
struct InMemoryImages {
  NamedPictures in_place;   // replace the files, existing or missing
  NamedPictures fallbacks;  // used only if a file cannot be read
};
using MemoryPicturesPtr = std::shared_ptr<const InMemoryImages>;
using FilesPtr = std::shared_ptr<const world::ResourceLoader>;

// files() with images that an editor has not written yet; null: files() alone.
FilesPtr files_with(const std::filesystem::path& world_file, MemoryPicturesPtr pictures);

// All files that a world names, as paths relative to the folder of its file, each once: models,
// files named by .gltf files, masks, stamps and images of the ground. Reads the models; does not
// check that images exist. Fails like gltf::read_file().
core::Result<std::vector<std::filesystem::path>> files_named_by(
    const world::World& world, const std::filesystem::path& world_file);

// A hash of the contents of these files, in this order; 0 if there are none. Fails like
// files_named_by() and core::read_file().
core::Result<std::uint64_t> hash_of_files(const world::World& world,
                                          const std::filesystem::path& world_file);

}  // namespace psygen::handmade
