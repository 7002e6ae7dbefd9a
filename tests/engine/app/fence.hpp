// A model type as users write one; docs/add-a-model.md quotes it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "engine/core/hash.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/model_type.hpp"

namespace my_game {

using namespace psygen;

enum FenceParameter : std::size_t { kSeed, kPosts, kSpacingM, kHeightM };

constexpr models::ParameterSpec kFenceSchema[] = {
    models::placed(models::integer_parameter("seed", "", 1, models::HardRange{-0x1p63, 0x1p63},
                                             models::SoftRange{0, 1000},
                                             "selects one of all fences")),
    models::integer_parameter("posts", "1", 8, models::HardRange{2, 64}, models::SoftRange{2, 24},
                              "number of posts"),
    models::real_parameter("spacing_m", "m", 1.5, models::HardRange{0.2, 10},
                           models::SoftRange{0.5, 3}, "from post to post"),
    models::real_parameter("height_m", "m", 1.2, models::HardRange{0.2, 5},
                           models::SoftRange{0.6, 2}, "of the posts"),
};

// Writes boxes into the spans of one mesh.
class BoxWriter {
 public:
  BoxWriter(const core::Bounds& space, const models::MeshView& out) : packer_(space), out_(out) {}

  void add(const core::Bounds& box, float albedo) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0F, 1.0F}) {
        glm::vec3 normal(0.0F), u(0.0F), v(0.0F);
        normal[axis] = side;
        u[(axis + 1) % 3] = side;
        v[(axis + 2) % 3] = 1.0F;
        const std::uint16_t first = vertices_;
        for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
          add_vertex(box.centre() + box.half_extent() * (normal + u * corner.x + v * corner.y),
                     normal, albedo);
        for (const int i : {0, 1, 2, 0, 2, 3})
          out_.indices[indices_++] = static_cast<std::uint16_t>(first + i);
      }
    }
    tight_.min = glm::min(tight_.min, box.min);
    tight_.max = glm::max(tight_.max, box.max);
  }
  core::Bounds tight() const { return tight_; }

 private:
  void add_vertex(const glm::vec3& position, const glm::vec3& normal, float albedo) {
    core::ModelVertex vertex{};
    packer_.pack(position, vertex.position);
    vertex.ambient = 255;
    const glm::vec2 n = models::encode_octahedral(normal);
    vertex.normal[0] = models::pack_snorm16(n.x);
    vertex.normal[1] = models::pack_snorm16(n.y);
    for (std::uint8_t& channel : vertex.colour)
      channel = models::pack_albedo(albedo);
    reinterpret_cast<core::ModelVertex*>(out_.vertices.data())[vertices_++] = vertex;
  }

  models::BoxPacker packer_;
  models::MeshView out_;
  core::Bounds tight_{glm::vec3(1e9F), glm::vec3(-1e9F)};
  std::uint16_t vertices_ = 0;
  std::size_t indices_ = 0;
};

class FenceType final : public models::ModelType {
 public:
  std::string_view name() const override { return "fence"; }
  std::string_view doc() const override { return "posts of different heights and two rails"; }
  std::span<const models::ParameterSpec> parameters() const override { return kFenceSchema; }

  // Level 0 has every post and the rails, level 1 the rails alone.
  int level_count() const override { return 2; }
  double level_error_m(const models::Parameters& p, int level) const override {
    return level == 0 ? 0.0 : 0.25 * p.real(kHeightM);
  }

  core::Bounds bounds(const models::Parameters& p) const override {
    const float half = half_length(p) + kThickness;
    return {{-half, -kFoot, -kThickness}, {half, static_cast<float>(p.real(kHeightM)), kThickness}};
  }
  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    const std::uint32_t boxes = 2 + (level == 0 ? posts(p) : 0);
    return {boxes * 24, boxes * 36, 0, core::VertexLayout::kModel};
  }
  double complexity(const models::Parameters& p, int level) const override {
    return level == 0 ? 2.0 + posts(p) : 2.0;
  }
  double log2_cost(const models::Parameters& p) const override {
    return std::log2(12.0 * (2.0 + std::max(0.0, static_cast<double>(p.integer(kPosts)))));
  }

  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    BoxWriter writer(bounds(p), out);
    const float half = half_length(p), height = static_cast<float>(p.real(kHeightM));
    for (const float at : {0.45F * height, 0.75F * height})
      writer.add({{-half, at - 0.04F, -0.02F}, {half, at + 0.04F, 0.02F}}, 0.30F);
    const auto seed = static_cast<std::uint64_t>(p.integer(kSeed));
    core::RandomStream random(seed, 0, 0, 0, core::Purpose::kStructure);
    for (std::uint32_t i = 0; level == 0 && i < posts(p); ++i) {
      const float x = -half + static_cast<float>(i) * static_cast<float>(p.real(kSpacingM));
      const float top = height * static_cast<float>(random.next_real(0.85, 1.0));
      writer.add({{x - kThickness, -kFoot, -kThickness}, {x + kThickness, top, kThickness}}, 0.22F);
    }
    return writer.tight();
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}

 private:
  static constexpr float kThickness = 0.06F, kFoot = 0.5F;
  static std::uint32_t posts(const models::Parameters& p) {
    return static_cast<std::uint32_t>(p.integer(kPosts));
  }
  static float half_length(const models::Parameters& p) {
    return 0.5F * static_cast<float>(posts(p) - 1) * static_cast<float>(p.real(kSpacingM));
  }
};

}  // namespace my_game
