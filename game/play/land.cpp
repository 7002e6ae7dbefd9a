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

// Value noise with one knot per integer, 0 to 1.
double noise(std::uint64_t seed, double at) {
  const double knot = std::floor(at);
  const auto value = [&](double k) {
    const std::uint64_t number = static_cast<std::uint64_t>(static_cast<std::int64_t>(k));
    return static_cast<double>(psygen::core::combine(seed, number) >> 11) * 0x1.0p-53;
  };
  const double t = at - knot, s = t * t * (3 - 2 * t);
  return std::lerp(value(knot), value(knot + 1), s);
}

// Linear ramp: 0 up to `from`, 1 from `to` on.
double ramp(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

}  // namespace

std::uint64_t seed_of(std::string_view typed) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(typed.data(), typed.data() + typed.size(), number);
  if (error == std::errc() && end == typed.data() + typed.size()) return number;
  return core::hash_bytes(std::as_bytes(std::span(typed)));
}

core::Result<std::string> land_file() {
  return core::data_file(kFile).map([](const auto& file) { return file.string(); });
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
  return text.replace(from, end - from, '"' + std::to_string(seed) + '"');
}

core::Result<void> add_types(models::Registry& registry) {
  return registry.add(make_cairn_type()).map([](models::ModelIndex) {});
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

Weather weather_at(std::uint64_t seed, double time_s) {
  // Every game starts in fair weather.
  const double calm = ramp(time_s, 120, 420);
  const double foul = calm * noise(seed ^ 1, time_s / 260);
  Weather now;
  now.clouds = std::lerp(0.2 + 0.25 * noise(seed ^ 2, time_s / 180), 1.0, ramp(foul, 0.45, 0.75));
  now.wet = ramp(foul, 0.66, 0.9);
  now.fog = std::max(0.45 * now.wet, calm * ramp(noise(seed ^ 3, time_s / 330), 0.72, 0.95));
  const double speed = 1.5 + 7 * foul, from = 6.28 * noise(seed ^ 4, time_s / 700);
  now.wind = {speed * std::cos(from), 0, speed * std::sin(from)};
  return now;
}

}  // namespace cairns
