#include "engine/world/edits/edit_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/bytes.hpp"
#include "engine/core/utf8.hpp"
#include "engine/world/edits/edit_checks.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

using models::BlockEdits;
using models::GroundEdit;
using models::PlacedModel;
using models::RemovedModel;

constexpr std::uint32_t kMagic = 0x44454750;  // "PGED"
// This bit of its change marks an edit of the ground that is not whole. Programs that do not know
// it reject the block.
constexpr std::uint8_t kPart = 0x80;
// This bit marks a river with the discharge of its points; that of others follows from their speed.
constexpr std::uint8_t kDischarge = 0x40;
constexpr auto kRiver = static_cast<std::uint8_t>(models::GroundChange::kRiver);
using Bytes = std::vector<std::byte>;

tl::unexpected<core::Error> broken(core::BlockCoord block, std::string_view why) {
  return core::fail(
      core::ErrorCode::kParse,
      fmt::format("the edits of block ({}, {}) cannot be read: {}", block.x, block.z, why));
}

tl::unexpected<core::Error> wrong(std::string why) {
  return core::fail(core::ErrorCode::kParse, std::move(why));
}

// Decodes one block.
class BlockReader {
 public:
  BlockReader(core::BlockCoord block, std::span<const std::byte> bytes)
      : block_(block), in_(bytes) {}

  core::Result<BlockEdits> read() {
    if (in_.get<std::uint32_t>() != kMagic)
      return broken(block_, "these bytes are not edits of a block");
    const auto version = in_.get<std::uint16_t>();
    if (version != kEditFormat) {
      return broken(block_, fmt::format("their version is {}, but this program reads {}", version,
                                        kEditFormat));
    }
    BlockEdits edits;
    for (const auto read :
         {&BlockReader::read_removed, &BlockReader::read_placed, &BlockReader::read_ground}) {
      auto ok = (this->*read)(edits);
      if (in_.failed()) return broken(block_, "they end too early");
      if (!ok) return broken(block_, ok.error().message);
    }
    if (in_.left() > 0) return broken(block_, "there are extra bytes at the end");
    if (edits.removed.size() + edits.placed.size() + edits.ground.size() > kMaxEditsPerBlock)
      return broken(block_, fmt::format("more than {} edits", kMaxEditsPerBlock));
    return edits;
  }

 private:
  static bool is_next_id(std::uint32_t id, std::uint32_t before) {
    return id > before && id <= kMaxEditId;
  }

  core::Result<void> read_removed(BlockEdits& edits) {
    const std::size_t count = in_.get_count(16);
    for (std::size_t i = 0; i < count; ++i) {
      RemovedModel r;
      in_.read(r.index, r.moved_id, r.moved_to.x, r.moved_to.z);
      if (i > 0 && r.index <= edits.removed.back().index) return wrong("models are not in order");
      if (r.moved_id > kMaxEditId)
        return wrong(fmt::format("a moved model has the id {}, but the maximum is {}", r.moved_id,
                                 kMaxEditId));
      edits.removed.push_back(r);
    }
    return {};
  }

  core::Result<void> read_placed(BlockEdits& edits) {
    const std::size_t count = in_.get_count(18);
    for (std::size_t i = 0; i < count; ++i) {
      PlacedModel p;
      in_.read(p.id, p.local_m.x, p.local_m.y, p.above_m);
      p.type = in_.get_text(in_.get<std::uint8_t>());  // at most 255 characters
      p.parameter_count = in_.get<std::uint8_t>();
      if (p.parameter_count > models::Parameters::kMaxCount)
        return wrong(fmt::format("a model has {} parameters, but the maximum is {}",
                                 p.parameter_count, models::Parameters::kMaxCount));
      for (std::size_t k = 0; k < p.parameter_count; ++k)
        p.parameters.set_integer(k, in_.get<std::int64_t>());
      if (in_.failed()) return {};
      if (!is_next_id(p.id, i > 0 ? edits.placed.back().id : 0))
        return wrong("ids are not in order");
      edits.placed.push_back(std::move(p));
    }
    return {};
  }

  core::Result<void> read_ground(BlockEdits& edits) {
    const std::size_t count = in_.get_count(46);
    for (std::size_t i = 0; i < count; ++i) {
      GroundEdit e;
      e.id = in_.get<std::uint32_t>();
      const auto marked = in_.get<std::uint8_t>();
      const bool has_discharge = (marked & ~kPart) == (kRiver | kDischarge);
      const int marks = has_discharge ? kPart | kDischarge : kPart;
      const auto change = static_cast<std::uint8_t>(marked & ~marks);
      if (change > static_cast<std::uint8_t>(models::GroundChange::kLake) ||
          change == static_cast<std::uint8_t>(models::GroundChange::kRoad))
        return wrong(fmt::format("{} is not a type of ground edit", change));
      e.change = static_cast<models::GroundChange>(change);
      e.square = in_.get<std::uint8_t>() != 0;
      e.centre.block = block_;
      in_.read(e.centre.local.x, e.centre.local.z, e.radius_m, e.falloff, e.height_m);
      if ((marked & kPart) != 0) {
        in_.read(e.strength);
        e.blend = static_cast<models::GroundBlend>(in_.get<std::uint8_t>());
      }
      if (is_stamp(e.change)) {
        e.square = true;
        auto map = std::make_shared<models::Heightmap>();
        in_.read(map->columns, map->rows);
        if (map->columns > kMaxHeightmapSide || map->rows > kMaxHeightmapSide)
          return wrong(fmt::format("a heightmap has {} × {} points, but each side has at most {}",
                                   map->columns, map->rows, kMaxHeightmapSide));
        map->heights_m = in_.get_all<float>(std::size_t{map->columns} * map->rows);
        e.map = std::move(map);
      }
      if (e.change == models::GroundChange::kRiver) e.river = read_river(has_discharge);
      if (e.change == models::GroundChange::kLake) e.lake = read_lake();
      if (in_.failed()) return {};
      if (!is_next_id(e.id, i > 0 ? edits.ground.back()->id : 0))
        return wrong("ids are not in order");
      edits.ground.push_back(std::make_shared<const GroundEdit>(std::move(e)));
    }
    return {};
  }

  template <class... Vectors>
  void read_vectors(Vectors&... vectors) {
    (in_.read(vectors.x, vectors.y), ...);
  }

  std::shared_ptr<const models::RiverPiece> read_river(bool has_discharge) {
    auto river = std::make_shared<models::RiverPiece>();
    core::WorldPosition& o = river->origin;
    in_.read(o.block.x, o.block.z, o.local.x, o.local.z, river->body, river->edge_m);
    river->points.resize(in_.get_count((has_discharge ? 12 : 11) * sizeof(double)));
    for (models::RiverPoint& p : river->points) {
      read_vectors(p.at_m, p.direction);
      in_.read(p.half_width_m, p.surface_m, p.bed_m, p.bank_m, p.speed_m_s, p.fall, p.foam);
      if (has_discharge)
        in_.read(p.discharge_m3_s);
      else
        p.discharge_m3_s = p.speed_m_s * models::cross_section_m2(p);
    }
    river->near.resize(in_.get_count(4 * sizeof(double) + 1));
    for (models::RiverNeighbour& n : river->near) {
      read_vectors(n.from_m, n.to_m);
      n.is_earlier = in_.get<std::uint8_t>() != 0;
    }
    if (!river->points.empty()) models::seal(*river);
    return river;
  }

  std::shared_ptr<const models::LakePiece> read_lake() {
    auto lake = std::make_shared<models::LakePiece>();
    core::WorldPosition& o = lake->origin;
    in_.read(o.block.x, o.block.z, o.local.x, o.local.z, lake->body, lake->level_m, lake->depth_m,
             lake->shore_m, lake->edge_m);
    read_vectors(lake->low_m, lake->high_m);
    lake->inside = in_.get<std::uint8_t>() != 0;
    lake->segments.resize(in_.get_count(8 * sizeof(double)));
    for (models::LakeSegment& s : lake->segments)
      read_vectors(s.from_m, s.to_m, s.from_normal, s.to_normal);
    models::seal(*lake);
    return lake;
  }

  core::BlockCoord block_;
  core::ByteReader in_;
};

// Checks decoded edits in a world.
class BlockChecks {
 public:
  BlockChecks(const World& world, const models::Registry& registry, core::BlockCoord block)
      : world_(world), registry_(registry), block_(block) {}

  core::Result<void> check(const RemovedModel& removed) const {
    return check_removed(world_, block_, removed.index);
  }

  // The position of an edit from the block's corner must lie in the block.
  core::Result<void> check_inside(double x, double z) const {
    const auto at = check_place(world_, {block_, {x, 0, z}});
    if (!at) return tl::unexpected(at.error());
    if (at->block != block_) return wrong("an edit is in another block");
    return {};
  }

  // Binds a model to its type.
  core::Result<void> bind(PlacedModel& p) const {
    const int index = registry_.find(p.type);
    if (index < 0) return wrong(fmt::format("there is no model type \"{}\"", core::shown(p.type)));
    const auto model = static_cast<models::ModelIndex>(index);
    const models::ModelType& type = registry_[model];
    // An older version of the type may have had fewer parameters. The others have their defaults,
    // as in world files and their identity (save/world_identity.hpp).
    const std::size_t known = type.parameters().size();
    if (p.parameter_count > known)
      return wrong(fmt::format("{} has {} parameters, but these edits store {}", type.name(), known,
                               p.parameter_count));
    models::Parameters parameters = models::default_parameters(type);
    for (std::size_t k = 0; k < p.parameter_count; ++k)
      parameters.set_integer(k, p.parameters.integer(k));
    if (auto ok = check_model(registry_, model, parameters, double{p.above_m}); !ok) return ok;
    p.parameters = parameters;
    models::bind(p, type);
    return {};
  }

  core::Result<void> seal(std::shared_ptr<const GroundEdit>& edit) const {
    auto ok = check_inside(edit->centre.local.x, edit->centre.local.z).and_then([&] {
      return check_ground(world_, *edit);
    });
    if (!ok) return ok;
    GroundEdit sealed = *edit;
    models::seal(sealed);
    edit = std::make_shared<const GroundEdit>(std::move(sealed));
    return {};
  }

 private:
  const World& world_;
  const models::Registry& registry_;
  core::BlockCoord block_;
};

void put_placed(const PlacedModel& p, Bytes& out) {
  core::put(out, p.id, p.local_m.x, p.local_m.y, p.above_m);
  const std::string_view name = std::string_view(p.type).substr(0, 255);
  core::put(out, static_cast<std::uint8_t>(name.size()));
  core::put_all(out, std::span<const char>(name));
  core::put(out, static_cast<std::uint8_t>(p.parameter_count));
  for (std::size_t k = 0; k < p.parameter_count; ++k)
    core::put(out, p.parameters.integer(k));
}

template <class... Vectors>
void put_vectors(Bytes& out, const Vectors&... vectors) {
  (core::put(out, vectors.x, vectors.y), ...);
}

void put_river(const models::RiverPiece& river, Bytes& out) {
  const core::WorldPosition& o = river.origin;
  core::put(out, o.block.x, o.block.z, o.local.x, o.local.z, river.body, river.edge_m,
            static_cast<std::uint32_t>(river.points.size()));
  for (const models::RiverPoint& p : river.points) {
    put_vectors(out, p.at_m, p.direction);
    core::put(out, p.half_width_m, p.surface_m, p.bed_m, p.bank_m, p.speed_m_s, p.fall, p.foam,
              p.discharge_m3_s);
  }
  core::put(out, static_cast<std::uint32_t>(river.near.size()));
  for (const models::RiverNeighbour& n : river.near) {
    put_vectors(out, n.from_m, n.to_m);
    core::put(out, static_cast<std::uint8_t>(n.is_earlier ? 1 : 0));
  }
}

void put_lake(const models::LakePiece& lake, Bytes& out) {
  const core::WorldPosition& o = lake.origin;
  core::put(out, o.block.x, o.block.z, o.local.x, o.local.z, lake.body, lake.level_m, lake.depth_m,
            lake.shore_m, lake.edge_m);
  put_vectors(out, lake.low_m, lake.high_m);
  core::put(out, static_cast<std::uint8_t>(lake.inside ? 1 : 0),
            static_cast<std::uint32_t>(lake.segments.size()));
  for (const models::LakeSegment& s : lake.segments)
    put_vectors(out, s.from_m, s.to_m, s.from_normal, s.to_normal);
}

void put_ground(const GroundEdit& e, Bytes& out) {
  const int marks = (e.is_whole() ? 0 : kPart) | (e.river ? kDischarge : 0);
  core::put(out, e.id, static_cast<std::uint8_t>(static_cast<int>(e.change) | marks),
            static_cast<std::uint8_t>(e.square ? 1 : 0), e.centre.local.x, e.centre.local.z,
            e.radius_m, e.falloff, e.height_m);
  if (!e.is_whole()) core::put(out, e.strength, static_cast<std::uint8_t>(e.blend));
  if (e.river) put_river(*e.river, out);
  if (e.lake) put_lake(*e.lake, out);
  if (!is_stamp(e.change)) return;
  core::put(out, e.map->columns, e.map->rows);
  core::put_all(out, std::span<const float>(e.map->heights_m));
}

}  // namespace

std::vector<std::byte> encode_block(const Edits& edits, const models::Registry&,
                                    core::BlockCoord block) {
  const BlockEdits* const of_block = edits.layer() ? edits.layer()->block(block) : nullptr;
  return of_block != nullptr ? encode_block(*of_block) : Bytes();
}

std::vector<std::byte> encode_block(const BlockEdits& edits) {
  if (edits.empty()) return {};
  Bytes out;
  core::put(out, kMagic, kEditFormat, static_cast<std::uint32_t>(edits.removed.size()));
  for (const RemovedModel& r : edits.removed)
    core::put(out, r.index, r.moved_id, r.moved_to.x, r.moved_to.z);
  core::put(out, static_cast<std::uint32_t>(edits.placed.size()));
  for (const PlacedModel& p : edits.placed)
    put_placed(p, out);
  core::put(out, static_cast<std::uint32_t>(edits.ground.size()));
  for (const auto& e : edits.ground)
    put_ground(*e, out);
  return out;
}

core::Result<BlockEdits> decode_block(core::BlockCoord block, std::span<const std::byte> bytes) {
  return BlockReader(block, bytes).read();
}

std::vector<UnfitEdit> unfit_edits(BlockEdits& edits, const World& world,
                                   const models::Registry& registry, core::BlockCoord block) {
  const BlockChecks checks(world, registry, block);
  std::vector<UnfitEdit> unfit;
  const auto note = [&](EditKind kind, std::uint32_t id, const core::Result<void>& checked) {
    if (!checked) unfit.push_back({kind, id, false, checked.error().message});
    return checked.has_value();
  };
  for (const RemovedModel& removed : edits.removed)
    note(EditKind::kRemoved, removed.index, checks.check(removed));
  for (PlacedModel& placed : edits.placed) {
    const bool inside =
        note(EditKind::kPlaced, placed.id,
             checks.check_inside(double{placed.local_m.x}, double{placed.local_m.y}).and_then([&] {
               return check_above(double{placed.above_m});
             }));
    if (inside && !note(EditKind::kPlaced, placed.id, checks.bind(placed)))
      unfit.back().hidden = true;
  }
  for (auto& edit : edits.ground)
    note(EditKind::kGround, edit->id, checks.seal(edit));
  return unfit;
}

core::Result<void> load_block(Edits& edits, const World& world, const models::Registry& registry,
                              core::BlockCoord block, std::span<const std::byte> bytes) {
  auto decoded = decode_block(block, bytes);
  if (!decoded) return tl::unexpected(decoded.error());
  for (const UnfitEdit& unfit : unfit_edits(*decoded, world, registry, block))
    if (!unfit.hidden) return broken(block, unfit.reason);
  return edits.replace_block(world, block, std::move(*decoded));
}

}  // namespace psygen::world
