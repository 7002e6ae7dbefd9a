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
using Bytes = std::vector<std::byte>;

// Decodes one block.
class BlockReader {
 public:
  BlockReader(const World& world, const models::Registry& registry, core::BlockCoord block,
              std::span<const std::byte> bytes)
      : world_(world), registry_(registry), block_(block), in_(bytes) {}

  core::Result<BlockEdits> read() {
    if (in_.get<std::uint32_t>() != kMagic) return broken("these bytes are not edits of a block");
    const auto version = in_.get<std::uint16_t>();
    if (version != kEditFormat) {
      return broken(
          fmt::format("their version is {}, but this program reads {}", version, kEditFormat));
    }
    BlockEdits edits;
    for (const auto read :
         {&BlockReader::read_removed, &BlockReader::read_placed, &BlockReader::read_ground}) {
      auto ok = (this->*read)(edits);
      if (in_.failed()) return broken("they end too early");
      if (!ok) return broken(ok.error().message);
    }
    if (in_.left() > 0) return broken("there are extra bytes at the end");
    if (edits.removed.size() + edits.placed.size() + edits.ground.size() > kMaxEditsPerBlock)
      return broken(fmt::format("more than {} edits", kMaxEditsPerBlock));
    return edits;
  }

 private:
  tl::unexpected<core::Error> broken(std::string_view why) const {
    return core::fail(
        core::ErrorCode::kParse,
        fmt::format("the edits of block ({}, {}) cannot be read: {}", block_.x, block_.z, why));
  }
  static tl::unexpected<core::Error> wrong(std::string why) {
    return core::fail(core::ErrorCode::kParse, std::move(why));
  }
  // The position of an edit from the block's corner must lie in the block.
  core::Result<void> check_inside(double x, double z) const {
    const auto at = check_place(world_, {block_, {x, 0, z}});
    if (!at) return tl::unexpected(at.error());
    if (at->block != block_) return wrong("an edit is in another block");
    return {};
  }
  bool is_next_id(std::uint32_t id, std::uint32_t before) const {
    return id > before && id <= kMaxEditId;
  }

  core::Result<void> read_removed(BlockEdits& edits) {
    const std::size_t count = in_.get_count(16);
    for (std::size_t i = 0; i < count; ++i) {
      RemovedModel r;
      in_.read(r.index, r.moved_id, r.moved_to.x, r.moved_to.z);
      if (i > 0 && r.index <= edits.removed.back().index) return wrong("models are not in order");
      if (r.index >= models_per_block(world_))
        return wrong(fmt::format("the block has no model {}", r.index));
      if (r.moved_id > kMaxEditId)
        return wrong(fmt::format("a moved model has the id {}, but the maximum is {}", r.moved_id,
                                 kMaxEditId));
      edits.removed.push_back(r);
    }
    return {};
  }

  // Reads the name of a model type; it has at most 255 characters.
  core::Result<models::ModelIndex> read_type() {
    const std::string_view name = in_.get_text(in_.get<std::uint8_t>());
    if (in_.failed()) return wrong("");
    const int index = registry_.find(name);
    if (index < 0) return wrong(fmt::format("there is no model type \"{}\"", core::shown(name)));
    return static_cast<models::ModelIndex>(index);
  }

  core::Result<void> read_placed(BlockEdits& edits) {
    const std::size_t count = in_.get_count(18);
    for (std::size_t i = 0; i < count; ++i) {
      PlacedModel p;
      in_.read(p.id, p.local_m.x, p.local_m.y, p.above_m);
      const auto model = read_type();
      if (!model) return tl::unexpected(model.error());
      const models::ModelType& type = registry_[*model];
      // An older version of the type may have had fewer parameters. The others have their defaults,
      // as in world files and their identity (save/world_identity.hpp).
      const std::size_t known = type.parameters().size();
      const std::size_t values = in_.get<std::uint8_t>();
      if (values > known)
        return wrong(fmt::format("{} has {} parameters, but these edits store {}", type.name(),
                                 known, values));
      p.parameters = models::default_parameters(type);
      for (std::size_t k = 0; k < values; ++k)
        p.parameters.set_integer(k, in_.get<std::int64_t>());
      if (in_.failed()) return {};
      if (!is_next_id(p.id, i > 0 ? edits.placed.back().id : 0))
        return wrong("ids are not in order");
      if (auto ok = check_inside(double{p.local_m.x}, double{p.local_m.y}); !ok) return ok;
      if (auto ok = check_model(registry_, *model, p.parameters, double{p.above_m}); !ok) return ok;
      models::bind(p, type);
      edits.placed.push_back(std::move(p));
    }
    return {};
  }

  core::Result<void> read_ground(BlockEdits& edits) {
    const std::size_t count = in_.get_count(46);
    for (std::size_t i = 0; i < count; ++i) {
      GroundEdit e;
      e.id = in_.get<std::uint32_t>();
      const auto change = in_.get<std::uint8_t>();
      if (change > static_cast<std::uint8_t>(models::GroundChange::kStampSet))
        return wrong(fmt::format("{} is not a type of ground edit", change));
      e.change = static_cast<models::GroundChange>(change);
      e.square = in_.get<std::uint8_t>() != 0;
      e.centre.block = block_;
      in_.read(e.centre.local.x, e.centre.local.z, e.radius_m, e.falloff, e.height_m);
      if (is_stamp(e.change)) {
        e.square = true;
        e.map = read_map();
      }
      if (in_.failed()) return {};
      if (!is_next_id(e.id, i > 0 ? edits.ground.back()->id : 0))
        return wrong("ids are not in order");
      if (auto ok = check_inside(e.centre.local.x, e.centre.local.z); !ok) return ok;
      if (auto ok = check_ground(world_, e); !ok) return ok;
      seal(e);
      edits.ground.push_back(std::make_shared<const GroundEdit>(std::move(e)));
    }
    return {};
  }

  std::shared_ptr<const models::Heightmap> read_map() {
    auto map = std::make_shared<models::Heightmap>();
    in_.read(map->columns, map->rows);
    const bool fits = map->columns <= kMaxHeightmapSide && map->rows <= kMaxHeightmapSide;
    if (fits) map->heights_m = in_.get_all<float>(std::size_t{map->columns} * map->rows);
    return map;  // check_ground() rejects maps that are too large
  }

  const World& world_;
  const models::Registry& registry_;
  core::BlockCoord block_;
  core::ByteReader in_;
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

void put_ground(const GroundEdit& e, Bytes& out) {
  core::put(out, e.id, static_cast<std::uint8_t>(e.change),
            static_cast<std::uint8_t>(e.square ? 1 : 0), e.centre.local.x, e.centre.local.z,
            e.radius_m, e.falloff, e.height_m);
  if (!is_stamp(e.change)) return;
  core::put(out, e.map->columns, e.map->rows);
  core::put_all(out, std::span<const float>(e.map->heights_m));
}

}  // namespace

std::vector<std::byte> encode_block(const Edits& edits, const models::Registry&,
                                    core::BlockCoord block) {
  const BlockEdits* const of_block = edits.layer() ? edits.layer()->block(block) : nullptr;
  if (of_block == nullptr) return {};
  Bytes out;
  core::put(out, kMagic, kEditFormat, static_cast<std::uint32_t>(of_block->removed.size()));
  for (const RemovedModel& r : of_block->removed)
    core::put(out, r.index, r.moved_id, r.moved_to.x, r.moved_to.z);
  core::put(out, static_cast<std::uint32_t>(of_block->placed.size()));
  for (const PlacedModel& p : of_block->placed)
    put_placed(p, out);
  core::put(out, static_cast<std::uint32_t>(of_block->ground.size()));
  for (const auto& e : of_block->ground)
    put_ground(*e, out);
  return out;
}

core::Result<void> load_block(Edits& edits, const World& world, const models::Registry& registry,
                              core::BlockCoord block, std::span<const std::byte> bytes) {
  auto decoded = BlockReader(world, registry, block, bytes).read();
  if (!decoded) return tl::unexpected(decoded.error());
  return edits.replace_block(world, block, std::move(*decoded));
}

}  // namespace psygen::world
