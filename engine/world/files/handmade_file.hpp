// Reads and writes the [[model]] tables of world files: handmade models in glTF files. It knows no
// glTF (files_beside.hpp). Internal to world; one thread per file. Format: docs/world-files.md.
#pragma once

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
// already has equal ones. Adds problems to `problems`; after a problem, do not use the result.
std::vector<HandmadeModel> read_handmade(TableReader& root, const HandmadeSource& source,
                                         Problems& problems);

// Appends tables to `out` that read_handmade() reads back as equal models.
void write_handmade(const std::vector<HandmadeModel>& models, std::string& out);

// Returns false and adds a problem if a name leads out of the folder of the world file.
bool check_name_beside(TableReader& reader, std::string_view key, const std::string& name);

}  // namespace psygen::world
