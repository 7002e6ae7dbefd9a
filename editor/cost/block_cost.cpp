#include "editor/cost/block_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "editor/document/scale.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world_parts.hpp"

namespace psygen::editor {
namespace {

using world::FieldKind;

constexpr int kPoints = 24;               // of a curve of reals
constexpr int kMeasuredEvery = 6;         // points
constexpr int kBlocks = 4;                // in the mean
constexpr double kMaxMeasuredS = 0.0125;  // predicted, of the synthesised block

std::string toml_of(const world::WorldField& field, double value) {
  const bool integer = is_whole(field.kind);
  if (field.kind == FieldKind::kInteger || field.kind == FieldKind::kReal)
    return integer ? world::toml_number(static_cast<std::int64_t>(std::llround(value)))
                   : world::toml_number(value);
  return world::toml_range(std::min(field.numbers[0], value), value, integer);
}

// Makes texts that differ in one value. Finds the position of the value only once.
class TextsOfField {
 public:
  TextsOfField(const std::string& text, const world::TextPath& path) : text_(text), path_(path) {
    static constexpr std::string_view kMark = "\"\\u0001 value \\u0001\"";
    const auto marked = world::with_value(text, path, kMark);
    const std::size_t at = marked ? marked->find(kMark) : std::string::npos;
    if (at == std::string::npos || marked->find(kMark, at + 1) != std::string::npos) return;
    is_found_ = true;
    before_ = marked->substr(0, at);
    behind_ = marked->substr(at + kMark.size());
  }
  core::Result<std::string> with(const std::string& toml) const {
    if (is_found_) return before_ + toml + behind_;
    return world::with_value(text_, path_, toml);
  }

 private:
  const std::string& text_;
  const world::TextPath& path_;
  bool is_found_ = false;
  std::string before_, behind_;
};

std::vector<double> values_of(const world::WorldField& field) {
  const Scale scale = scale_of(field);
  const double span = scale.high - scale.low;
  const int points = scale.whole ? static_cast<int>(std::min<double>(span + 1, kPoints)) : kPoints;
  std::vector<double> values;
  for (int i = 0; i < points; ++i)
    values.push_back(scale.at(points > 1 ? static_cast<double>(i) / (points - 1) : 0));
  return values;
}

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

void add(BlockCost& sum, const MeshCost& mesh) {
  sum.triangles += mesh.triangles;
  sum.bytes += mesh.bytes;
  sum.seconds += mesh.seconds;
}

// Ratio of measured to predicted synthesis time of a block; 0 if the block is not synthesised.
double measured_factor(const ParsedWorld& parsed, const synthesis::CostModel& costs,
                       core::BlockCoord block) {
  std::vector<world::Placement> placements;
  world::place_models(parsed.world, parsed.registry, block, placements);
  placements.push_back({parsed.world.terrain_model, world::kTerrainIndex, glm::vec3(0),
                        world::terrain_parameters(parsed.world, block)});
  double predicted_s = 0, measured_s = 0;
  for (const world::Placement& placed : placements)
    predicted_s += costs.predict(placed.model, placed.parameters, 0);
  if (predicted_s <= 0 || predicted_s > kMaxMeasuredS) return 0;
  for (const world::Placement& placed : placements)
    measured_s += make_mesh(parsed.registry[placed.model], placed.parameters).value_or(0);
  return measured_s / predicted_s;
}

}  // namespace

core::BlockCoord block_near(const world::World& world, core::BlockCoord around, int number) {
  // The corners of a square, then the middles of the sides of a larger one, then both farther out.
  constexpr std::array<std::array<int, 2>, 8> kOffsets{
      {{-3, -3}, {3, 3}, {3, -3}, {-3, 3}, {0, -6}, {0, 6}, {-6, 0}, {6, 0}}};
  const auto& offset = kOffsets[static_cast<std::size_t>(number) % kOffsets.size()];
  const int ring = 1 + number / static_cast<int>(kOffsets.size());
  const auto clamped = [](std::int64_t at, std::int64_t blocks) {
    return static_cast<std::int32_t>(blocks == 0 ? at
                                                 : std::clamp<std::int64_t>(at, 0, blocks - 1));
  };
  return {clamped(std::int64_t{around.x} + offset[0] * ring, world.blocks_x),
          clamped(std::int64_t{around.z} + offset[1] * ring, world.blocks_z)};
}

MeshCost mesh_cost(const ParsedWorld& parsed, models::ModelIndex model, const models::Parameters& p,
                   const synthesis::CostModel& costs) {
  MeshCost cost;
  cost.seconds = costs.predict(model, p, 0);
  const auto size = synthesis::mesh_size_guarded(parsed.registry[model], p, 0);
  if (!size) return cost;
  cost.triangles = size->triangle_count();
  cost.bytes = static_cast<double>(size->vertex_count) * core::vertex_stride_bytes(size->layout) +
               (size->shared_indices != 0 ? 0.0 : 2.0 * size->index_count);
  return cost;
}

bool has_cost_curve(const world::WorldField& field) {
  const bool number = field.kind == FieldKind::kInteger || field.kind == FieldKind::kReal ||
                      field.kind == FieldKind::kIntegerRange || field.kind == FieldKind::kRealRange;
  const std::string& table = field.path.empty() ? std::string() : field.path.steps[0].key;
  return number && !field.numbers.empty() && table != "sky" && table != "palette" &&
         table != "water";
}

// Adds unknown parts to known_. Returns the sum of the models placed by hand.
BlockCost BlockSurvey::add_unknown_parts(const ParsedWorld& parsed,
                                         const synthesis::CostModel& costs,
                                         const std::vector<std::uint64_t>& keys) {
  const world::World& world = parsed.world;
  std::vector<bool> is_unknown;
  for (std::size_t s = 0; s < world.scatter.size(); ++s)
    is_unknown.push_back(!known_.contains(keys[s]));
  const bool ground = !known_.contains(keys.back());
  for (const std::uint64_t key : keys)
    known_[key];
  BlockCost by_hand;
  std::vector<world::Placement> placements;
  for (int i = 0; i < kBlocks; ++i) {
    const core::BlockCoord block = block_near(world, around_, i);
    if (ground)
      add(known_[keys.back()],
          mesh_cost(parsed, world.terrain_model, world::terrain_parameters(world, block), costs));
    world::place_models(world, parsed.registry, block, is_unknown, placements);
    for (const world::Placement& placed : placements) {
      BlockCost& part = placed.index >= world::kPlacedIndex
                            ? by_hand
                            : known_[keys[scatter_of(world, placed.index)]];
      ++part.models;
      add(part, mesh_cost(parsed, placed.model, placed.parameters, costs));
    }
  }
  return by_hand;
}

BlockCost BlockSurvey::cost(const ParsedWorld& parsed, bool measure) {
  synthesis::CostModel costs(parsed.registry);
  if (learnt_ != nullptr) costs.learn_from(*learnt_);
  const std::vector<std::uint64_t> keys = keys_of(parsed);
  BlockCost all = add_unknown_parts(parsed, costs, keys);
  const std::set<std::uint64_t> present(keys.begin(), keys.end());
  std::erase_if(known_, [&](const auto& entry) { return !present.contains(entry.first); });
  for (const auto& [key, part] : known_) {
    all.models += part.models;
    add(all, {part.triangles, part.bytes, part.seconds});
  }
  for (double BlockCost::*of :
       {&BlockCost::models, &BlockCost::triangles, &BlockCost::bytes, &BlockCost::seconds})
    all.*of /= kBlocks;
  const core::BlockCoord first = block_near(parsed.world, around_, 0);
  if (const double factor = measure ? measured_factor(parsed, costs, first) : 0; factor > 0)
    all.measured_seconds = factor * all.seconds;
  return all;
}

BlockCost block_cost(const ParsedWorld& parsed, core::BlockCoord around,
                     const synthesis::CostModel* learnt, bool measure) {
  return BlockSurvey(around, learnt).cost(parsed, measure);
}

std::vector<CostPoint> cost_curve(const CurveInput& input, const std::function<bool()>& go_on) {
  const world::WorldField& field = input.field;
  std::vector<CostPoint> curve;
  if (!has_cost_curve(field)) return curve;
  BlockSurvey survey(input.around, input.learnt);
  const TextsOfField texts(input.text, field.path);
  int number = 0;
  for (const double value : values_of(field)) {
    if (!go_on()) return {};
    CostPoint point{.value = value};
    const auto changed = texts.with(toml_of(field, value));
    const auto parsed =
        changed ? parse_world_text(*changed, input.file, input.register_models, input.files)
                : tl::make_unexpected(changed.error());
    if (parsed) {
      point.cost = survey.cost(**parsed, number++ % kMeasuredEvery == 0);
    } else {
      point.error = parsed.error().message;
    }
    curve.push_back(std::move(point));
  }
  return curve;
}

}  // namespace psygen::editor
