// Reads and writes the [[model]] tables of world files: models that were made by hand, in glTF
// files beside the world file. It knows no glTF (files_beside.hpp). Internal to world; one thread
// per file. Format: docs/world-files.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/world/files/files_beside.hpp"
#include "engine/world/files/table_reader.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxHandmadeModels = 64;  // per file

// What handmade models are read with.
struct HandmadeSource {
  Beside beside;
  const models::Registry& registry;
  models::Registry* grown;  // the same, or null where it cannot grow
};

// Reads all models from the root table, and adds them to the registry as model types, unless it has
// equal ones. Faults are added to `problems`; then the result must not be used.
std::vector<HandmadeModel> read_handmade(TableReader& root, const HandmadeSource& source,
                                         Problems& problems);

// Appends tables to `out` from which read_handmade() makes equal models.
void write_handmade(const std::vector<HandmadeModel>& models, std::string& out);

// Adds a problem for a name that leads out of the folder of the world file, and returns false.
bool check_name_beside(TableReader& reader, std::string_view key, const std::string& name);

}  // namespace psygen::world
