#include "engine/world/placement.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include "engine/models/terrain.hpp"

namespace psygen::world {
namespace {

// An instance that still looks for a place.
struct Candidate {
  std::uint32_t index = 0;
  const Scatter* scatter = nullptr;
  core::RandomStream position;
  glm::dvec2 at{0.0};
  models::GroundPoint ground;
  bool placed = false;
};

// A coordinate that is a float and inside of the block, so that the height is that of the very
// point that is handed out.
double draw_coordinate(core::RandomStream& random, float block_size_m) {
  const auto drawn = static_cast<float>(random.next_unit() * static_cast<double>(block_size_m));
  return static_cast<double>(drawn < block_size_m ? drawn : std::nextafter(block_size_m, 0.0F));
}

bool may_stand(const Scatter& scatter, const models::GroundPoint& ground) {
  return ground.height_m >= scatter.min_height_m && ground.height_m <= scatter.max_height_m &&
         ground.normal.y >= static_cast<float>(std::cos(glm::radians(scatter.max_slope_deg)));
}

std::vector<Candidate> all_candidates(const World& world, core::BlockCoord block) {
  std::vector<Candidate> candidates;
  candidates.reserve(models_per_block(world));
  std::uint32_t index = 0;
  for (const Scatter& scatter : world.scatter) {
    for (std::uint32_t k = 0; k < scatter.count; ++k, ++index) {
      candidates.push_back({index,
                            &scatter,
                            {world.seed, block.x, block.z, index, core::Purpose::kPosition},
                            {},
                            {},
                            false});
    }
  }
  return candidates;
}

// One try of everything that has no place yet. Returns how many still have none.
std::size_t try_places(const World& world, core::BlockCoord block,
                       std::vector<Candidate>& candidates) {
  const auto size_m = static_cast<float>(world.block_size_m());
  std::vector<glm::dvec2> points;
  for (Candidate& c : candidates) {
    if (c.placed) continue;
    c.at.x = draw_coordinate(c.position, size_m);
    c.at.y = draw_coordinate(c.position, size_m);
    points.push_back(c.at);
  }
  std::vector<models::GroundPoint> ground(points.size());
  models::sample_ground(world.terrain, block, points, ground);
  std::size_t next = 0, homeless = 0;
  for (Candidate& c : candidates) {
    if (c.placed) continue;
    c.ground = ground[next++];
    c.placed = !c.scatter->has_filter() || may_stand(*c.scatter, c.ground);
    homeless += c.placed ? 0 : 1;
  }
  return homeless;
}

}  // namespace

models::Parameters terrain_parameters(const World& world, core::BlockCoord block) {
  models::Parameters p = world.terrain;
  p.set_integer(models::kTerrainSeed, std::bit_cast<std::int64_t>(world.seed));
  p.set_integer(models::kTerrainBlockX, block.x);
  p.set_integer(models::kTerrainBlockZ, block.z);
  return p;
}

std::size_t models_per_block(const World& world) {
  std::size_t count = 0;
  for (const Scatter& scatter : world.scatter)
    count += scatter.count;
  return count;
}

void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  std::vector<Placement>& out) {
  std::vector<Candidate> candidates = all_candidates(world, block);
  for (int i = 0; i < kPlacementTries && !candidates.empty(); ++i) {
    if (try_places(world, block, candidates) == 0) break;
  }
  out.clear();
  for (const Candidate& c : candidates) {
    if (!c.placed) continue;
    out.push_back({c.scatter->model, c.index, glm::vec3(c.at.x, c.ground.height_m, c.at.y),
                   draw_parameters(world, registry, *c.scatter, block, c.index)});
  }
}

void set_parameter(const models::ModelType& type, models::Parameters& parameters, std::size_t i,
                   double value) {
  if (type.parameters()[i].type == models::ParameterType::kInteger) {
    // Not 2^63 itself, which no integer of 64 bits holds.
    parameters.set_integer(i, std::llround(std::clamp(value, -0x1.0p63, 0x1.fffffffffffffp62)));
  } else {
    parameters.set_real(i, value);
  }
}

models::Parameters scatter_parameters(const models::Registry& registry, const Scatter& scatter) {
  const models::ModelType& type = registry[scatter.model];
  models::Parameters p = models::default_parameters(type);
  for (std::size_t i = 0; i < scatter.ranges.size(); ++i) {
    if (type.parameters()[i].source == models::ParameterSource::kUser)
      set_parameter(type, p, i, scatter.ranges[i].low);
  }
  return p;
}

models::Parameters draw_parameters(const World& world, const models::Registry& registry,
                                   const Scatter& scatter, core::BlockCoord block,
                                   std::uint32_t index) {
  const auto specs = registry[scatter.model].parameters();
  models::Parameters p = models::default_parameters(registry[scatter.model]);
  core::RandomStream values(world.seed, block.x, block.z, index, core::Purpose::kParameters);
  core::RandomStream seeds(world.seed, block.x, block.z, index, core::Purpose::kSeed);
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const ParameterRange& range = scatter.ranges[i];
    if (specs[i].source == models::ParameterSource::kPlaced) {
      if (specs[i].name == "seed") p.set_integer(i, std::bit_cast<std::int64_t>(seeds.next_u64()));
    } else if (specs[i].type == models::ParameterType::kInteger) {
      p.set_integer(i, values.next_integer(std::llround(range.low), std::llround(range.high)));
    } else {
      // One number for each parameter, so that a changed range leaves the others as they are.
      const double drawn = values.next_real(range.low, range.high);
      p.set_real(i, range.low == range.high ? range.low : std::min(drawn, range.high));
    }
  }
  return p;
}

}  // namespace psygen::world
