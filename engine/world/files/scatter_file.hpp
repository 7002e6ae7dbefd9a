// Reads and writes the models of a world file: the [[scatter]] tables with their masks, for models
// on every block, and the [[place]] tables, for single models. It reads no images
// (resource_loader.hpp). Internal to world; one thread per file. Format: docs/world-files.md.
#pragma once

#include <string>

#include "engine/world/files/resource_loader.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxScatters = 64;  // per file

// Reads all [[scatter]] tables, with the images of masks, into world.scatter. Adds problems for
// unknown models, for parameters that their types reject, and for too many models or triangles on a
// block. `world` must already have the values of [world] and its terrain.
void read_scatters(TableReader& root, const models::Registry& registry, const Beside& beside,
                   World& world);
// Reads all [[place]] tables. Requires world.terrain and world.seed.
std::vector<Place> read_places(TableReader& root, const models::Registry& registry,
                               const World& world);

// Append tables to `out` that are read back as equal scatters and places.
void write_scatters(const World& world, const models::Registry& registry, std::string& out);
void write_places(const World& world, const models::Registry& registry, std::string& out);

// Reads the name of an image beside the world file, and the image. Null if the key is missing or
// after a problem.
std::shared_ptr<const GreyPicture> read_picture(TableReader& reader, std::string_view key,
                                                const Beside& beside, std::string& name,
                                                Presence presence = Presence::kOptional);

// Reads the numbers, the image and its area of a mask. An area of all 0 is missing.
void read_mask(TableReader& reader, const Beside& beside, ScatterMask& mask);
// Appends the keys of a mask that differ from their defaults.
void write_mask(const ScatterMask& mask, std::string& out);

// Allowed kinds of ground as TOML: ["grass", "dry"].
std::string toml_grounds(std::uint32_t grounds);

}  // namespace psygen::world
