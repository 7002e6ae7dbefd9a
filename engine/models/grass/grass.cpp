// Results have the same bits on every CPU: single precision, and no library function but the square
// root. No allocation.
#include "engine/models/grass/grass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"
#include "engine/models/kit/packing.hpp"

namespace psygen::models {
namespace {

constexpr int kLevels = 4;

// Sizes at level 0 of a blade, and of a flower with its stem.
constexpr std::uint32_t kBladeVertices = 5, kBladeTriangles = 3;
constexpr std::uint32_t kFlowerVertices = kBladeVertices + 5;
constexpr std::uint32_t kFlowerTriangles = kBladeTriangles + 4;
// Blade numbers from here on are the stems of flowers.
constexpr std::uint32_t kFirstStem = 1U << 20;
// Largest distance of a blade's base from its tuft's middle, relative to the patch's height.
constexpr float kTuftSpread = 0.22F;
constexpr float kBendHeight = 0.55F;  // height of the bend, relative to the blade's height
constexpr float kBendShift = 0.25F;   // lean at the bend, relative to the lean of the tip
constexpr float kBroadBlade = 1.3F;   // width of a one-triangle blade over a blade's own

// The numbers of one patch, in metres. Colours are square roots of albedos, as vertices store them.
struct GrassPatch {
  std::uint64_t key = 0;    // of all random numbers of the patch
  glm::vec2 slope{0.0F};    // rise of the ground per metre along x and z
  std::uint32_t tufts = 1;  // one for every eight blades, rounded up
  // `height` is the height of the highest blades, `width` a blade's width at its base, `lean` the
  // shift of a tip over its blade's height.
  float radius = 0, height = 0, width = 0, lean = 0;
  float brightness = 0, dryness = 0;  // square root of the mean albedo; 0 green … 1 straw
  glm::vec3 petals{0.0F};
};

// Metres by which blades extend below the sloping plane, so that curved ground shows no gaps.
float foot_depth(const GrassPatch& patch) {
  return 0.15F * patch.height + 0.06F * patch.radius;
}

// One blade or stem, in metres from the patch's middle.
struct GrassBlade {
  glm::vec3 foot{0.0F}, middle{0.0F}, tip{0.0F};
  glm::vec2 across{0.0F};  // half of its width at the base, along x and z
  glm::vec2 bend{0.0F};    // unit vector in x and z, in the direction of the lean
  glm::vec3 colour{0.0F};  // stored colour (GrassPatch)
  float sway = 0;          // at the tip, 0 … 1
};

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

// Returns blade `number` of the patch, or stem `number` − kFirstStem of a flower. Depends on
// nothing else, so all levels have the same blades.
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

// Appends blades and flowers to a mesh. The caller has checked that `out` has room for all of them.
class GrassWriter {
 public:
  // Positions are packed in `box`. `patch` and the memory of `out` must outlive the writer.
  GrassWriter(const GrassPatch& patch, const core::Bounds& box, const MeshView& out)
      : patch_(patch), packer_(box), out_(out), up_(-patch.slope.x, 1, -patch.slope.y) {}

  // Level 0 has whole blades, and flowers with their stems. Coarser levels have one triangle of
  // three vertices each: a blade `broader` times as wide, or a flower's head `larger` times as
  // wide.
  void add_blade(const GrassBlade& blade) {
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
  void add_coarse_blade(const GrassBlade& blade, float broader) {
    const std::uint32_t first = vertices_;
    add(at_foot(blade, broader));
    add(at_foot(blade, -broader));
    add(at_tip(blade));
    add_triangle(first, first + 1, first + 2);
  }
  // Four petals that form a shallow cup.
  void add_flower(const GrassBlade& stem) {
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
  void add_coarse_flower(const GrassBlade& stem, float larger) {
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
  // Box of the vertices added so far, in metres; empty (min > max) before the first.
  core::Bounds tight() const { return tight_; }

 private:
  struct Point {
    glm::vec3 place, normal, colour;
    float ambient, sway;
  };
  // Normals are close to the ground's, so blades are lit like the ground. Towards the tip they turn
  // with the bend.
  Point at_foot(const GrassBlade& blade, float side) const {
    const glm::vec2 w = blade.across * side;
    return {blade.foot + glm::vec3(w.x, 0, w.y), up_, blade.colour * 0.85F, 0.55F, 0};
  }
  Point at_middle(const GrassBlade& blade, float side) const {
    const glm::vec2 w = blade.across * (side * kMiddleWidth);
    const glm::vec3 normal = up_ + glm::vec3(blade.bend.x, 0, blade.bend.y) * 0.25F;
    return {blade.middle + glm::vec3(w.x, 0, w.y), normal, blade.colour, 0.9F, 0.3F * blade.sway};
  }
  Point at_tip(const GrassBlade& blade) const {
    const glm::vec3 normal = up_ + glm::vec3(blade.bend.x, 0, blade.bend.y) * 0.4F;
    return {blade.tip, normal, blade.colour * 1.05F, 1, blade.sway};
  }
  void add(const Point& point) {
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
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t i : {a, b, c})
      out_.indices[indices_++] = static_cast<std::uint16_t>(i);
  }

  const GrassPatch& patch_;
  BoxPacker packer_;
  MeshView out_;
  glm::vec3 up_;  // normal of the ground
  std::uint32_t vertices_ = 0, indices_ = 0;
  core::Bounds tight_{glm::vec3(1e9F), glm::vec3(-1e9F)};
};

std::uint32_t blades_of(const Parameters& p) {
  return static_cast<std::uint32_t>(p.integer(kGrassBlades));
}
std::uint32_t flowers_of(const Parameters& p) {
  return static_cast<std::uint32_t>(p.integer(kGrassFlowers));
}
// Number of blades or flowers of `all` that a level keeps.
std::uint32_t left(std::uint32_t all, int level) {
  const std::uint32_t each = level < 2 ? 1 : level == 2 ? 3 : 9;
  return (all + each - 1) / each;
}

GrassPatch patch_of(const Parameters& p) {
  GrassPatch patch;
  patch.key = core::mix64(static_cast<std::uint64_t>(p.integer(kGrassSeed)));
  patch.slope = {p.real(kGrassSlopeX), p.real(kGrassSlopeZ)};
  patch.tufts = (blades_of(p) + 7) / 8;
  patch.radius = static_cast<float>(p.real(kGrassRadiusM));
  patch.height = static_cast<float>(p.real(kGrassHeightM));
  patch.width = static_cast<float>(p.real(kGrassWidthM));
  patch.lean = static_cast<float>(p.real(kGrassLean));
  patch.brightness = std::sqrt(static_cast<float>(p.real(kGrassAlbedo)));
  patch.dryness = static_cast<float>(p.real(kGrassDryness));
  constexpr std::array<glm::vec3, kFlowerCount> kPetals{
      {{0.90F, 0.90F, 0.86F}, {0.90F, 0.76F, 0.16F}, {0.72F, 0.42F, 0.62F}, {0.38F, 0.42F, 0.78F}}};
  patch.petals = kPetals[static_cast<std::size_t>(p.integer(kGrassFlower))];
  return patch;
}

class GrassType final : public ModelType {
 public:
  std::string_view name() const override { return "grass"; }
  std::string_view doc() const override {
    return "patch of grass: tufts of blades, 3 triangles each, and flowers";
  }
  std::span<const ParameterSpec> parameters() const override { return kGrassSchema; }
  int level_count() const override { return kLevels; }
  int level_count_of(const Parameters& p) const override {
    const std::uint32_t most = std::max(blades_of(p), flowers_of(p));
    return most == 1 ? 2 : most <= 3 ? 3 : kLevels;
  }
  bool is_seen_from_far() const override { return false; }
  double seen_size_m(const Parameters& p) const override { return 0.5 * p.real(kGrassHeightM); }
  double level_error_m(const Parameters& p, int level) const override;
  core::Bounds bounds(const Parameters& p) const override;
  MeshSize mesh_size(const Parameters& p, int level) const override;
  bool may_run_on_main_thread() const override { return true; }
  double step_seconds() const override { return 40e-9; }
  double complexity(const Parameters& p, int level) const override {
    return 0.2 * mesh_size(p, level).vertex_count;
  }
  double log2_cost(const Parameters& p) const override {
    const auto blades = std::max(static_cast<double>(p.integer(kGrassBlades)), 1.0);
    const auto flowers = std::max(static_cast<double>(p.integer(kGrassFlowers)), 0.0);
    return std::log2(kBladeTriangles * blades + kFlowerTriangles * flowers);
  }
  core::Bounds synthesise(const Parameters& p, int level, const MeshView& out) const override;
};

// Level 1 omits the bends, level 2 most blades of a tuft, level 3 whole tufts.
double GrassType::level_error_m(const Parameters& p, int level) const {
  const int at = std::min(level, level_count_of(p) - 1);
  if (at == 0) return 0;
  const double height = p.real(kGrassHeightM), width = p.real(kGrassWidthM);
  const double depth = static_cast<double>(foot_depth(patch_of(p)));
  const double middle = (kBendHeight * height + depth) / (height + depth) - kBendShift;
  const double bend = middle * height * p.real(kGrassLean) + 0.5 * width;
  if (at == 1) return bend;
  const double tuft = bend + kTuftSpread * height + 0.5 * width;
  if (at == 2) return tuft;
  return tuft + p.real(kGrassRadiusM) / std::sqrt(static_cast<double>(left(blades_of(p), at)));
}

core::Bounds GrassType::bounds(const Parameters& p) const {
  const GrassPatch patch = patch_of(p);
  // Blades of level 3 are up to 9 times as wide.
  const float broadest = kBroadBlade * 9 * patch.width;
  const float feet = patch.radius + 1.5F * kTuftSpread * patch.height;
  const float aside = (feet + patch.lean * patch.height + broadest) * 1.001F;
  const float rise = (std::abs(patch.slope.x) + std::abs(patch.slope.y)) * feet;
  const float up = (rise + 1.3F * patch.height + broadest) * 1.001F;
  return {{-aside, -1.001F * (rise + foot_depth(patch)), -aside}, {aside, up, aside}};
}

MeshSize GrassType::mesh_size(const Parameters& p, int level) const {
  const std::uint32_t blades = left(blades_of(p), level), flowers = left(flowers_of(p), level);
  if (level == 0)
    return {kBladeVertices * blades + kFlowerVertices * flowers,
            3 * (kBladeTriangles * blades + kFlowerTriangles * flowers)};
  return {3 * (blades + flowers), 3 * (blades + flowers)};
}

core::Bounds GrassType::synthesise(const Parameters& p, int level, const MeshView& out) const {
  const core::RoundToNearest rounding;
  const MeshSize size = mesh_size(p, level);
  PSYGEN_CHECK(out.vertices.size() == size.vertex_count * sizeof(core::ModelVertex) &&
                   out.indices.size() == size.index_count,
               "the destination has exactly the size of the mesh");
  const GrassPatch patch = patch_of(p);
  GrassWriter writer(patch, bounds(p), out);
  const std::uint32_t blades = left(blades_of(p), level), flowers = left(flowers_of(p), level);
  const float broader = static_cast<float>(blades_of(p)) / static_cast<float>(blades);
  for (std::uint32_t i = 0; i < blades; ++i) {
    if (level == 0)
      writer.add_blade(blade_of(patch, i));
    else
      writer.add_coarse_blade(blade_of(patch, i), kBroadBlade * broader);
  }
  const float larger =
      std::sqrt(static_cast<float>(flowers_of(p)) / static_cast<float>(std::max(flowers, 1U)));
  for (std::uint32_t i = 0; i < flowers; ++i) {
    const GrassBlade stem = blade_of(patch, kFirstStem + i);
    if (level == 0)
      writer.add_flower(stem);
    else
      writer.add_coarse_flower(stem, larger);
  }
  return writer.tight();
}

}  // namespace

std::unique_ptr<ModelType> make_grass_type() {
  return std::make_unique<GrassType>();
}

}  // namespace psygen::models
