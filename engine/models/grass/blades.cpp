#include "engine/models/grass/blades.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/hash.hpp"

namespace psygen::models {
namespace {

// Stored colours of fresh and of dry blades. Their albedos have a mean of 1.
constexpr glm::vec3 kFresh{1.03F, 1.25F, 0.61F}, kDry{1.16F, 1.06F, 0.71F};
constexpr float kShake = 1.2F;  // random shift of tufts, over about half the distance between them
constexpr std::uint32_t kFirstTuft = 1U << 30;
constexpr float kMiddleWidth = 0.9F;  // width of a blade at its bend over that at its base
constexpr float kLowEdge = 0.45F;     // fraction of their height that blades at the border lack
constexpr float kStemHeight = 1.2F, kStemWidth = 0.5F;
constexpr float kHead = 1.3F;  // half of a flower's width over a blade's width

// Four random numbers in [0, 1) of one item of the patch.
struct Fractions {
  float f[4];
  Fractions(std::uint64_t key, std::uint32_t item) {
    const std::uint64_t h = core::mix64(key + 0x9E3779B97F4A7C15U * item);
    for (std::uint32_t i = 0; i < 4; ++i)
      f[i] = static_cast<float>(static_cast<std::int32_t>(h >> (16 * i) & 0xFFFFU)) *
             (1.0F / 65536.0F);
  }
};

// Returns a unit vector for `turn` in [0, 1), without sines. Its distribution is not quite uniform.
glm::vec2 direction(float turn) {
  const float quarter = std::floor(turn * 4), t = turn * 4 - quarter;
  const float scale = 1 / (1 + t * t);
  const glm::vec2 v{(1 - t * t) * scale, 2 * t * scale};
  if (quarter == 0) return v;
  if (quarter == 1) return {-v.y, v.x};
  if (quarter == 2) return {-v.x, -v.y};
  return {v.y, -v.x};
}

// Returns the position of tuft `k` in the unit disc. The additive recurrence of the plastic number
// fills a square evenly for any number of tufts. Points are mapped to the disc and shifted at
// random to hide rows.
glm::vec2 tuft_place(std::uint64_t key, std::uint32_t k, std::uint32_t count) {
  const auto coordinate = [](std::uint32_t v) {
    return static_cast<float>(static_cast<std::int32_t>(v)) * 0x1.0p-31F;
  };
  const float x = coordinate(static_cast<std::uint32_t>(key) + k * 0xC13FA9A9U);
  const float y = coordinate(static_cast<std::uint32_t>(key >> 32) + k * 0x91E10DA5U);
  const glm::vec2 even{x * std::sqrt(1 - 0.5F * y * y), y * std::sqrt(1 - 0.5F * x * x)};
  const float shake = std::min(kShake / std::sqrt(static_cast<float>(count)), 0.5F);
  const Fractions random(key, kFirstTuft + k);
  return even * (1 - shake) + direction(random.f[0]) * (shake * random.f[1]);
}

}  // namespace

GrassBlade blade_of(const GrassPatch& patch, std::uint32_t number) {
  const bool is_stem = number >= kFirstStem;
  const Fractions a(patch.key, 2 * number + 1), b(patch.key, 2 * number + 2);
  const glm::vec2 tuft = tuft_place(patch.key, number % patch.tufts, patch.tufts);
  const float border = std::min(glm::dot(tuft, tuft), 1.0F);
  const glm::vec2 bend = direction(a.f[0]);
  const float high = patch.height * (1 - kLowEdge * border) * (0.6F + 0.4F * a.f[1]);

  GrassBlade blade;
  blade.bend = bend;
  // Blades lean away from the middle of their tuft.
  const glm::vec2 at = tuft * patch.radius + bend * (kTuftSpread * patch.height * a.f[2]);
  const float ground = glm::dot(at, patch.slope);
  const float height = is_stem ? high * kStemHeight : high;
  const glm::vec2 lean = bend * (patch.lean * high * (is_stem ? 0.3F : 0.25F + 0.75F * a.f[3]));
  const glm::vec2 middle = at + lean * kBendShift, tip = at + lean;
  blade.foot = {at.x, ground - foot_depth(patch), at.y};
  blade.middle = {middle.x, ground + kBendHeight * height, middle.y};
  blade.tip = {tip.x, ground + height, tip.y};
  const float half = 0.5F * patch.width * (is_stem ? kStemWidth : 0.75F + 0.25F * b.f[0]);
  blade.across = {-bend.y * half, bend.x * half};
  const float dry = std::clamp(patch.dryness + 0.3F * (b.f[1] - 0.5F), 0.0F, 1.0F);
  blade.colour = (kFresh + (kDry - kFresh) * dry) * (patch.brightness * (0.86F + 0.28F * b.f[2]));
  blade.sway = std::min(1.1F * height, 1.0F);
  return blade;
}

GrassWriter::GrassWriter(const GrassPatch& patch, const core::Bounds& box, const MeshView& out)
    : patch_(patch), packer_(box), out_(out), up_(-patch.slope.x, 1, -patch.slope.y) {}

void GrassWriter::add(const Point& point) {
  core::ModelVertex v{};
  packer_.pack(point.place, v.position);
  const glm::vec2 e = encode_octahedral(point.normal);
  v.normal[0] = pack_snorm16(e.x);
  v.normal[1] = pack_snorm16(e.y);
  v.ambient = pack_unorm8(point.ambient);
  v.sway = pack_unorm8(point.sway);
  for (int i = 0; i < 3; ++i)
    v.colour[i] = pack_unorm8(point.colour[i]);
  v.material = 1;
  std::memcpy(out_.vertices.data() + vertices_++ * sizeof v, &v, sizeof v);
  tight_ = {glm::min(tight_.min, point.place), glm::max(tight_.max, point.place)};
}

void GrassWriter::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  for (const std::uint32_t i : {a, b, c})
    out_.indices[indices_++] = static_cast<std::uint16_t>(i);
}

// Normals are close to the ground's, so blades are lit like the ground. Towards the tip they turn
// with the bend.
GrassWriter::Point GrassWriter::at_foot(const GrassBlade& blade, float side) const {
  const glm::vec2 w = blade.across * side;
  return {blade.foot + glm::vec3(w.x, 0, w.y), up_, blade.colour * 0.85F, 0.55F, 0};
}

GrassWriter::Point GrassWriter::at_middle(const GrassBlade& blade, float side) const {
  const glm::vec2 w = blade.across * (side * kMiddleWidth);
  const glm::vec3 normal = up_ + glm::vec3(blade.bend.x, 0, blade.bend.y) * 0.25F;
  return {blade.middle + glm::vec3(w.x, 0, w.y), normal, blade.colour, 0.9F, 0.3F * blade.sway};
}

GrassWriter::Point GrassWriter::at_tip(const GrassBlade& blade) const {
  const glm::vec3 normal = up_ + glm::vec3(blade.bend.x, 0, blade.bend.y) * 0.4F;
  return {blade.tip, normal, blade.colour * 1.05F, 1, blade.sway};
}

void GrassWriter::add_blade(const GrassBlade& blade) {
  const std::uint32_t first = vertices_;
  add(at_foot(blade, 1));
  add(at_foot(blade, -1));
  add(at_middle(blade, 1));
  add(at_middle(blade, -1));
  add(at_tip(blade));
  add_triangle(first, first + 1, first + 2);
  add_triangle(first + 2, first + 1, first + 3);
  add_triangle(first + 2, first + 3, first + 4);
}

void GrassWriter::add_coarse_blade(const GrassBlade& blade, float broader) {
  const std::uint32_t first = vertices_;
  add(at_foot(blade, broader));
  add(at_foot(blade, -broader));
  add(at_tip(blade));
  add_triangle(first, first + 1, first + 2);
}

// Four petals that form a shallow cup.
void GrassWriter::add_flower(const GrassBlade& stem) {
  add_blade(stem);
  const std::uint32_t first = vertices_;
  Point point = at_tip(stem);
  const float half = kHead * patch_.width;
  const glm::vec2 x = stem.bend * half, y{-x.y, x.x};
  point.colour = patch_.petals * 0.85F;
  add(point);
  point.colour = patch_.petals;
  for (const glm::vec2 at : {x, y, -x, -y}) {
    point.place = stem.tip + glm::vec3(at.x, 0.45F * half, at.y);
    add(point);
  }
  for (std::uint32_t i = 0; i < 4; ++i)
    add_triangle(first, first + 1 + (i + 1) % 4, first + 1 + i);
}

void GrassWriter::add_coarse_flower(const GrassBlade& stem, float larger) {
  const std::uint32_t first = vertices_;
  Point point = at_tip(stem);
  const float half = kHead * patch_.width * larger;
  const glm::vec2 x = stem.bend * half, y{-x.y, x.x};
  point.colour = patch_.petals;
  for (const glm::vec2 at : {x, y, -x - y}) {
    point.place = stem.tip + glm::vec3(at.x, 0.45F * half, at.y);
    add(point);
  }
  add_triangle(first, first + 2, first + 1);
}

}  // namespace psygen::models
