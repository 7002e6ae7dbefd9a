#include "editor/cost/edit_cost.hpp"

#include <algorithm>
#include <cmath>

#include "editor/cost/block_cost.hpp"
#include "editor/document/qt_text.hpp"
#include "engine/world/placement.hpp"

namespace psygen::editor {
namespace {

constexpr std::uint32_t kInstances = 6;  // per scatter, besides one with the maximum values

models::Parameters max_parameters(const ParsedWorld& parsed, const world::Scatter& scatter) {
  const models::ModelType& type = parsed.registry[scatter.model];
  models::Parameters p = world::scatter_parameters(parsed.registry, scatter);
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size() && i < scatter.ranges.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kUser)
      world::set_parameter(type, p, i, scatter.ranges[i].high);
  }
  return p;
}

// `first`: index of the scatter's first instance in a block.
void add_scatter(const ParsedWorld& parsed, const world::Scatter& scatter, std::uint32_t first,
                 const synthesis::CostModel& costs, EditCost& sum) {
  const std::uint32_t drawn = std::min(scatter.count, kInstances);
  MeshCost mean, most = mesh_cost(parsed, scatter.model, max_parameters(parsed, scatter), costs);
  for (std::uint32_t i = 0; i < drawn; ++i) {
    const MeshCost one = mesh_cost(
        parsed, scatter.model,
        world::draw_parameters(parsed.world, parsed.registry, scatter, {0, 0}, first + i), costs);
    mean.seconds += one.seconds / drawn;
    mean.bytes += one.bytes / drawn;
    most.seconds = std::max(most.seconds, one.seconds);
  }
  sum.block_seconds += scatter.count * mean.seconds;
  sum.block_bytes += scatter.count * mean.bytes;
  if (scatter.count == 0 || most.seconds <= sum.model_seconds) return;
  sum.model_seconds = most.seconds;
  sum.model = parsed.registry[scatter.model].name();
}

}  // namespace

EditCost edit_cost(const ParsedWorld& parsed, const synthesis::CostModel* learnt) {
  synthesis::CostModel costs(parsed.registry);
  if (learnt != nullptr) costs.learn_from(*learnt);
  EditCost sum;
  const models::ModelIndex ground = parsed.world.terrain_model;
  const MeshCost terrain = mesh_cost(parsed, ground, parsed.world.terrain, costs);
  sum.block_seconds = terrain.seconds;
  sum.block_bytes = terrain.bytes;
  std::uint32_t first = 0;
  for (const world::Scatter& scatter : parsed.world.scatter) {
    add_scatter(parsed, scatter, first, costs, sum);
    first += scatter.count;
  }
  return sum;
}

QString confirmation_for(const EditCost& before, const EditCost& after, const CostLimits& limits) {
  const auto is_beyond = [&](double EditCost::*of, double limit) {
    return after.*of > limit && after.*of > before.*of;
  };
  if (is_beyond(&EditCost::model_seconds, limits.model_seconds))
    return tr("One model “%1” would take %2 to synthesise.")
        .arg(to_qstring(after.model), seconds_text(after.model_seconds));
  if (!is_beyond(&EditCost::block_seconds, limits.block_seconds) &&
      !is_beyond(&EditCost::block_bytes, limits.cache_bytes / limits.blocks))
    return {};
  return tr("A block at full detail would take %1 to synthesise and %2 of memory. The cache would "
            "hold %3 such blocks.")
      .arg(seconds_text(after.block_seconds), bytes_text(after.block_bytes, 1),
           kEnglish.toString(std::floor(limits.cache_bytes / std::max(after.block_bytes, 1.0))));
}

}  // namespace psygen::editor
