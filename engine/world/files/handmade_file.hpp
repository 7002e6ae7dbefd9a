// Reads and writes the [[model]] tables of world files: handmade models in glTF files. It knows no
// glTF (resource_loader.hpp). Internal to world; one thread per file. Format: docs/world-files.md.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/world/files/resource_loader.hpp"
#include "engine/world/files/table_reader.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxHandmadeModels = 64;  // per file

// The inputs for reading handmade models.
struct HandmadeSource {
  Beside beside;
  const models::Registry& registry;
  models::Registry* grown;  // the same registry, or null if it cannot grow
};

// Reads all models from the root table and adds their model types to the registry, unless it
// already has equal ones. After a problem, do not use the result.
std::vector<HandmadeModel> read_handmade(TableReader& root, const HandmadeSource& source);

// Appends tables to `out` that read_handmade() reads back as equal models.
void write_handmade(const std::vector<HandmadeModel>& models, std::string& out);

// Adds a type to the registry, unless it already has an equal one. `grown` is the same registry, or
// null if it cannot grow. Returns the reason if the registry cannot have the type.
std::optional<std::string> register_type(std::unique_ptr<models::ModelType> type,
                                         const models::Registry& registry, models::Registry* grown);

// Reads the name of a file of 1 to 200 bytes. Returns false if it is missing or wrong; a name that
// leads out of the folder of the world file is a problem.
bool read_name_beside(TableReader& reader, std::string_view key, std::string& name,
                      Presence presence = Presence::kOptional);

}  // namespace psygen::world
