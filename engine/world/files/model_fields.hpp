// The parameters of one model in a world file: reads them and checks them against the model type.
// Also reads and writes the [[model]] tables: handmade models in glTF files. It knows no glTF
// (resource_loader.hpp) and no other tables (scatter_file.cpp, world_file.cpp). Internal to world;
// one thread per file. Format: docs/world-files.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/world/files/resource_loader.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The parameter ranges of one model in the file, in the order of its schema, with lines and names
// for messages.
struct ModelFields {
  const models::ModelType* type = nullptr;
  std::vector<ParameterRange> ranges;
  std::vector<int> lines;
  std::vector<std::string> names;  // full names in the file
};

// All parameters at their defaults, with the line `line`. `type` must outlive the result.
ModelFields fields_of(const models::ModelType& type, int line);

// Reads parameter `i` from `key`: a number or, if `is_range`, also [lowest, highest]. After a
// problem or for a missing key, the range keeps its value.
void read_parameter(TableReader& reader, std::string_view key, std::size_t i, bool is_range,
                    ModelFields& fields);

// The parameters at one corner of the ranges: bit b of `corner` selects an end of the b-th range
// whose ends differ.
models::Parameters corner_of(const ModelFields& fields, std::uint32_t corner);

// Validates every corner of the ranges. Adds the first problem and returns false if there is one.
// Exponential in the number of ranges, which is at most Parameters::kMaxCount.
bool check_model(const ModelFields& fields, Problems& problems);

// log2 of the largest number of triangles of any corner, allowed or rejected.
double log2_cost(const ModelFields& fields);

inline constexpr std::size_t kMaxHandmadeModels = 4096;  // per file

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
