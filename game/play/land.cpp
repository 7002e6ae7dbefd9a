#include "game/play/land.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "engine/core/data_file.hpp"
#include "engine/core/hash.hpp"
#include "engine/world/files/world_file.hpp"
#include "game/play/cairn_type.hpp"

namespace cairns {
namespace {

constexpr const char* kFile = "worlds/cairns.toml";
constexpr std::string_view kSeedLine = "\nseed = ";

}  // namespace

std::uint64_t seed_of(std::string_view typed) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(typed.data(), typed.data() + typed.size(), number);
  if (error == std::errc() && end == typed.data() + typed.size()) return number;
  return core::hash_bytes(std::as_bytes(std::span(typed)));
}

core::Result<std::string> land_file() {
  const auto file = core::data_file(kFile);
  if (!file) return tl::unexpected(file.error());
  return file->string();
}

core::Result<std::string> land_text(std::uint64_t seed) {
  const auto file = land_file();
  if (!file) return tl::unexpected(file.error());
  std::ifstream in(*file);
  std::stringstream read;
  if (!(read << in.rdbuf()))
    return core::fail(core::ErrorCode::kIo, *file + ": the file cannot be read");
  std::string text = read.str();
  const std::size_t line = text.find(kSeedLine);
  if (line == std::string::npos)
    return core::fail(core::ErrorCode::kParse, *file + ": the line `seed = …` is missing");
  const std::size_t from = line + kSeedLine.size();
  const std::size_t end = std::min(text.find('\n', from), text.size());
  std::string changed = text.substr(0, from);
  changed += '"';
  changed += std::to_string(seed);
  changed += '"';
  return changed + text.substr(end);
}

core::Result<void> add_types(models::Registry& registry) {
  const auto added = registry.add(std::make_unique<CairnType>());
  if (!added) return tl::unexpected(added.error());
  return {};
}

core::Result<std::unique_ptr<Land>> Land::load(std::uint64_t seed) {
  auto text = land_text(seed);
  if (!text) return tl::unexpected(text.error());
  auto land = std::make_unique<Land>();
  land->registry = models::make_standard_registry();
  if (auto ok = add_types(land->registry); !ok) return tl::unexpected(ok.error());
  auto world = world::parse_world(*text, kFile, land->registry);
  if (!world) return tl::unexpected(world.error());
  land->world = std::move(*world);
  land->text = std::move(*text);
  return land;
}

glm::dvec3 way_m(const core::WorldPosition& from, const core::WorldPosition& to, double block_m) {
  return core::offset_m(to.block, from, block_m) + to.local;
}

double distance_m(const core::WorldPosition& from, const core::WorldPosition& to, double block_m) {
  const glm::dvec3 way = way_m(from, to, block_m);
  return std::hypot(way.x, way.z);
}

core::WorldPosition position_at_offset(const core::WorldPosition& from, const glm::dvec3& way,
                                       double block_m) {
  return core::normalised({from.block, from.local + way}, block_m);
}

}  // namespace cairns
