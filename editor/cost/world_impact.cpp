#include "editor/cost/world_impact.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "editor/cost/block_cost.hpp"
#include "editor/document/qt_text.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world_parts.hpp"

namespace psygen::editor {
namespace {

constexpr int kImpactBlocks = 8;
constexpr std::size_t kSamples = 24;     // meshes of each type whose cost is predicted
constexpr double kTypicalDetail = 0.25;  // fraction of full detail, if nothing is known

// Means over some meshes of a type at full detail.
struct MeanCost {
  MeshCost mean;
  std::size_t count = 0;

  void add(const ParsedWorld& parsed, models::ModelIndex model, const models::Parameters& p,
           const synthesis::CostModel& costs) {
    if (count == kSamples) return;
    const MeshCost one = mesh_cost(parsed, model, p, costs);
    const double share = 1.0 / static_cast<double>(++count);
    mean.seconds += (one.seconds - mean.seconds) * share;
    mean.bytes += (one.bytes - mean.bytes) * share;
  }
};

// Meshes of one type in the sample blocks: before, unchanged, and new or changed.
struct TypeChange {
  double before = 0, same = 0, fresh = 0;
  MeanCost cost_before, cost_fresh;

  double factor(double MeshCost::*of) const {
    const double was = cost_before.mean.*of, is = cost_fresh.mean.*of;
    return cost_before.count == 0 || cost_fresh.count == 0 || was <= 0 ? 1 : is / was;
  }
};

// Compares both worlds on the sample blocks.
class Comparison {
 public:
  Comparison(const ParsedWorld& before, const ParsedWorld& after,
             const synthesis::CostModel* learnt)
      : before_(before),
        after_(after),
        costs_before_(before.registry),
        costs_after_(after.registry) {
    if (learnt == nullptr) return;
    costs_before_.learn_from(*learnt);
    costs_after_.learn_from(*learnt);
  }

  void add(core::BlockCoord block) {
    add_ground(block);
    world::place_models(before_.world, before_.registry, block, old_);
    world::place_models(after_.world, after_.registry, block, new_);
    std::unordered_map<std::uint32_t, const world::Placement*> known;
    for (const world::Placement& placed : old_) {
      known[placed.index] = &placed;
      TypeChange& type = types_[name(before_, placed)];
      ++type.before;
      type.cost_before.add(before_, placed.model, placed.parameters, costs_before_);
    }
    for (const world::Placement& placed : new_) {
      const auto was = known.find(placed.index);
      TypeChange& type = types_[name(after_, placed)];
      if (was != known.end() && is_same(*was->second, placed)) {
        ++type.same;
        continue;
      }
      ++type.fresh;
      type.cost_fresh.add(after_, placed.model, placed.parameters, costs_after_);
    }
  }

  const std::map<std::string, TypeChange>& types() const { return types_; }
  const TypeChange& ground() const { return ground_; }
  bool any_model_changes() const {
    return std::ranges::any_of(types_, [](const auto& entry) {
      return entry.second.fresh > 0 || entry.second.same < entry.second.before;
    });
  }

 private:
  static std::string name(const ParsedWorld& parsed, const world::Placement& placed) {
    return std::string(parsed.registry[placed.model].name());
  }
  bool is_same(const world::Placement& a, const world::Placement& b) const {
    return a.parameters.hash() == b.parameters.hash() && name(before_, a) == name(after_, b);
  }
  void add_ground(core::BlockCoord block) {
    const auto was = world::terrain_parameters(before_.world, block);
    const auto is = world::terrain_parameters(after_.world, block);
    ++ground_.before;
    (was.hash() == is.hash() ? ground_.same : ground_.fresh) += 1;
    ground_.cost_before.add(before_, before_.world.terrain_model, was, costs_before_);
    ground_.cost_fresh.add(after_, after_.world.terrain_model, is, costs_after_);
  }

  const ParsedWorld &before_, &after_;
  synthesis::CostModel costs_before_, costs_after_;
  std::vector<world::Placement> old_, new_;
  std::map<std::string, TypeChange> types_;
  TypeChange ground_;
};

// Adds a type with cached meshes.
void add_held(const HeldMeshes& held, const TypeChange& change, WorldImpact& impact) {
  const auto meshes = static_cast<double>(held.meshes);
  impact.held += meshes;
  if (change.before <= 0) {  // no instance in the sample blocks
    impact.bytes += held.bytes;
    return;
  }
  const double fresh = change.fresh / change.before, same = change.same / change.before;
  impact.changed += meshes * fresh;
  impact.seconds += held.seconds * fresh * change.factor(&MeshCost::seconds);
  impact.bytes += held.bytes * (same + fresh * change.factor(&MeshCost::bytes));
}

// Adds types without cached meshes, at the detail of the types that have some.
void add_new(const Comparison& comparison, const CacheContents& contents, WorldImpact& impact) {
  double meshes = 0, placed = 0, seconds = 0, full_seconds = 0;
  std::map<std::string, bool> known;
  for (const HeldMeshes& held : contents.held) {
    const auto type = comparison.types().find(held.type);
    if (held.kind != HeldMeshes::Kind::kModel || type == comparison.types().end()) continue;
    known[held.type] = true;
    meshes += static_cast<double>(held.meshes);
    placed += type->second.before;
    seconds += held.seconds;
    full_seconds += static_cast<double>(held.meshes) * type->second.cost_before.mean.seconds;
  }
  if (placed <= 0) return;
  const double detail = full_seconds > 0 ? std::min(seconds / full_seconds, 1.0) : kTypicalDetail;
  for (const auto& [name, type] : comparison.types()) {
    if (known.contains(name) || type.fresh <= 0) continue;
    const double made = type.fresh * meshes / placed;
    impact.changed += made;
    impact.seconds += made * detail * type.cost_fresh.mean.seconds;
    impact.bytes += made * detail * type.cost_fresh.mean.bytes;
  }
}

// True if any mesh of the worlds may differ, at any place.
bool places_differ(const ParsedWorld& a, const ParsedWorld& b) {
  return world::parts_of(a.world, a.registry) != world::parts_of(b.world, b.registry) ||
         world::places_hash(a.world, a.registry) != world::places_hash(b.world, b.registry);
}

}  // namespace

WorldImpact impact_of(const ParsedWorld& before, const ParsedWorld& after, core::BlockCoord around,
                      const CacheContents& contents, const synthesis::CostModel* learnt) {
  Comparison comparison(before, after, learnt);
  for (int i = 0; i < kImpactBlocks; ++i)
    comparison.add(block_near(before.world, around, i));
  TypeChange derived;  // a derived mesh merges many models: it changes if one of them does
  derived.before = 1;
  (comparison.any_model_changes() || comparison.ground().fresh > 0 ? derived.fresh : derived.same) =
      1;
  WorldImpact impact;
  impact.budget_bytes = contents.budget_bytes;
  for (const HeldMeshes& held : contents.held) {
    if (held.kind == HeldMeshes::Kind::kModel) {
      const auto type = comparison.types().find(held.type);
      add_held(held, type != comparison.types().end() ? type->second : TypeChange{}, impact);
    } else {
      add_held(held, held.kind == HeldMeshes::Kind::kGround ? comparison.ground() : derived,
               impact);
    }
  }
  add_new(comparison, contents, impact);
  impact.seconds /= std::max(contents.modelers, 1U);
  impact.is_elsewhere = impact.changed < 0.5 && places_differ(before, after);
  return impact;
}

QString impact_text(const WorldImpact& impact) {
  if (impact.changed < 0.5 && impact.seconds <= 0) {
    return impact.is_elsewhere ? tr("Nothing near the camera needs rebuilding.")
                               : tr("Nothing to rebuild.");
  }
  return tr("Rebuilds about %1 of %2 meshes (%3). Memory afterwards: %4 of %5.")
      .arg(count_text(impact.changed), count_text(impact.held), seconds_text(impact.seconds),
           bytes_text(impact.bytes, 1), bytes_text(impact.budget_bytes, 0));
}

}  // namespace psygen::editor
