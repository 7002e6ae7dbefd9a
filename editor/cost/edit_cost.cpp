#include "editor/cost/edit_cost.hpp"

#include <QLocale>
#include <QObject>
#include <algorithm>
#include <cmath>

#include "editor/cost/block_cost.hpp"
#include "engine/synthesis/synthesize.hpp"
#include "engine/world/placement.hpp"

namespace psygen::editor {
namespace {

constexpr std::uint32_t kInstances = 6;  // of each scatter, and one with the highest values

struct MeshCost {
  double seconds = 0, bytes = 0;
};

MeshCost mesh_cost(const models::ModelType& type, models::ModelIndex model,
                   const models::Parameters& p, const synthesis::CostModel& costs) {
  MeshCost cost{costs.predict(model, p, 0), 0};
  if (const auto size = synthesis::mesh_size_guarded(type, p, 0)) cost.bytes = mesh_bytes(*size);
  return cost;
}

models::Parameters highest(const ParsedWorld& parsed, const world::Scatter& scatter) {
  const models::ModelType& type = parsed.registry[scatter.model];
  models::Parameters p = world::scatter_parameters(parsed.registry, scatter);
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size() && i < scatter.ranges.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kUser)
      world::set_parameter(type, p, i, scatter.ranges[i].high);
  }
  return p;
}

// `first`: the index of its first instance in a block.
void add_scatter(const ParsedWorld& parsed, const world::Scatter& scatter, std::uint32_t first,
                 const synthesis::CostModel& costs, EditCost& sum) {
  const models::ModelType& type = parsed.registry[scatter.model];
  const std::uint32_t drawn = std::min(scatter.count, kInstances);
  MeshCost mean, most = mesh_cost(type, scatter.model, highest(parsed, scatter), costs);
  for (std::uint32_t i = 0; i < drawn; ++i) {
    const MeshCost one = mesh_cost(
        type, scatter.model,
        world::draw_parameters(parsed.world, parsed.registry, scatter, {0, 0}, first + i), costs);
    mean.seconds += one.seconds / drawn;
    mean.bytes += one.bytes / drawn;
    most.seconds = std::max(most.seconds, one.seconds);
  }
  sum.block_seconds += scatter.count * mean.seconds;
  sum.block_bytes += scatter.count * mean.bytes;
  if (scatter.count == 0 || most.seconds <= sum.model_seconds) return;
  sum.model_seconds = most.seconds;
  sum.model = type.name();
}

QString seconds_text(double seconds) {
  const QLocale english(QLocale::English);
  return seconds < 0.0995 ? QObject::tr("%1 ms").arg(english.toString(seconds * 1e3, 'g', 2))
                          : QObject::tr("%1 s").arg(english.toString(seconds, 'g', 2));
}

}  // namespace

EditCost edit_cost(const ParsedWorld& parsed, const synthesis::CostModel* learnt) {
  synthesis::CostModel costs(parsed.registry);
  if (learnt != nullptr) costs.learn_from(*learnt);
  EditCost sum;
  const models::ModelIndex ground = parsed.world.terrain_model;
  const MeshCost terrain = mesh_cost(parsed.registry[ground], ground, parsed.world.terrain, costs);
  sum.block_seconds = terrain.seconds;
  sum.block_bytes = terrain.bytes;
  std::uint32_t first = 0;
  for (const world::Scatter& scatter : parsed.world.scatter) {
    add_scatter(parsed, scatter, first, costs, sum);
    first += scatter.count;
  }
  return sum;
}

QString cost_question(const EditCost& before, const EditCost& after, const CostLimits& limits) {
  const auto is_beyond = [&](double EditCost::*of, double limit) {
    return after.*of > limit && after.*of > before.*of;
  };
  const QLocale english(QLocale::English);
  if (is_beyond(&EditCost::model_seconds, limits.model_seconds))
    return QObject::tr("One model “%1” would take %2 of one core.")
        .arg(QString::fromStdString(after.model), seconds_text(after.model_seconds));
  if (!is_beyond(&EditCost::block_seconds, limits.block_seconds) &&
      !is_beyond(&EditCost::block_bytes, limits.cache_bytes / limits.blocks))
    return {};
  return QObject::tr(
             "A block at full detail would take %1 of one core and %2. The cache holds %3 of them.")
      .arg(seconds_text(after.block_seconds),
           english.formattedDataSize(std::llround(after.block_bytes), 1),
           english.toString(std::floor(limits.cache_bytes / std::max(after.block_bytes, 1.0))));
}

}  // namespace psygen::editor
