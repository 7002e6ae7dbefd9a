#include "engine/world/edits/edit_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>
#include <string>
#include <utility>

#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

using models::BlockEdits;
using models::GroundEdit;
using models::PlacedModel;
using models::RemovedModel;

constexpr std::uint32_t kMagic = 0x44454750;  // "PGED"
static_assert(std::endian::native == std::endian::little, "bytes are stored as they are");

class Writer {
 public:
  template <class T>
  void put(T value) {
    const auto* const from = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), from, from + sizeof value);
  }
  template <class T>
  void put_all(std::span<const T> values) {
    const auto from = std::as_bytes(values);
    bytes_.insert(bytes_.end(), from.begin(), from.end());
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  // The next value; 0 and failed() where there is none.
  template <class T>
  T get() {
    T value{};
    if (!has(sizeof value)) return value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return value;
  }
  template <class T>
  std::vector<T> get_all(std::size_t count) {
    if (count > bytes_.size() / sizeof(T)) failed_ = true;
    if (failed_) return {};
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data(), count * sizeof(T));
    bytes_ = bytes_.subspan(count * sizeof(T));
    return values;
  }
  // A count of things of at least `each_bytes`, all of which must be there.
  std::size_t count(std::size_t each_bytes) {
    const auto n = get<std::uint32_t>();
    if (n > bytes_.size() / each_bytes) failed_ = true;
    return failed_ ? 0 : n;
  }
  bool failed() const { return failed_; }
  bool at_end() const { return bytes_.empty(); }

 private:
  bool has(std::size_t count) {
    if (bytes_.size() < count) failed_ = true;
    return !failed_;
  }
  std::span<const std::byte> bytes_;
  bool failed_ = false;
};

// Decodes one block.
class BlockReader {
 public:
  BlockReader(const World& world, const models::Registry& registry, core::BlockCoord block,
              std::span<const std::byte> bytes)
      : world_(world), registry_(registry), block_(block), in_(bytes) {}

  core::Result<BlockEdits> read() {
    if (in_.get<std::uint32_t>() != kMagic) return broken("they are not edits of a block");
    const auto version = in_.get<std::uint16_t>();
    if (version != kEditFormat) {
      return broken(
          fmt::format("their version is {}, and this program reads {}", version, kEditFormat));
    }
    BlockEdits edits;
    for (const auto read :
         {&BlockReader::read_removed, &BlockReader::read_placed, &BlockReader::read_ground}) {
      auto ok = (this->*read)(edits);
      if (in_.failed()) return broken("they end too early");
      if (!ok) return broken(ok.error().message);
    }
    if (!in_.at_end()) return broken("there are more than belong to it");
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
  // Where an edit is, from the block's corner. It must lie in the block.
  core::Result<void> check_inside(double x, double z) const {
    const auto at = check_place(world_, {block_, {x, 0, z}});
    if (!at) return tl::unexpected(at.error());
    if (at->block != block_) return wrong("an edit lies in another block");
    return {};
  }
  bool is_next_id(std::uint32_t id, std::uint32_t before) const {
    return id > before && id <= kMaxEditId;
  }

  core::Result<void> read_removed(BlockEdits& edits) {
    const std::size_t count = in_.count(16);
    for (std::size_t i = 0; i < count; ++i) {
      RemovedModel r;
      r.index = in_.get<std::uint32_t>();
      r.moved_id = in_.get<std::uint32_t>();
      r.moved_to.x = in_.get<std::int32_t>();
      r.moved_to.z = in_.get<std::int32_t>();
      if (i > 0 && r.index <= edits.removed.back().index) return wrong("models are not in order");
      if (r.index >= models_per_block(world_))
        return wrong(fmt::format("the block has no model {}", r.index));
      edits.removed.push_back(r);
    }
    return {};
  }

  // A model type by its name. A name of 255 letters is the longest.
  core::Result<models::ModelIndex> read_type() {
    const std::vector<char> letters = in_.get_all<char>(in_.get<std::uint8_t>());
    if (in_.failed()) return wrong("");
    const std::string name(letters.begin(), letters.end());
    const int index = registry_.find(name);
    if (index < 0) return wrong(fmt::format("there is no model type \"{}\"", printable(name)));
    return static_cast<models::ModelIndex>(index);
  }
  static std::string printable(std::string name) {
    std::ranges::replace_if(
        name, [](char c) { return c < ' ' || c > '~'; }, '?');
    return name;
  }

  core::Result<void> read_placed(BlockEdits& edits) {
    const std::size_t count = in_.count(18);
    for (std::size_t i = 0; i < count; ++i) {
      PlacedModel p;
      p.id = in_.get<std::uint32_t>();
      p.local_m.x = in_.get<float>();
      p.local_m.y = in_.get<float>();
      p.above_m = in_.get<float>();
      const auto type = read_type();
      if (!type) return tl::unexpected(type.error());
      p.model = *type;
      const std::size_t values = registry_[p.model].parameters().size();
      if (in_.get<std::uint8_t>() != values)
        return wrong(fmt::format("{} has {} parameters", registry_[p.model].name(), values));
      for (std::size_t k = 0; k < values; ++k)
        p.parameters.set_integer(k, in_.get<std::int64_t>());
      if (in_.failed()) return {};
      if (!is_next_id(p.id, i > 0 ? edits.placed.back().id : 0))
        return wrong("ids are not in order");
      if (auto ok = check_inside(double{p.local_m.x}, double{p.local_m.y}); !ok) return ok;
      if (auto ok = check_model(registry_, p.model, p.parameters, double{p.above_m}); !ok)
        return ok;
      p.reach_m = placed_reach(registry_[p.model], p.parameters, double{p.above_m});
      edits.placed.push_back(std::move(p));
    }
    return {};
  }

  core::Result<void> read_ground(BlockEdits& edits) {
    const std::size_t count = in_.count(46);
    for (std::size_t i = 0; i < count; ++i) {
      GroundEdit e;
      e.id = in_.get<std::uint32_t>();
      const auto change = in_.get<std::uint8_t>();
      if (change > static_cast<std::uint8_t>(models::GroundChange::kStampSet))
        return wrong(fmt::format("there is no change of the ground {}", change));
      e.change = static_cast<models::GroundChange>(change);
      e.square = in_.get<std::uint8_t>() != 0;
      e.centre.block = block_;
      e.centre.local.x = in_.get<double>();
      e.centre.local.z = in_.get<double>();
      e.radius_m = in_.get<double>();
      e.falloff = in_.get<double>();
      e.height_m = in_.get<double>();
      if (e.change >= models::GroundChange::kStampAdd) e.map = read_map();
      if (in_.failed()) return {};
      if (!is_next_id(e.id, i > 0 ? edits.ground.back()->id : 0))
        return wrong("ids are not in order");
      if (auto ok = check_inside(e.centre.local.x, e.centre.local.z); !ok) return ok;
      if (auto ok = check_ground(world_, e); !ok) return ok;
      e.content = content_hash(e);
      edits.ground.push_back(std::make_shared<const GroundEdit>(std::move(e)));
    }
    return {};
  }

  std::shared_ptr<const models::Heightmap> read_map() {
    auto map = std::make_shared<models::Heightmap>();
    map->columns = in_.get<std::uint32_t>();
    map->rows = in_.get<std::uint32_t>();
    const bool fits = map->columns <= kMaxHeightmapSide && map->rows <= kMaxHeightmapSide;
    if (fits) map->heights_m = in_.get_all<float>(std::size_t{map->columns} * map->rows);
    return map;  // check_ground() refuses what is too large
  }

  const World& world_;
  const models::Registry& registry_;
  core::BlockCoord block_;
  Reader in_;
};

void put_placed(const PlacedModel& p, const models::Registry& registry, Writer& out) {
  const models::ModelType& type = registry[p.model];
  out.put(p.id);
  out.put(p.local_m.x);
  out.put(p.local_m.y);
  out.put(p.above_m);
  const std::string_view name = type.name().substr(0, 255);
  out.put(static_cast<std::uint8_t>(name.size()));
  out.put_all(std::span<const char>(name));
  const std::size_t values = type.parameters().size();
  out.put(static_cast<std::uint8_t>(values));
  for (std::size_t k = 0; k < values; ++k)
    out.put(p.parameters.integer(k));
}

void put_ground(const GroundEdit& e, Writer& out) {
  out.put(e.id);
  out.put(static_cast<std::uint8_t>(e.change));
  out.put(static_cast<std::uint8_t>(e.square ? 1 : 0));
  for (const double v : {e.centre.local.x, e.centre.local.z, e.radius_m, e.falloff, e.height_m})
    out.put(v);
  if (e.change < models::GroundChange::kStampAdd) return;
  out.put(e.map->columns);
  out.put(e.map->rows);
  out.put_all(std::span<const float>(e.map->heights_m));
}

}  // namespace

std::vector<std::byte> encode_block(const Edits& edits, const models::Registry& registry,
                                    core::BlockCoord block) {
  const BlockEdits* const of_block = edits.layer() ? edits.layer()->block(block) : nullptr;
  if (of_block == nullptr) return {};
  Writer out;
  out.put(kMagic);
  out.put(kEditFormat);
  out.put(static_cast<std::uint32_t>(of_block->removed.size()));
  for (const RemovedModel& r : of_block->removed) {
    out.put(r.index);
    out.put(r.moved_id);
    out.put(r.moved_to.x);
    out.put(r.moved_to.z);
  }
  out.put(static_cast<std::uint32_t>(of_block->placed.size()));
  for (const PlacedModel& p : of_block->placed)
    put_placed(p, registry, out);
  out.put(static_cast<std::uint32_t>(of_block->ground.size()));
  for (const auto& e : of_block->ground)
    put_ground(*e, out);
  return out.take();
}

core::Result<BlockEdits> decode_block(const World& world, const models::Registry& registry,
                                      core::BlockCoord block, std::span<const std::byte> bytes) {
  return BlockReader(world, registry, block, bytes).read();
}

core::Result<void> load_block(Edits& edits, const World& world, const models::Registry& registry,
                              core::BlockCoord block, std::span<const std::byte> bytes) {
  auto decoded = decode_block(world, registry, block, bytes);
  if (!decoded) return tl::unexpected(decoded.error());
  return edits.replace_block(world, block, std::move(*decoded));
}

}  // namespace psygen::world
