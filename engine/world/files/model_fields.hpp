// The parameters of one model in a world file: reads them and checks them against the model type.
// Internal to world; one thread per file. It knows no tables (scatter_file.cpp, world_file.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace psygen::world
