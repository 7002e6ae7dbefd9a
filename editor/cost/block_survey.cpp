#include "editor/cost/block_survey.hpp"

#include <set>

#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/world_parts.hpp"

namespace psygen::editor {
namespace {

constexpr int kBlocks = 4;                // in the mean
constexpr double kMaxMeasuredS = 0.0125;  // predicted, of the synthesised block

// Processor seconds to synthesise a mesh; nullopt if that fails.
std::optional<double> make_mesh(const models::ModelType& type, const models::Parameters& p) {
  const auto memory = synthesis::HeapDestination::make(type, p, 0);
  if (!memory) return std::nullopt;
  const double start_s = core::thread_cpu_seconds();
  if (!synthesis::synthesise_guarded(type, p, 0, memory->view()).ok) return std::nullopt;
  return core::thread_cpu_seconds() - start_s;
}

// Hashes of the inputs of each scatter, and last of the ground.
std::vector<std::uint64_t> keys_of(const ParsedWorld& parsed) {
  const world::WorldParts parts = world::parts_of(parsed.world, parsed.registry);
  std::vector<std::uint64_t> keys;
  for (std::size_t s = 0; s < parts.places.size(); ++s)
    keys.push_back(core::combine(parts.places[s], parts.models[s]));
  keys.push_back(parts.ground);
  return keys;
}

std::size_t scatter_of(const world::World& world, std::uint32_t index) {
  std::size_t scatter = 0;
  for (std::uint32_t first = 0; index - first >= world.scatter[scatter].count; ++scatter)
    first += world.scatter[scatter].count;
  return scatter;
}

}  // namespace

void BlockSurvey::Part::add(const MeshCost& mesh) {
  triangles += mesh.triangles;
  bytes += mesh.bytes;
  seconds += mesh.seconds;
}

// Adds unknown parts to known_, and the models placed by hand to `by_hand`.
void BlockSurvey::add_unknown_parts(const ParsedWorld& parsed, const synthesis::CostModel& costs,
                                    const std::vector<std::uint64_t>& keys, Part& by_hand) {
  const world::World& world = parsed.world;
  std::vector<bool> is_unknown;
  for (std::size_t s = 0; s < world.scatter.size(); ++s)
    is_unknown.push_back(!known_.contains(keys[s]));
  const bool ground = !known_.contains(keys.back());
  for (const std::uint64_t key : keys)
    known_[key];
  for (int i = 0; i < kBlocks; ++i) {
    const core::BlockCoord block = block_near(world, around_, i);
    if (ground) {
      known_[keys.back()].add(
          mesh_cost(parsed, world.terrain_model, world::terrain_parameters(world, block), costs));
    }
    world::place_models(world, parsed.registry, block, is_unknown, placements_);
    for (const world::Placement& placed : placements_) {
      Part& part = placed.index >= world::kPlacedIndex
                       ? by_hand
                       : known_[keys[scatter_of(world, placed.index)]];
      ++part.models;
      part.add(mesh_cost(parsed, placed.model, placed.parameters, costs));
    }
  }
}

// Ratio of measured to predicted synthesis time of a block; 0 if the block is not synthesised.
double BlockSurvey::measured_factor(const ParsedWorld& parsed, const synthesis::CostModel& costs) {
  const core::BlockCoord block = block_near(parsed.world, around_, 0);
  world::place_models(parsed.world, parsed.registry, block, placements_);
  placements_.push_back({parsed.world.terrain_model, world::kTerrainIndex, glm::vec3(0),
                         world::terrain_parameters(parsed.world, block)});
  double predicted_s = 0, measured_s = 0;
  for (const world::Placement& placed : placements_)
    predicted_s += costs.predict(placed.model, placed.parameters, 0);
  if (predicted_s <= 0 || predicted_s > kMaxMeasuredS) return 0;
  for (const world::Placement& placed : placements_)
    measured_s += make_mesh(parsed.registry[placed.model], placed.parameters).value_or(0);
  return measured_s / predicted_s;
}

BlockCost BlockSurvey::cost(const ParsedWorld& parsed, bool measure) {
  synthesis::CostModel costs(parsed.registry);
  if (learnt_ != nullptr) costs.learn_from(*learnt_);
  const std::vector<std::uint64_t> keys = keys_of(parsed);
  Part all;
  add_unknown_parts(parsed, costs, keys, all);
  const std::set<std::uint64_t> present(keys.begin(), keys.end());
  std::erase_if(known_, [&](const auto& entry) { return !present.contains(entry.first); });
  for (const auto& [key, part] : known_) {
    all.models += part.models;
    all.add({part.triangles, part.bytes, part.seconds});
  }
  BlockCost mean{.models = all.models / kBlocks,
                 .triangles = all.triangles / kBlocks,
                 .bytes = all.bytes / kBlocks,
                 .seconds = all.seconds / kBlocks};
  if (const double factor = measure ? measured_factor(parsed, costs) : 0; factor > 0)
    mean.measured_seconds = factor * mean.seconds;
  return mean;
}

}  // namespace psygen::editor
