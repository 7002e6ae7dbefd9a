#include "engine/world/edits/edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

using core::ErrorCode;
using models::BlockEdits;
using models::EditLayer;
using models::GroundEdit;
using models::PlacedModel;
using models::QuadPlace;
using models::RemovedModel;

tl::unexpected<core::Error> refuse(std::string sentence) {
  return core::fail(ErrorCode::kInvalidArgument, std::move(sentence));
}

std::string text_of(core::BlockCoord block) {
  return fmt::format("block ({}, {})", block.x, block.z);
}

core::Result<void> check_block(const World& world, core::BlockCoord block) {
  if (world.contains(block)) return {};
  return refuse(fmt::format("{} is outside of the world", text_of(block)));
}

std::size_t heights_in(const GroundEdit& edit) {
  return edit.map ? edit.map->heights_m.size() : 0;
}

core::Result<void> check_heights(const BlockEdits& edits, core::BlockCoord block) {
  std::size_t count = 0;
  for (const auto& edit : edits.ground)
    count += heights_in(*edit);
  if (count <= kMaxHeightsPerBlock) return {};
  return core::fail(ErrorCode::kOverBudget,
                    fmt::format("the heightmaps of {} have {} heights, and at most {} are allowed",
                                text_of(block), count, kMaxHeightsPerBlock));
}

core::Result<void> check_room(const BlockEdits& edits, core::BlockCoord block) {
  const std::size_t count = edits.removed.size() + edits.placed.size() + edits.ground.size();
  if (count < kMaxEditsPerBlock) return {};
  return core::fail(ErrorCode::kOverBudget, fmt::format("{} has {} edits, and no more are allowed",
                                                        text_of(block), kMaxEditsPerBlock));
}

// Legal, and on its block.
core::Result<void> check_removed(const World& world, core::BlockCoord block, std::uint32_t index) {
  if (auto ok = check_block(world, block); !ok) return ok;
  const std::size_t count = models_per_block(world);
  if (index < count) return {};
  return refuse(
      fmt::format("{} has no model {}: there are {} a block", text_of(block), index, count));
}

// A coordinate in a block as a float, which must not round up to the next block.
float within(double local_m, const World& world) {
  const auto size_m = static_cast<float>(world.block_size_m());
  return std::min(static_cast<float>(local_m), std::nextafter(size_m, 0.0F));
}

core::Result<void> check_heightmap(const models::Heightmap* map, double relief_m, bool adds) {
  if (map == nullptr) return refuse("the stamp has no heightmap");
  const auto side = [](std::uint32_t n) { return n >= 2 && n <= kMaxHeightmapSide; };
  if (!side(map->columns) || !side(map->rows)) {
    return refuse(fmt::format("a heightmap of {} × {} points is not allowed: each side has 2 to {}",
                              map->columns, map->rows, kMaxHeightmapSide));
  }
  const std::size_t points = std::size_t{map->columns} * map->rows;
  if (map->heights_m.size() != points) {
    return refuse(fmt::format("the heightmap has {} heights, not {} × {}", map->heights_m.size(),
                              map->columns, map->rows));
  }
  const double lowest = adds ? -relief_m : 0;
  for (const float h : map->heights_m) {
    if (static_cast<double>(h) >= lowest && static_cast<double>(h) <= relief_m) continue;
    return refuse(
        fmt::format("a height of {:g} m in the heightmap is not allowed: it must be {:g} to {:g} m",
                    h, lowest, relief_m));
  }
  return {};
}

}  // namespace

core::Result<core::WorldPosition> check_place(const World& world, const core::WorldPosition& at) {
  constexpr double kFarthest = 1e9;
  const auto usable = [](double v) { return std::abs(v) <= kFarthest; };  // false for NaN
  if (!usable(at.local.x) || !usable(at.local.z)) {
    return refuse(fmt::format("the place {:g}, {:g} m from {} is not a place in the world",
                              at.local.x, at.local.z, text_of(at.block)));
  }
  const double size = world.block_size_m();
  const auto index = [size](std::int32_t block, double local) {
    return static_cast<double>(block) + std::floor(local / size);
  };
  const auto fits = [](double i) { return i >= INT32_MIN && i <= INT32_MAX; };
  core::WorldPosition place = core::normalised(at, size);
  const bool inside = fits(index(at.block.x, at.local.x)) && fits(index(at.block.z, at.local.z));
  if (!inside || !world.contains(place.block)) {
    return refuse(fmt::format("the place {:g}, {:g} m from {} is outside of the world", at.local.x,
                              at.local.z, text_of(at.block)));
  }
  place.local.y = 0;
  return place;
}

core::Result<void> check_ground(const World& world, const GroundEdit& edit) {
  const double relief_m = world.terrain.real(models::kTerrainReliefM);
  if (!(edit.radius_m >= kMinEditRadiusM && edit.radius_m <= kMaxEditRadiusM)) {
    return refuse(fmt::format("a radius of {:g} m is not allowed: it must be {:g} to {:g} m",
                              edit.radius_m, kMinEditRadiusM, kMaxEditRadiusM));
  }
  if (!(edit.falloff >= 0 && edit.falloff <= 1))
    return refuse(fmt::format("a falloff of {:g} is not allowed: it must be 0 to 1", edit.falloff));
  switch (edit.change) {
    case models::GroundChange::kRaise:
      if (std::abs(edit.height_m) <= relief_m) return {};
      return refuse(
          fmt::format("raising ground by {:g} m is not allowed: at most {:g} m, up or down",
                      edit.height_m, relief_m));
    case models::GroundChange::kFlatten:
      if (edit.height_m >= 0 && edit.height_m <= relief_m) return {};
      return refuse(fmt::format(
          "ground at {:g} m is not allowed: it must be 0 to {:g} m, the relief of the terrain",
          edit.height_m, relief_m));
    case models::GroundChange::kStampAdd:
      return check_heightmap(edit.map.get(), relief_m, true);
    case models::GroundChange::kStampSet:
      return check_heightmap(edit.map.get(), relief_m, false);
  }
  return refuse("there is no such change of the ground");
}

core::Result<void> check_model(const models::Registry& registry, models::ModelIndex model,
                               const models::Parameters& parameters, double above_m) {
  if (model >= registry.size())
    return refuse(fmt::format("there is no model type {}: there are {}", model, registry.size()));
  constexpr double kHighest = 1000;
  if (!(std::abs(above_m) <= kHighest)) {
    return refuse(fmt::format("{:g} m above the ground is not allowed: it must be {:g} to {:g} m",
                              above_m, -kHighest, kHighest));
  }
  const models::ModelType& type = registry[model];
  if (auto ok = models::validate(type, parameters); !ok) return ok;
  if (type.mesh_size(parameters, 0).layout != core::VertexLayout::kModel)
    return refuse(fmt::format("{} is not a model that can be placed", type.name()));
  return {};
}

glm::vec3 placed_reach(const models::ModelType& type, const models::Parameters& parameters,
                       double above_m) {
  const core::Bounds box = type.bounds(parameters);
  const auto above = static_cast<float>(above_m);
  return {std::max({-box.min.x, -box.min.z, box.max.x, box.max.z, 0.0F}),
          std::max(box.max.y + above, 0.0F), std::max(-box.min.y - above, 0.0F)};
}

EditCounts Edits::counts() const {
  if (!layer_ || layer_->blocks.empty()) return {};
  const BlockEdits::Summary& all = layer_->blocks.root()->summary;
  return {all.removed, all.placed, all.ground};
}

std::uint64_t Edits::hash() const {
  return layer_ && !layer_->blocks.empty() ? layer_->blocks.root()->hash : 0;
}

core::Result<std::uint32_t> Edits::next_id() const {
  const std::uint32_t id = layer_ ? layer_->next_id : 1;
  if (id <= kMaxEditId) return id;
  return core::fail(ErrorCode::kOverBudget,
                    fmt::format("there were {} edits, and no more are allowed", kMaxEditId));
}

const BlockEdits* Edits::block(core::BlockCoord at) const {
  return layer_ ? layer_->block(at) : nullptr;
}

void Edits::commit(EditLayer layer) {
  layer_ = layer.blocks.empty() ? nullptr : std::make_shared<const EditLayer>(std::move(layer));
}

core::Result<void> Edits::remove(const World& world, const InstanceName& model) {
  if (auto ok = check_removed(world, model.block, model.index); !ok) return ok;
  const BlockEdits* before = block(model.block);
  if (before != nullptr && before->is_removed(model.index)) return {};
  BlockEdits edits = before != nullptr ? *before : BlockEdits{};
  if (auto ok = check_room(edits, model.block); !ok) return ok;
  edits.removed.insert(
      std::ranges::upper_bound(edits.removed, model.index, {}, &RemovedModel::index),
      RemovedModel{model.index, 0, {}});
  EditLayer layer = layer_ ? *layer_ : EditLayer{};
  layer.blocks.set(QuadPlace::of(model.block), std::move(edits));
  commit(std::move(layer));
  return {};
}

core::Result<EditName> Edits::move(const World& world, const models::Registry& registry,
                                   const InstanceName& model, const core::WorldPosition& to) {
  if (auto ok = check_removed(world, model.block, model.index); !ok)
    return tl::unexpected(ok.error());
  World function = world;  // the model as the function has it
  set_edits(function, nullptr);
  std::vector<Placement> placements;
  place_models(function, registry, model.block, placements);
  const auto at = std::ranges::lower_bound(placements, model.index, {}, &Placement::index);
  const BlockEdits* before = block(model.block);
  if (at == placements.end() || at->index != model.index ||
      (before != nullptr && before->is_removed(model.index))) {
    return refuse(fmt::format("model {} of {} is not there", model.index, text_of(model.block)));
  }
  Edits moved = *this;
  auto placed = moved.place(world, registry, {at->model, at->parameters, to, 0});
  if (!placed) return placed;
  if (auto ok = moved.remove(world, model); !ok) return tl::unexpected(ok.error());
  EditLayer layer = *moved.layer_;
  BlockEdits edits = *layer.block(model.block);
  auto removed = std::ranges::lower_bound(edits.removed, model.index, {}, &RemovedModel::index);
  *removed = {model.index, placed->id, placed->block};
  layer.blocks.set(QuadPlace::of(model.block), std::move(edits));
  commit(std::move(layer));
  return placed;
}

core::Result<void> Edits::restore(const InstanceName& model) {
  const BlockEdits* before = block(model.block);
  if (before == nullptr || !before->is_removed(model.index))
    return refuse(fmt::format("model {} of {} was not removed", model.index, text_of(model.block)));
  EditLayer layer = *layer_;
  BlockEdits edits = *before;
  const auto at = std::ranges::lower_bound(edits.removed, model.index, {}, &RemovedModel::index);
  const RemovedModel removed = *at;
  edits.removed.erase(at);
  layer.blocks.set(QuadPlace::of(model.block), std::move(edits));
  commit(std::move(layer));
  if (removed.moved_id != 0) (void)remove_placed({removed.moved_to, removed.moved_id});
  return {};
}

core::Result<EditName> Edits::place(const World& world, const models::Registry& registry,
                                    const NewModel& model) {
  const auto at = check_place(world, model.at);
  if (!at) return tl::unexpected(at.error());
  if (auto ok = check_model(registry, model.model, model.parameters, model.above_m); !ok)
    return tl::unexpected(ok.error());
  const auto id = next_id();
  if (!id) return tl::unexpected(id.error());
  EditLayer layer = layer_ ? *layer_ : EditLayer{};
  const BlockEdits* before = layer.block(at->block);
  BlockEdits edits = before != nullptr ? *before : BlockEdits{};
  if (auto ok = check_room(edits, at->block); !ok) return tl::unexpected(ok.error());
  PlacedModel placed{*id,
                     model.model,
                     {within(at->local.x, world), within(at->local.z, world)},
                     static_cast<float>(model.above_m),
                     placed_reach(registry[model.model], model.parameters, model.above_m),
                     model.parameters};
  placed.parameters.set_edits(nullptr, 0);
  edits.placed.push_back(std::move(placed));  // ids only grow
  layer.next_id = *id + 1;
  layer.blocks.set(QuadPlace::of(at->block), std::move(edits));
  commit(std::move(layer));
  return EditName{at->block, *id};
}

core::Result<void> Edits::remove_placed(const EditName& model) {
  const BlockEdits* before = block(model.block);
  BlockEdits edits = before != nullptr ? *before : BlockEdits{};
  if (std::erase_if(edits.placed, [&](const PlacedModel& p) { return p.id == model.id; }) == 0) {
    return refuse(
        fmt::format("{} has no placed model of the id {}", text_of(model.block), model.id));
  }
  EditLayer layer = *layer_;
  layer.blocks.set(QuadPlace::of(model.block), std::move(edits));
  commit(std::move(layer));
  return {};
}

core::Result<EditName> Edits::edit_ground(const World& world, GroundEdit edit) {
  const auto at = check_place(world, edit.centre);
  if (!at) return tl::unexpected(at.error());
  if (auto ok = check_ground(world, edit); !ok) return tl::unexpected(ok.error());
  const auto id = next_id();
  if (!id) return tl::unexpected(id.error());
  EditLayer layer = layer_ ? *layer_ : EditLayer{};
  const BlockEdits* before = layer.block(at->block);
  BlockEdits edits = before != nullptr ? *before : BlockEdits{};
  if (auto ok = check_room(edits, at->block); !ok) return tl::unexpected(ok.error());
  edit.centre = *at;
  edit.id = *id;
  edit.content = content_hash(edit);
  const auto shared = std::make_shared<const GroundEdit>(std::move(edit));
  edits.ground.push_back(shared);
  if (auto ok = check_heights(edits, at->block); !ok) return tl::unexpected(ok.error());
  if (!layer.ground.add(shared, world.block_size_m())) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("{} edits of the ground lie on top of each other at {}, and no "
                                  "more are allowed; a heightmap can replace many of them",
                                  models::GroundEdits::kMostTogether, text_of(at->block)));
  }
  layer.next_id = *id + 1;
  layer.blocks.set(QuadPlace::of(at->block), std::move(edits));
  commit(std::move(layer));
  return EditName{at->block, *id};
}

core::Result<EditName> Edits::raise(const World& world, const core::WorldPosition& at,
                                    double radius_m, double height_m) {
  GroundEdit edit;
  edit.change = models::GroundChange::kRaise;
  edit.centre = at;
  edit.radius_m = radius_m;
  edit.height_m = height_m;
  return edit_ground(world, std::move(edit));
}

core::Result<EditName> Edits::flatten(const World& world, const core::WorldPosition& at,
                                      double radius_m, double height_m) {
  GroundEdit edit;
  edit.change = models::GroundChange::kFlatten;
  edit.centre = at;
  edit.radius_m = radius_m;
  edit.height_m = height_m;
  return edit_ground(world, std::move(edit));
}

core::Result<void> Edits::remove_ground(const World& world, const EditName& edit) {
  const BlockEdits* before = block(edit.block);
  BlockEdits edits = before != nullptr ? *before : BlockEdits{};
  const auto at = std::ranges::find(edits.ground, edit.id, &GroundEdit::id);
  if (at == edits.ground.end()) {
    return refuse(
        fmt::format("{} has no edit of the ground of the id {}", text_of(edit.block), edit.id));
  }
  EditLayer layer = *layer_;
  layer.ground.remove(**at, world.block_size_m());
  edits.ground.erase(at);
  layer.blocks.set(QuadPlace::of(edit.block), std::move(edits));
  commit(std::move(layer));
  return {};
}

core::Result<void> Edits::replace_block(const World& world, core::BlockCoord block,
                                        BlockEdits edits) {
  if (auto ok = check_block(world, block); !ok) return ok;
  if (auto ok = check_heights(edits, block); !ok) return ok;
  EditLayer layer = layer_ ? *layer_ : EditLayer{};
  const double block_m = world.block_size_m();
  if (const BlockEdits* before = layer.block(block)) {
    for (const auto& edit : before->ground)
      layer.ground.remove(*edit, block_m);
  }
  for (const auto& edit : edits.ground) {
    if (!layer.ground.add(edit, block_m)) {
      return core::fail(ErrorCode::kOverBudget,
                        fmt::format("too many edits of the ground lie on top of each other at {}",
                                    text_of(block)));
    }
    layer.next_id = std::max(layer.next_id, edit->id + 1);
  }
  for (const PlacedModel& placed : edits.placed)
    layer.next_id = std::max(layer.next_id, placed.id + 1);
  layer.blocks.set(QuadPlace::of(block), std::move(edits));
  commit(std::move(layer));
  return {};
}

std::vector<core::BlockCoord> changed_blocks(const Edits& before, const Edits& after) {
  const EditLayer none;
  const EditLayer& a = before.layer() ? *before.layer() : none;
  const EditLayer& b = after.layer() ? *after.layer() : none;
  std::vector<core::BlockCoord> blocks;
  models::QuadMap<BlockEdits>::each_difference(
      a.blocks, b.blocks, [&](const QuadPlace& at, const BlockEdits*, const BlockEdits*) {
        blocks.push_back(at.corner());
      });
  return blocks;
}

}  // namespace psygen::world
