#include "engine/save/adaptation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "engine/core/hash.hpp"
#include "engine/core/rounding.hpp"
#include "engine/core/utf8.hpp"
#include "engine/models/edits.hpp"
#include "engine/world/edits/edit_bytes.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"

namespace psygen::save {
namespace {

using DecodedEdits = models::BlockEdits;
using world::EditKind;

// The edits of a block as the file has them.
struct Stored {
  core::BlockCoord block;
  std::uint32_t version = 0;
  std::span<const std::byte> bytes;
};

std::size_t count_of(const DecodedEdits& edits) {
  return edits.removed.size() + edits.placed.size() + edits.ground.size();
}

std::size_t heights_of(const DecodedEdits& edits) {
  std::size_t count = 0;
  for (const auto& edit : edits.ground)
    count += edit->map ? edit->map->heights_m.size() : 0;
  return count;
}

// Moves the elements that satisfy `is_unfit` to the end of another list, in their order.
template <class T, class Test>
void take(std::vector<T>& from, std::vector<T>& to, const Test& is_unfit) {
  const auto unfit = std::stable_partition(from.begin(), from.end(),
                                           [&](const T& edit) { return !is_unfit(edit); });
  std::move(unfit, from.end(), std::back_inserter(to));
  from.erase(unfit, from.end());
}

// Adds edits that fit again to those of their block, with new ids where theirs are taken. Returns
// false, and changes nothing, if they are too many for one block.
bool merge(DecodedEdits& into, DecodedEdits back) {
  if (count_of(into) + count_of(back) > world::kMaxEditsPerBlock ||
      heights_of(into) + heights_of(back) > world::kMaxHeightsPerBlock)
    return false;
  std::set<std::uint32_t> taken;
  const auto note = [&](const DecodedEdits& edits) {
    for (const auto& placed : edits.placed)
      taken.insert(placed.id);
    for (const auto& ground : edits.ground)
      taken.insert(ground->id);
  };
  note(into);
  const auto free_id = [&](std::uint32_t id) {
    if (!taken.contains(id)) return id;
    return *taken.rbegin() + 1;
  };
  for (const models::RemovedModel& removed : back.removed) {
    const auto at =
        std::ranges::lower_bound(into.removed, removed.index, {}, &models::RemovedModel::index);
    if (!into.is_removed(removed.index)) into.removed.insert(at, removed);
  }
  for (models::PlacedModel& placed : back.placed) {
    placed.id = free_id(placed.id);
    taken.insert(placed.id);
    into.placed.push_back(std::move(placed));
  }
  for (const auto& ground : back.ground) {
    models::GroundEdit edit = *ground;
    edit.id = free_id(edit.id);
    taken.insert(edit.id);
    into.ground.push_back(std::make_shared<const models::GroundEdit>(std::move(edit)));
  }
  std::ranges::sort(into.placed, {}, &models::PlacedModel::id);
  std::ranges::sort(into.ground, {}, [](const auto& edit) { return edit->id; });
  return taken.empty() || *taken.rbegin() <= world::kMaxEditId;
}

// Compares edits that were made in one world with another.
class Judge {
 public:
  Judge(const WorldIdentity& before, const CurrentWorld& now)
      : before_(before),
        now_(now),
        changes_(changes_between(before, now.identity)),
        touched_(changes_.size()),
        earlier_(scatter_spans(before)),
        later_(scatter_spans(now.identity)) {}

  // Counts the edits of a block that changes touch; null: edits that this program cannot read.
  void count_touched(core::BlockCoord block, const DecodedEdits* edits,
                     std::optional<std::uint64_t> surface) {
    const bool inside = now_.world && now_.world->contains(block);
    const auto is_ground = [](const PartChange& change) {
      return change.kind == PartKind::kGround || change.kind == PartKind::kWater;
    };
    const BlockState state{edits, inside,
                           std::ranges::any_of(changes_, is_ground) &&
                               !(inside && surface && *surface == surface_hash(*now_.world, block)),
                           touched_removals(edits)};
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      const std::uint64_t count = touched_by(i, state);
      if (count == 0) continue;
      if (touched_[i].edits == 0) touched_[i].block = block;
      touched_[i].edits += count;
    }
  }

  // The changes that touch edits, as the error of open().
  core::Result<void> accepted(Accept accept, const std::filesystem::path& file) const {
    const WorldIdentity& now = now_.identity;
    if (before_.parts.empty() || now.parts.empty()) {
      if (accept != Accept::kSameWorld) return {};
      const std::string_view why =
          now.parts.empty() ? "" : "; saves of its format do not tell which parts differ";
      return core::fail(
          core::ErrorCode::kInvalidArgument,
          fmt::format(
              "{}: belongs to the world '{}' with hash {:016x}, not to '{}' with hash {:016x}{}",
              file.string(), core::shown(before_.name, 80), before_.hash, core::shown(now.name, 80),
              now.hash, why));
    }
    std::string list;
    bool other_world = false;
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      const PartChange& change = changes_[i];
      const bool moves_all = change.kind == PartKind::kSeed || change.kind == PartKind::kBlockSize;
      other_world = other_world || change.kind == PartKind::kSeed;
      if (touched_[i].edits == 0 && !moves_all) continue;
      if (list.size() > kMaxListBytes) {
        list += "; and more";
        break;
      }
      list += fmt::format("{}{}", list.empty() ? "" : "; ", change.text);
      if (touched_[i].edits > 0)
        list += fmt::format(" under {} edit{}, such as in block ({}, {})", touched_[i].edits,
                            touched_[i].edits == 1 ? "" : "s", touched_[i].block.x,
                            touched_[i].block.z);
    }
    const bool allowed =
        accept == Accept::kAnyWorld || (accept == Accept::kChangedWorld && !other_world);
    if (list.empty() || allowed) return {};
    return core::fail(
        core::ErrorCode::kInvalidArgument,
        fmt::format("{}: the world '{}' has changed since it was saved: {}. Open it with the world "
                    "of that time, or accept the change: edits that no longer fit are then kept "
                    "aside and listed",
                    file.string(), core::shown(before_.name, 80), list));
  }

  // Separates the edits that do not fit into the current world, which must be known, and lists
  // them.
  DecodedEdits take_unfit(core::BlockCoord block, DecodedEdits& edits,
                          std::vector<Misfit>& list) const {
    DecodedEdits unfit;
    const world::World& world = *now_.world;
    if (const PartChange* size = find(PartKind::kBlockSize)) {
      note_all(block, edits, size->text, list);
      return std::exchange(edits, {});
    }
    if (!world.contains(block)) {
      note_all(block, edits, "the block is outside the world", list);
      return std::exchange(edits, {});
    }
    std::map<std::pair<std::optional<EditKind>, std::string>, std::uint32_t> reasons;
    take(edits.removed, unfit.removed, [&](const models::RemovedModel& removed) {
      const PartChange* change = find(PartKind::kSeed);
      if (change == nullptr) change = change_of_instance(removed.index);
      if (change != nullptr) ++reasons[{EditKind::kRemoved, change->text}];
      return change != nullptr;
    });
    std::set<std::pair<EditKind, std::uint32_t>> taken;
    for (world::UnfitEdit& edit : world::unfit_edits(edits, world, *now_.registry, block)) {
      ++reasons[{edit.kind, std::move(edit.reason)}];
      if (!edit.hidden) taken.emplace(edit.kind, edit.id);
    }
    take(edits.removed, unfit.removed, [&](const auto& edit) {
      return taken.contains({EditKind::kRemoved, edit.index});
    });
    take(edits.placed, unfit.placed, [&](const auto& edit) {
      return taken.contains({EditKind::kPlaced, edit.id});
    });
    take(edits.ground, unfit.ground, [&](const auto& edit) {
      return taken.contains({EditKind::kGround, edit->id});
    });
    std::ranges::sort(unfit.removed, {}, &models::RemovedModel::index);
    for (const auto& [key, count] : reasons)
      list.push_back({block, key.first, count, key.second});
    return unfit;
  }

 private:
  static constexpr std::size_t kMaxListBytes = 400;
  struct Touched {
    std::uint64_t edits = 0;
    core::BlockCoord block;  // the first one
  };

  const PartChange* find(PartKind kind, std::size_t part = SIZE_MAX) const {
    const auto is_it = [&](const PartChange& change) {
      return change.kind == kind && !change.is_new && (part == SIZE_MAX || change.part == part);
    };
    const auto found = std::ranges::find_if(changes_, is_it);
    return found == changes_.end() ? nullptr : &*found;
  }

  // The change because of which an instance of the world's function is another one now, or null.
  const PartChange* change_of_instance(std::uint32_t index) const {
    const auto has = [&](const ScatterSpan& span) {
      return index >= span.first && index < span.first + span.count;
    };
    const auto span = std::ranges::find_if(earlier_, has);
    if (span == earlier_.end()) return nullptr;
    const WorldPart& part = before_.parts[span->part];
    const bool stays = std::ranges::any_of(later_, [&](const ScatterSpan& now) {
      const WorldPart& candidate = now_.identity.parts[now.part];
      return now.first == span->first && has(now) && candidate.name == part.name &&
             candidate.hash == part.hash;
    });
    return stays ? nullptr : find(PartKind::kScatter, span->part);
  }

  // A block whose edits are judged.
  struct BlockState {
    const DecodedEdits* edits;  // null: unreadable
    bool inside;                // the current world
    bool has_other_surface;
    std::vector<std::uint64_t> removals;  // that each change touches
  };

  // Counts the removed models that each change touches.
  std::vector<std::uint64_t> touched_removals(const DecodedEdits* edits) const {
    std::vector<std::uint64_t> counts(changes_.size(), 0);
    if (edits == nullptr) return counts;
    for (const models::RemovedModel& removed : edits->removed)
      if (const PartChange* change = change_of_instance(removed.index))
        ++counts[static_cast<std::size_t>(change - changes_.data())];
    return counts;
  }

  // The number of edits of a block that depend on a changed part.
  std::uint64_t touched_by(std::size_t index, const BlockState& state) const {
    const PartChange& change = changes_[index];
    const DecodedEdits* const edits = state.edits;
    const std::uint64_t all = edits != nullptr ? count_of(*edits) : 1;
    switch (change.kind) {
      case PartKind::kSeed:
      case PartKind::kBlockSize:
        return all;
      case PartKind::kExtent:
        return state.inside ? 0 : all;
      case PartKind::kGround:
      case PartKind::kWater:
        return state.has_other_surface ? all : 0;
      case PartKind::kScatter:
        if (change.is_new || edits == nullptr) return change.is_new ? 0 : all;
        return state.removals[index];
      case PartKind::kSpecies:
      case PartKind::kModel:
        if (change.is_new || edits == nullptr) return change.is_new ? 0 : all;
        return static_cast<std::uint64_t>(std::ranges::count(
            edits->placed, before_.parts[change.part].name, &models::PlacedModel::type));
      case PartKind::kPlaces:
      case PartKind::kLooks:
        return 0;
    }
    return 0;
  }

  static void note_all(core::BlockCoord block, const DecodedEdits& edits, const std::string& reason,
                       std::vector<Misfit>& list) {
    const auto note = [&](EditKind kind, std::size_t count) {
      if (count > 0) list.push_back({block, kind, static_cast<std::uint32_t>(count), reason});
    };
    note(EditKind::kRemoved, edits.removed.size());
    note(EditKind::kPlaced, edits.placed.size());
    note(EditKind::kGround, edits.ground.size());
  }

  const WorldIdentity& before_;
  const CurrentWorld& now_;
  std::vector<PartChange> changes_;
  std::vector<Touched> touched_;  // one for each change
  std::vector<ScatterSpan> earlier_, later_;
};

core::Result<DecodedEdits> decoded(const Stored& stored) {
  if (stored.version == world::kEditFormat) return world::decode_block(stored.block, stored.bytes);
  return core::fail(core::ErrorCode::kParse,
                    fmt::format("their version is {}, but this program reads {}", stored.version,
                                world::kEditFormat));
}

BlockEdits encoded(const DecodedEdits& edits) {
  return {world::kEditFormat, world::encode_block(edits)};
}

// What a block stores; nothing for no edits.
std::optional<BlockEdits> stored(const DecodedEdits& edits) {
  return edits.empty() ? std::nullopt : std::optional(encoded(edits));
}

// Adapts one file.
class Adapter {
 public:
  Adapter(SaveTables& tables, const WorldIdentity& before, const CurrentWorld& now)
      : tables_(tables), before_(before), now_(now), judge_(before, now) {}

  core::Result<Adaptation> run(Accept accept) {
    moves_ = now_.world && accept != Accept::kSameWorld;
    core::Result<void> failed;
    auto ok = tables_.for_each_edits(
        [&](core::BlockCoord block, std::uint32_t version, std::span<const std::byte> bytes) {
          const auto surface = tables_.surface(block);
          if (!surface && failed) failed = tl::unexpected(surface.error());
          if (failed) add({block, version, bytes}, *surface);
        });
    if (ok) ok = failed;
    if (ok) ok = judge_.accepted(accept, tables_.database().file());
    if (ok && now_.world) ok = add_kept();
    if (!ok) return tl::unexpected(ok.error());
    return std::move(result_);
  }

 private:
  void add(const Stored& of, std::optional<std::uint64_t> surface) {
    auto edits = decoded(of);
    judge_.count_touched(of.block, edits ? &*edits : nullptr, surface);
    if (!moves_) return;
    if (!edits) {
      result_.misfits.push_back({of.block, std::nullopt, 1, edits.error().message});
      keep(of.block, before_, {of.version, {of.bytes.begin(), of.bytes.end()}});
      result_.edits[of.block] = std::nullopt;
      return;
    }
    DecodedEdits unfit = judge_.take_unfit(of.block, *edits, result_.misfits);
    if (unfit.empty()) return;
    keep(of.block, before_, encoded(unfit));
    result_.edits[of.block] = stored(*edits);
  }

  void keep(core::BlockCoord block, const WorldIdentity& world, BlockEdits edits) {
    if (!result_.kept) result_.kept.emplace();
    result_.kept->push_back({block, {{}, world.hash, world.parts}, std::move(edits)});
  }

  // Returns kept edits that fit again to their blocks.
  core::Result<void> add_kept() {
    auto kept = tables_.kept();
    if (!kept) return tl::unexpected(kept.error());
    bool is_changed = result_.kept.has_value();
    for (KeptEdits& old : *kept) {
      auto returned = take_back(old);
      if (!returned) return tl::unexpected(returned.error());
      is_changed = is_changed || *returned;
      if (!old.edits.bytes.empty()) keep(old.block, old.world, std::move(old.edits));
    }
    if (is_changed && !result_.kept) result_.kept.emplace();
    if (!is_changed) result_.kept.reset();
    return {};
  }

  // The judge of kept edits of a world; one for all blocks of it.
  const Judge& judge_of(const WorldIdentity& world) {
    for (const auto& known : kept_worlds_)
      if (known->world == world) return known->judge;
    kept_worlds_.push_back(std::make_unique<KeptWorld>(world, now_));
    return kept_worlds_.back()->judge;
  }

  // Leaves in `old` the edits that still do not fit. Returns true if others fit again.
  core::Result<bool> take_back(KeptEdits& old) {
    auto edits = decoded({old.block, old.edits.version, old.edits.bytes});
    if (!edits) return false;
    std::vector<Misfit> still;
    DecodedEdits unfit = judge_of(old.world).take_unfit(old.block, *edits, still);
    if (edits->empty()) return false;
    auto there = block_edits(old.block);
    if (!there) return tl::unexpected(there.error());
    if (!merge(*there, std::move(*edits))) return false;
    old.edits = encoded(unfit);
    result_.edits[old.block] = stored(*there);
    return true;
  }

  // The edits of a block as adapted so far.
  core::Result<DecodedEdits> block_edits(core::BlockCoord block) {
    std::optional<BlockEdits> here;
    if (const auto found = result_.edits.find(block); found != result_.edits.end()) {
      here = found->second;
    } else {
      auto read = tables_.edits(block);
      if (!read) return tl::unexpected(read.error());
      here = std::move(*read);
    }
    if (!here) return DecodedEdits();
    return decoded({block, here->version, here->bytes});
  }

  struct KeptWorld {
    KeptWorld(const WorldIdentity& of, const CurrentWorld& now) : world(of), judge(world, now) {}
    const WorldIdentity world;
    const Judge judge;
  };

  SaveTables& tables_;
  const WorldIdentity& before_;
  const CurrentWorld& now_;
  Judge judge_;
  std::vector<std::unique_ptr<KeptWorld>> kept_worlds_;
  bool moves_ = false;  // edits that do not fit
  Adaptation result_;
};

}  // namespace

std::uint64_t surface_hash(const world::World& world, core::BlockCoord block) {
  const core::RoundToNearest rounding;
  const double relief_m = world.terrain.real(models::kTerrainReliefM);
  const std::vector<std::uint16_t> heights = world::ground_of_block(world, block);
  std::uint64_t hash =
      core::hash_bytes(std::as_bytes(std::span(heights)), std::bit_cast<std::uint64_t>(relief_m));
  const double lowest_m = *std::ranges::min_element(heights) / 65535.0 * relief_m;
  const std::uint64_t bodies = world::bodies_hash_in(world, block);
  if (bodies != 0) hash = core::combine(hash, bodies);
  if (!world.water.exists() || world.water.level_m <= lowest_m) return hash;
  return core::combine(hash, std::bit_cast<std::uint64_t>(world.water.level_m));
}

core::Result<Adaptation> adapt(SaveTables& tables, const WorldIdentity& before,
                               const CurrentWorld& now, Accept accept) {
  return Adapter(tables, before, now).run(accept);
}

}  // namespace psygen::save
