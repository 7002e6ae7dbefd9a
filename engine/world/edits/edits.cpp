#include "engine/world/edits/edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <set>
#include <utility>

#include "engine/world/edits/edit_checks.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water_shapes.hpp"

namespace psygen::world {
namespace {

using core::ErrorCode;
using models::BlockEdits;
using models::EditLayer;
using models::GroundEdit;
using models::PlacedModel;
using models::QuadCoord;
using models::RemovedModel;

// A position in a block as floats, which must not round up to the next block.
glm::vec2 within(const glm::dvec3& local_m, double block_m) {
  const float most = std::nextafter(static_cast<float>(block_m), 0.0F);
  return glm::min(glm::vec2(local_m.x, local_m.z), most);
}

// An edit of a disc of the ground.
GroundEdit disc(models::GroundChange change, const core::WorldPosition& at, double radius_m,
                double height_m) {
  GroundEdit edit;
  edit.change = change;
  edit.centre = at;
  edit.radius_m = radius_m;
  edit.height_m = height_m;
  return edit;
}

// Counts the origin of a piece of water, which may be null, in blocks of another size.
template <class Piece>
void rebase_piece(std::shared_ptr<const Piece>& piece, double from_m, double to_m) {
  if (!piece) return;
  auto moved = std::make_shared<Piece>(*piece);
  moved->origin = rebased(moved->origin, from_m, to_m);
  piece = std::move(moved);
}

// The same edits at the same places, for blocks of another size. Instances of the world's function
// are others there, so nothing is removed. Leaves out ground edits above kMaxTogether.
EditLayer resized(const EditLayer& layer, double block_m) {
  EditLayer next;
  next.next_id = layer.next_id;
  next.block_m = block_m;
  std::map<core::BlockCoord, BlockEdits> blocks;
  std::set<std::pair<core::BlockCoord, std::uint32_t>> used;  // blocks may have had equal ids
  const auto id_in = [&](core::BlockCoord block, std::uint32_t id) {
    return used.insert({block, id}).second ? id : next.next_id++;
  };
  const auto add = [&](const QuadCoord& at, const BlockEdits*, const BlockEdits* edits) {
    for (PlacedModel placed : edits->placed) {
      const core::WorldPosition place =
          rebased({at.corner(), {placed.local_m.x, 0, placed.local_m.y}}, layer.block_m, block_m);
      placed.id = id_in(place.block, placed.id);
      placed.local_m = within(place.local, block_m);
      blocks[place.block].placed.push_back(std::move(placed));
    }
    for (const auto& before : edits->ground) {
      GroundEdit edit = *before;
      edit.centre = rebased(edit.centre, layer.block_m, block_m);
      rebase_piece(edit.river, layer.block_m, block_m);
      rebase_piece(edit.lake, layer.block_m, block_m);
      edit.id = id_in(edit.centre.block, edit.id);
      seal(edit);
      blocks[edit.centre.block].ground.push_back(
          std::make_shared<const GroundEdit>(std::move(edit)));
    }
  };
  models::QuadMap<BlockEdits>::each_difference({}, layer.blocks, add);
  for (auto& [block, edits] : blocks) {
    std::ranges::sort(edits.placed, {}, &PlacedModel::id);
    std::ranges::sort(edits.ground, {}, [](const auto& edit) { return edit->id; });
    std::erase_if(edits.ground, [&](const auto& e) { return !next.ground.edits.add(e, block_m); });
    next.blocks.set(QuadCoord::of(block), std::move(edits));
  }
  return next;
}

}  // namespace

Edits fitted(const Edits& edits, const World& world, const models::Registry& registry,
             const EditLayer* fitting) {
  Edits resized = edits;
  resized.resize_blocks(world);
  if (resized.empty()) return resized;
  models::QuadMap<BlockEdits> blocks = resized.layer()->blocks;
  bool changed = false;
  const auto fit = [&](const QuadCoord& at, const BlockEdits*, const BlockEdits* of_block) {
    const auto type = [&](const PlacedModel& placed) { return type_of(placed, registry); };
    const auto is_same = [&](const PlacedModel& placed) {
      const auto model = type(placed);
      return model && registry[*model].identity() == placed.identity;
    };
    if (of_block == nullptr || std::ranges::all_of(of_block->placed, is_same)) return;
    BlockEdits here = *of_block;
    std::erase_if(here.placed, [&](const PlacedModel& placed) { return !type(placed); });
    for (PlacedModel& placed : here.placed)
      models::bind(placed, registry[*type(placed)]);
    blocks.set(at, std::move(here));
    changed = true;
  };
  const models::QuadMap<BlockEdits> none;
  models::QuadMap<BlockEdits>::each_difference(fitting != nullptr ? fitting->blocks : none,
                                               resized.layer()->blocks, fit);
  if (!changed) return resized;
  if (blocks.empty()) return {};
  EditLayer layer = *resized.layer();
  layer.blocks = std::move(blocks);
  return Edits(std::make_shared<const EditLayer>(std::move(layer)));
}

EditCounts Edits::counts() const {
  if (!layer_ || layer_->blocks.empty()) return {};
  const BlockEdits::Summary& all = layer_->blocks.root()->summary;
  return {all.removed, all.placed, all.ground};
}

core::Result<std::uint32_t> Edits::next_id() const {
  const std::uint32_t id = layer_ ? layer_->next_id : 1;
  if (id <= kMaxEditId) return id;
  return core::fail(ErrorCode::kOverBudget,
                    fmt::format("no ids are left: at most {} edits may be made", kMaxEditId));
}

void Edits::resize_blocks(const World& world) {
  const double block_m = world.block_size_m();
  if (layer_ && layer_->block_m != 0 && layer_->block_m != block_m)
    layer_ = std::make_shared<const EditLayer>(resized(*layer_, block_m));
}

EditLayer Edits::copy(const World& world) const {
  EditLayer layer = layer_ ? *layer_ : EditLayer{};
  layer.block_m = world.block_size_m();
  return layer;
}

BlockEdits Edits::edits_of(core::BlockCoord block) const {
  const BlockEdits* edits = layer_ ? layer_->block(block) : nullptr;
  return edits != nullptr ? *edits : BlockEdits{};
}

void Edits::commit(EditLayer layer, core::BlockCoord block, BlockEdits edits) {
  layer.blocks.set(QuadCoord::of(block), std::move(edits));
  layer_ = layer.blocks.empty() ? nullptr : std::make_shared<const EditLayer>(std::move(layer));
}

core::Result<void> Edits::remove(const World& world, const InstanceName& model) {
  if (auto ok = check_removed(world, model.block, model.index); !ok) return ok;
  resize_blocks(world);
  BlockEdits edits = edits_of(model.block);
  if (edits.is_removed(model.index)) return {};
  if (auto ok = check_room(edits, model.block); !ok) return ok;
  edits.removed.insert(
      std::ranges::upper_bound(edits.removed, model.index, {}, &RemovedModel::index),
      RemovedModel{model.index, 0, {}});
  commit(copy(world), model.block, std::move(edits));
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
  if (at == placements.end() || at->index != model.index ||
      edits_of(model.block).is_removed(model.index)) {
    return core::invalid_argument(
        fmt::format("model {} of {} does not exist", model.index, text_of(model.block)));
  }
  Edits moved = *this;
  moved.resize_blocks(world);
  auto placed = moved.place(world, registry, {at->model, at->parameters, to, 0});
  if (!placed) return placed;
  if (auto ok = moved.remove(world, model); !ok) return tl::unexpected(ok.error());
  BlockEdits edits = moved.edits_of(model.block);
  auto removed = std::ranges::lower_bound(edits.removed, model.index, {}, &RemovedModel::index);
  *removed = {model.index, placed->id, placed->block};
  commit(moved.copy(world), model.block, std::move(edits));
  return placed;
}

core::Result<void> Edits::restore(const InstanceName& model) {
  BlockEdits edits = edits_of(model.block);
  if (!edits.is_removed(model.index))
    return core::invalid_argument(
        fmt::format("model {} of {} was not removed", model.index, text_of(model.block)));
  const auto at = std::ranges::lower_bound(edits.removed, model.index, {}, &RemovedModel::index);
  const RemovedModel removed = *at;
  edits.removed.erase(at);
  commit(*layer_, model.block, std::move(edits));
  if (removed.moved_id != 0) (void)remove_placed({removed.moved_to, removed.moved_id});
  return {};
}

core::Result<EditName> Edits::place(const World& world, const models::Registry& registry,
                                    const NewModel& model) {
  const auto at = check_place(world, model.at);
  if (!at) return tl::unexpected(at.error());
  if (auto ok = check_model(registry, model.model, model.parameters, model.above_m); !ok)
    return tl::unexpected(ok.error());
  resize_blocks(world);
  const auto id = next_id();
  if (!id) return tl::unexpected(id.error());
  EditLayer layer = copy(world);
  BlockEdits edits = edits_of(at->block);
  if (auto ok = check_room(edits, at->block); !ok) return tl::unexpected(ok.error());
  PlacedModel placed{.id = *id,
                     .local_m = within(at->local, world.block_size_m()),
                     .above_m = static_cast<float>(model.above_m),
                     .parameters = model.parameters};
  placed.parameters.set_edits(nullptr, 0);
  models::bind(placed, registry[model.model]);
  edits.placed.push_back(std::move(placed));  // ids only grow
  layer.next_id = *id + 1;
  commit(std::move(layer), at->block, std::move(edits));
  return EditName{at->block, *id};
}

core::Result<void> Edits::remove_placed(const EditName& model) {
  BlockEdits edits = edits_of(model.block);
  if (std::erase_if(edits.placed, [&](const PlacedModel& p) { return p.id == model.id; }) == 0) {
    return core::invalid_argument(
        fmt::format("{} has no placed model with the id {}", text_of(model.block), model.id));
  }
  commit(*layer_, model.block, std::move(edits));
  return {};
}

core::Result<EditName> Edits::edit_ground(const World& world, GroundEdit edit) {
  const auto at = check_place(world, edit.centre);
  if (!at) return tl::unexpected(at.error());
  if (is_water(edit.change))
    return core::invalid_argument("rivers and lakes are added by add_river() and add_lake()");
  if (auto ok = check_ground(world, edit); !ok) return tl::unexpected(ok.error());
  edit.turn = {1, 0};
  edit.road.reset();
  edit.river.reset();
  edit.lake.reset();
  if (is_stamp(edit.change)) {
    edit.square = true;
  } else {
    edit.map.reset();
  }
  resize_blocks(world);
  const auto id = next_id();
  if (!id) return tl::unexpected(id.error());
  EditLayer layer = copy(world);
  BlockEdits edits = edits_of(at->block);
  if (auto ok = check_room(edits, at->block); !ok) return tl::unexpected(ok.error());
  edit.centre = *at;
  edit.id = *id;
  seal(edit);
  const auto shared = std::make_shared<const GroundEdit>(std::move(edit));
  edits.ground.push_back(shared);
  if (auto ok = check_heights(edits, at->block); !ok) return tl::unexpected(ok.error());
  if (!layer.ground.edits.add(shared, world.block_size_m())) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("at most {} ground edits may overlap in one place ({}); a "
                                  "heightmap can replace many of them",
                                  models::GroundEdits::kMaxTogether, text_of(at->block)));
  }
  layer.next_id = *id + 1;
  commit(std::move(layer), at->block, std::move(edits));
  return EditName{at->block, *id};
}

core::Result<EditName> Edits::raise(const World& world, const core::WorldPosition& at,
                                    double radius_m, double height_m) {
  return edit_ground(world, disc(models::GroundChange::kRaise, at, radius_m, height_m));
}

core::Result<EditName> Edits::flatten(const World& world, const core::WorldPosition& at,
                                      double radius_m, double height_m) {
  return edit_ground(world, disc(models::GroundChange::kFlatten, at, radius_m, height_m));
}

template <class Make>
core::Result<AddedWater> Edits::add_water(const World& world, std::string_view type,
                                          const Make& make) {
  resize_blocks(world);
  const auto first = next_id();
  if (!first) return tl::unexpected(first.error());
  EditLayer layer = copy(world);
  if (world.shaped.layer) layer.ground.take_function_of(world.shaped.layer->ground);
  const AddedWater added{kFirstAdded | *first, {}};
  auto made = make(layer, BodyName{added.body, fmt::format("the {}", type), false});
  if (!made)
    return core::fail(made.error().error.code,
                      fmt::format("the {} is not allowed: {}: {}", type, made.error().key,
                                  made.error().error.message));
  if (*first + made->edits.size() > kMaxEditId)
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("no ids are left: at most {} edits may be made", kMaxEditId));
  std::map<core::BlockCoord, BlockEdits> changed;
  layer.next_id = *first;
  for (GroundEdit& edit : made->edits) {
    const core::BlockCoord block = edit.centre.block;
    BlockEdits& here = changed.try_emplace(block, edits_of(block)).first->second;
    if (auto ok = check_room(here, block); !ok) return tl::unexpected(ok.error());
    edit.id = layer.next_id++;
    seal(edit);
    here.ground.push_back(std::make_shared<const GroundEdit>(std::move(edit)));
    if (!layer.ground.edits.add(here.ground.back(), world.block_size_m()))
      return core::fail(ErrorCode::kOverBudget,
                        fmt::format("too many ground edits overlap at {}", text_of(block)));
  }
  for (auto& [block, edits] : changed)
    layer.blocks.set(QuadCoord::of(block), std::move(edits));
  layer_ = std::make_shared<const EditLayer>(std::move(layer));
  return AddedWater{added.body, std::move(made->warnings)};
}

core::Result<AddedWater> Edits::add_river(const World& world, const River& river) {
  if (!river.enabled) return core::invalid_argument("the river is not enabled");
  return add_water(world, "river", [&](const EditLayer& below, const BodyName& name) {
    return river_edits(world, below, river, name);
  });
}

core::Result<AddedWater> Edits::add_lake(const World& world, const Lake& lake) {
  if (!lake.enabled) return core::invalid_argument("the lake is not enabled");
  return add_water(world, "lake", [&](const EditLayer& below, const BodyName& name) {
    return lake_edits(world, below, lake, name);
  });
}

core::Result<void> Edits::remove_water(const World& world, WaterBody body) {
  resize_blocks(world);
  const auto belongs = [&](const std::shared_ptr<const GroundEdit>& edit) {
    return (edit->river && edit->river->body == body) || (edit->lake && edit->lake->body == body);
  };
  EditLayer layer = copy(world);
  std::vector<std::pair<QuadCoord, BlockEdits>> changed;
  models::QuadMap<BlockEdits>::each_difference(
      {}, layer.blocks, [&](const QuadCoord& at, const BlockEdits*, const BlockEdits* of_block) {
        if (std::ranges::any_of(of_block->ground, belongs)) changed.emplace_back(at, *of_block);
      });
  if (changed.empty())
    return core::invalid_argument(fmt::format("no river or lake {} was added", body));
  for (auto& [at, edits] : changed) {
    for (const auto& edit : edits.ground)
      if (belongs(edit)) layer.ground.edits.remove(*edit, world.block_size_m());
    std::erase_if(edits.ground, belongs);
    layer.blocks.set(at, std::move(edits));
  }
  layer_ = layer.blocks.empty() ? nullptr : std::make_shared<const EditLayer>(std::move(layer));
  return {};
}

core::Result<void> Edits::remove_ground(const World& world, const EditName& edit) {
  resize_blocks(world);
  BlockEdits edits = edits_of(edit.block);
  const auto at = std::ranges::find(edits.ground, edit.id, &GroundEdit::id);
  if (at == edits.ground.end()) {
    return core::invalid_argument(
        fmt::format("{} has no ground edit with the id {}", text_of(edit.block), edit.id));
  }
  EditLayer layer = copy(world);
  layer.ground.edits.remove(**at, world.block_size_m());
  edits.ground.erase(at);
  commit(std::move(layer), edit.block, std::move(edits));
  return {};
}

core::Result<void> Edits::replace_block(const World& world, core::BlockCoord block,
                                        BlockEdits edits) {
  if (auto ok = check_block(world, block); !ok) return ok;
  if (auto ok = check_heights(edits, block); !ok) return ok;
  resize_blocks(world);
  EditLayer layer = copy(world);
  const double block_m = world.block_size_m();
  if (const BlockEdits* before = layer.block(block)) {
    for (const auto& edit : before->ground)
      layer.ground.edits.remove(*edit, block_m);
  }
  for (const auto& edit : edits.ground) {
    if (!layer.ground.edits.add(edit, block_m)) {
      return core::fail(ErrorCode::kOverBudget,
                        fmt::format("too many ground edits overlap at {}", text_of(block)));
    }
    layer.next_id = std::max(layer.next_id, edit->id + 1);
  }
  for (const PlacedModel& placed : edits.placed)
    layer.next_id = std::max(layer.next_id, placed.id + 1);
  for (const RemovedModel& removed : edits.removed)  // its block may come later, or never
    layer.next_id = std::max(layer.next_id, removed.moved_id + 1);
  commit(std::move(layer), block, std::move(edits));
  return {};
}

std::vector<EditName> hidden_models(const Edits& edits, const models::Registry& registry) {
  std::vector<EditName> hidden;
  if (edits.empty()) return hidden;
  models::QuadMap<BlockEdits>::each_difference(
      {}, edits.layer()->blocks,
      [&](const QuadCoord& at, const BlockEdits*, const BlockEdits* of_block) {
        for (const PlacedModel& placed : of_block->placed) {
          if (!type_of(placed, registry)) hidden.push_back({at.corner(), placed.id});
        }
      });
  return hidden;
}

std::vector<core::BlockCoord> changed_blocks(const Edits& before, const Edits& after) {
  const EditLayer none;
  const EditLayer& a = before.layer() ? *before.layer() : none;
  const EditLayer& b = after.layer() ? *after.layer() : none;
  std::vector<core::BlockCoord> blocks;
  models::QuadMap<BlockEdits>::each_difference(
      a.blocks, b.blocks, [&](const QuadCoord& at, const BlockEdits*, const BlockEdits*) {
        blocks.push_back(at.corner());
      });
  return blocks;
}

}  // namespace psygen::world
