// The parameters of one model as a world file gives them: read, and checked against its type.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The ranges of one model as the file gives them, with the lines for messages.
struct ModelFields {
  const models::ModelType* type = nullptr;
  std::vector<ParameterRange> ranges;
  std::vector<int> lines;
  std::vector<std::string> names;  // as the file calls them
};

// Every parameter at its default, as if it stood in `line`.
ModelFields fields_of(const models::ModelType& type, int line);

// Reads parameter `i` from `key`: a number or, if `is_range`, also [lowest, highest].
void read_parameter(TableReader& reader, std::string_view key, std::size_t i, bool is_range,
                    ModelFields& fields);

// The parameters at one corner of the ranges: bit b of `corner` chooses the end of the b-th range
// that is not a single value.
models::Parameters corner_of(const ModelFields& fields, std::uint32_t corner);

// Asks the model about every corner of its ranges. False after a problem.
bool check_model(const ModelFields& fields, Problems& problems);

// The largest cost of any of them, as log2 of triangles, whether they are allowed or not.
double log2_cost(const ModelFields& fields);

}  // namespace psygen::world
