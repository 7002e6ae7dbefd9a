#include "engine/world/files/scatter_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/mask_file.hpp"
#include "engine/world/files/model_fields.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

// log2 of the maximum number of triangles of all models of one block.
constexpr double kMaxLog2BlockCost = 26;

// The number of models of a [[scatter]] per block, or 0 after a problem. Numbers that are too large
// are returned too, so the caller can reject them with their cost.
std::int64_t read_count(TableReader& reader) {
  const Member* member = reader.find("count");
  if (member != nullptr && member->value.kind == Node::Kind::kInteger &&
      member->value.integer > kMaxModelsPerBlock)
    return member->value.integer;
  std::int64_t count = 0;
  reader.read("count", count, {0, kMaxModelsPerBlock}, Presence::kRequired);
  return count;
}

// Reads one [[scatter]]. Returns log2 of its largest number of triangles per block.
double read_scatter(const Node& node, std::size_t number, const models::Registry& registry,
                    const Beside& beside, World& world, Problems& problems) {
  TableReader reader(node, fmt::format("scatter[{}]", number), node.line, problems);
  const int model = read_model_name(reader, world, registry);
  if (model < 0) return 0;
  Scatter scatter;
  scatter.model = static_cast<models::ModelIndex>(model);
  const std::int64_t count = read_count(reader);
  const bool too_many = count > kMaxModelsPerBlock;
  scatter.count = too_many ? 0 : static_cast<std::uint32_t>(count);
  visit_place(scatter, [&reader](std::string_view key, double& field, const FieldSpec& spec) {
    reader.read(key, field, {spec.low, spec.high});
  });
  if (scatter.min_height_m > scatter.max_height_m)
    reader.problem(node.line, "min_height_m", "it must not be above max_height_m");

  read_mask(reader, world, beside, scatter.mask);
  ModelFields fields = fields_of(registry[scatter.model], node.line);
  const auto specs = fields.type->parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kUser)
      read_parameter(reader, specs[i].name, i, true, fields);
  }
  reader.finish();
  const bool allowed = check_model(fields, problems) && !too_many;
  const double cost =
      log2_cost(fields) + std::log2(std::max<double>(static_cast<double>(count), 1));
  if (too_many)
    reader.problem(reader.find("count")->line, "count",
                   fmt::format("{} is not allowed: it must be an integer from 0 to {} ({} on each "
                               "block)",
                               count, kMaxModelsPerBlock, models::predicted_cost_text(cost)));
  scatter.ranges = std::move(fields.ranges);
  world.scatter.push_back(std::move(scatter));
  return allowed ? cost : 0;
}

}  // namespace

int read_model_name(TableReader& reader, const World& world, const models::Registry& registry) {
  std::string name;
  if (!reader.read("model", name, 64, Presence::kRequired)) return -1;
  const int index = registry.find(name);
  if (index >= 0 && index != world.terrain_model) return index;
  std::vector<std::string> known;
  for (models::ModelIndex i = 0; i < registry.size(); ++i) {
    if (i != world.terrain_model) known.emplace_back(registry[i].name());
  }
  reader.problem(
      reader.find("model")->line, "model",
      fmt::format("there is no such model to scatter; allowed: {}", fmt::join(known, ", ")));
  return -1;
}

void read_scatters(TableReader& root, const models::Registry& registry, const Beside& beside,
                   World& world, Problems& problems) {
  double triangles = 0;
  std::size_t number = 0;
  int line = root.line();
  for (const Node* node : root.tables("scatter", kMaxScatters)) {
    triangles += std::exp2(read_scatter(*node, number++, registry, beside, world, problems));
    line = node->line;
  }
  if (models_per_block(world) > kMaxModelsPerBlock)
    problems.add(line, "scatter",
                 fmt::format("{} models on each block are too many (allowed: {})",
                             models_per_block(world), kMaxModelsPerBlock),
                 core::ErrorCode::kOverBudget);
  if (triangles > std::exp2(kMaxLog2BlockCost))
    problems.add(line, "scatter",
                 fmt::format("the models of one block together are too large (predicted: up to "
                             "{:.3g} million triangles; allowed: {:.0f} million)",
                             triangles / 1e6, std::exp2(kMaxLog2BlockCost) / 1e6),
                 core::ErrorCode::kOverBudget);
}

}  // namespace psygen::world
