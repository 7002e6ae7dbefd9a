#include "game/play/cairn_type.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/core/hash.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/kit/packing.hpp"

namespace cairns {
namespace {

constexpr models::ParameterSpec kSchema[] = {
    models::placed(models::integer_parameter("seed", "", 1, models::HardRange{-0x1p63, 0x1p63},
                                             models::SoftRange{0, 1000}, "Random seed")),
    models::integer_parameter("stones", "1", 7, models::HardRange{1, 24}, models::SoftRange{3, 12},
                              "Number of stones in the stack"),
    models::real_parameter("width_m", "m", 1.1, models::HardRange{0.1, 6},
                           models::SoftRange{0.4, 2}, "Width of the lowest stone"),
};

// Per LOD level: corners around a stone, and rings between its poles.
constexpr std::array<std::uint32_t, 3> kStoneSides{11, 8, 5}, kStoneRings{5, 3, 2};
constexpr float kFlatness = 0.42F;  // ratio of a stone's height to its width
constexpr float kTopShare = 0.34F;  // ratio of the top stone's width to the lowest stone's
constexpr float kSunkShare = 0.3F;  // fraction of the lowest stone below the ground
constexpr float kRough = 0.12F;

struct Stone {
  glm::vec3 middle;
  float radius;  // half its width
};

std::uint32_t stones_of(const models::Parameters& p) {
  return static_cast<std::uint32_t>(p.integer(kCairnStones));
}

// Returns stone `i`, and raises `foot_m` to the base of the next one.
Stone stone(const models::Parameters& p, std::uint32_t i, float& foot_m) {
  core::RandomStream random(static_cast<std::uint64_t>(p.integer(kCairnSeed)), 0, 0, i,
                            core::Purpose::kStructure);
  const float share = static_cast<float>(i) / static_cast<float>(std::max(stones_of(p), 2U) - 1);
  const auto wild = static_cast<float>(random.next_real(0.86, 1.06));
  const float radius =
      0.5F * static_cast<float>(p.real(kCairnWidthM)) * std::lerp(1.0F, kTopShare, share) * wild;
  const float half_height = kFlatness * radius;
  if (i == 0) foot_m = -2 * half_height * kSunkShare;
  const auto aside = [&] { return static_cast<float>(random.next_real(-0.12, 0.12)) * radius; };
  const Stone made{{aside(), foot_m + half_height, aside()}, radius};
  foot_m += 1.86F * half_height;
  return made;
}

float sine(double degrees) {
  return static_cast<float>(models::exact_sin_degrees(degrees));
}
float cosine(double degrees) {
  return static_cast<float>(models::exact_cos_degrees(degrees));
}

// Returns a point of a stone's rough surface, which is the same at every LOD level. Angles are in
// degrees: around the vertical axis, and up from the equator.
glm::vec3 surface_point(const Stone& s, std::uint32_t number, double around, double up) {
  const float bump = kRough * sine(3 * around + 97 * number) * cosine(2.3 * up + 57 * number);
  const float r = s.radius * (1 + bump);
  // The poles are flatter than an ellipsoid's.
  const float c = std::sqrt(std::max(cosine(up), 0.0F));
  return s.middle + r * glm::vec3(c * cosine(around), kFlatness * sine(up), c * sine(around));
}

// Writes the vertices and triangles of stones.
class StoneWriter {
 public:
  StoneWriter(const core::Bounds& box, const models::MeshView& out, int level)
      : packer_(box),
        vertices_(reinterpret_cast<core::ModelVertex*>(out.vertices.data())),
        indices_(out.indices.data()),
        sides_(kStoneSides[static_cast<std::size_t>(level)]),
        rings_(kStoneRings[static_cast<std::size_t>(level)]) {}

  void write(const Stone& s, std::uint32_t number, float grey, core::Bounds& tight) {
    const std::uint32_t first = vertex_;
    for (std::uint32_t ring = 0; ring <= rings_ + 1; ++ring) {
      const bool pole = ring == 0 || ring == rings_ + 1;
      const double up = 180.0 * ring / (rings_ + 1) - 90;
      for (std::uint32_t side = 0; side < (pole ? 1 : sides_); ++side) {
        const double around = 360.0 * side / sides_;
        const glm::vec3 at = surface_point(s, number, around, up);
        tight = {glm::min(tight.min, at), glm::max(tight.max, at)};
        add_vertex(at, (at - s.middle) * glm::vec3(1, 1 / (kFlatness * kFlatness), 1), grey,
                   sine(up));
      }
    }
    for (std::uint32_t side = 0; side < sides_; ++side)
      add_column(first, side, (side + 1) % sides_);
  }

 private:
  void add_vertex(const glm::vec3& at, const glm::vec3& normal, float grey, float up) {
    core::ModelVertex vertex{};
    packer_.pack(at, vertex.position);
    const glm::vec2 n = models::encode_octahedral(normal);
    vertex.normal[0] = models::pack_snorm16(n.x);
    vertex.normal[1] = models::pack_snorm16(n.y);
    vertex.ambient = static_cast<std::uint8_t>(up < -0.3F ? 110 : up < 0.3F ? 190 : 250);
    const glm::vec3 colour = grey * glm::vec3(1.0F, 0.95F, 0.87F);
    for (int i = 0; i < 3; ++i)
      vertex.colour[i] = models::pack_albedo(colour[i]);
    vertices_[vertex_++] = vertex;
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t corner : {a, b, c})
      indices_[index_++] = static_cast<std::uint16_t>(corner);
  }
  // Adds the triangles between two neighbouring sides, from pole to pole.
  void add_column(std::uint32_t first, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t ring0 = first + 1, top = first + 1 + rings_ * sides_;
    add_triangle(first, ring0 + a, ring0 + b);
    for (std::uint32_t ring = 0; ring + 1 < rings_; ++ring) {
      const std::uint32_t low = ring0 + ring * sides_, high = low + sides_;
      add_triangle(low + a, high + a, high + b);
      add_triangle(low + a, high + b, low + b);
    }
    const std::uint32_t last = ring0 + (rings_ - 1) * sides_;
    add_triangle(last + a, top, last + b);
  }

  models::BoxPacker packer_;
  core::ModelVertex* vertices_;
  std::uint16_t* indices_;
  std::uint32_t sides_, rings_, vertex_ = 0;
  std::size_t index_ = 0;
};

class CairnType final : public models::ModelType {
 public:
  std::string_view name() const override { return kCairnType; }
  std::string_view doc() const override { return "A stack of stones that marks a place"; }
  std::span<const models::ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return 3; }
  core::SurfaceKind surface() const override { return core::SurfaceKind::kStone; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const models::Parameters& p, int level) const override {
    constexpr std::array<double, 3> kShares{0, 0.03, 0.09};
    return kShares[static_cast<std::size_t>(level)] * p.real(kCairnWidthM);
  }

  core::Bounds bounds(const models::Parameters& p) const override {
    const auto width = static_cast<float>(p.real(kCairnWidthM));
    const float aside = 0.8F * width;
    return {{-aside, -0.2F * width, -aside},
            {aside, 0.5F * width * static_cast<float>(stones_of(p)), aside}};
  }

  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    const std::uint32_t sides = kStoneSides[static_cast<std::size_t>(level)];
    const std::uint32_t rings = kStoneRings[static_cast<std::size_t>(level)];
    return {stones_of(p) * (2 + rings * sides), stones_of(p) * 6 * rings * sides, 0,
            core::VertexLayout::kModel};
  }

  double complexity(const models::Parameters& p, int level) const override {
    return mesh_size(p, level).triangle_count();
  }

  double log2_cost(const models::Parameters& p) const override {
    const double stones = std::max(1.0, static_cast<double>(p.integer(kCairnStones)));
    return std::log2(2.0 * kStoneSides[0] * kStoneRings[0] * stones);
  }

  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    StoneWriter writer(bounds(p), out, level);
    core::Bounds tight{glm::vec3(1e9F), glm::vec3(-1e9F)};
    float foot_m = 0;
    for (std::uint32_t i = 0; i < stones_of(p); ++i) {
      core::RandomStream random(static_cast<std::uint64_t>(p.integer(kCairnSeed)), 0, 0, i,
                                core::Purpose::kColour);
      writer.write(stone(p, i, foot_m), i, static_cast<float>(random.next_real(0.13, 0.27)), tight);
    }
    return tight;
  }

  models::Collider collider(const models::Parameters& p) const override {
    models::Collider made;
    float foot_m = 0;
    Stone first{}, last{};
    for (std::uint32_t i = 0; i < stones_of(p); ++i) {
      last = stone(p, i, foot_m);
      if (i == 0) first = last;
    }
    const float radius = 0.7F * first.radius;
    made.shapes.emplace_back(models::Collider::Capsule{
        {0, 0, 0}, {0, std::max(last.middle.y - radius, 0.05F), 0}, radius});
    return made;
  }
};

}  // namespace

std::unique_ptr<models::ModelType> make_cairn_type() {
  return std::make_unique<CairnType>();
}

}  // namespace cairns
