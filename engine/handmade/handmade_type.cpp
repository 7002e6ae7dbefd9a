#include "engine/handmade/handmade_type.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/core/assert.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/kit/packing.hpp"

namespace psygen::handmade {
namespace {

using models::Parameters;

enum HandmadeParameter : std::size_t { kScale, kTurn };

constexpr models::ParameterSpec kHandmadeSchema[] = {
    models::real_parameter("scale", "1", 1, models::HardRange{0.01, 100}, models::SoftRange{0.5, 2},
                           "factor on the model's size"),
    models::real_parameter("turn_deg", "degrees", 0, models::HardRange{0, 360},
                           models::SoftRange{0, 360},
                           "rotation about the vertical axis; [0, 360]: all directions"),
};

// A rotation from +Z towards +X, like a positive rotation about +Y.
struct Turn {
  float sine, cosine, scale;
  explicit Turn(const Parameters& p)
      : sine(static_cast<float>(models::exact_sin_degrees(p.real(kTurn)))),
        cosine(static_cast<float>(models::exact_cos_degrees(p.real(kTurn)))),
        scale(static_cast<float>(p.real(kScale))) {}
  glm::vec3 direction(const glm::vec3& v) const {
    return {cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x};
  }
  glm::vec3 place(const glm::vec3& v) const { return scale * direction(v); }
};

class HandmadeType final : public models::ModelType {
 public:
  HandmadeType(std::string name, std::string doc, std::shared_ptr<const Shape> shape)
      : name_(std::move(name)), doc_(std::move(doc)), shape_(std::move(shape)) {}

  std::string_view name() const override { return name_; }
  std::string_view doc() const override { return doc_; }
  std::span<const models::ParameterSpec> parameters() const override { return kHandmadeSchema; }
  int level_count() const override { return static_cast<int>(shape_->levels.size()); }
  double level_error_m(const Parameters& p, int level) const override {
    return p.real(kScale) * at(level).error_m;
  }
  core::Bounds bounds(const Parameters& p) const override {
    constexpr float kRoom = 1.00001F;  // for the rounding of rotated positions
    const auto scale = static_cast<float>(p.real(kScale));
    const float radius = kRoom * scale * shape_->radius_m;
    return {{-radius, scale * shape_->box.min.y, -radius},
            {radius, scale * shape_->box.max.y, radius}};
  }
  models::MeshSize mesh_size(const Parameters&, int level) const override {
    const Level& mesh = at(level);
    return {static_cast<std::uint32_t>(mesh.vertices.size()),
            static_cast<std::uint32_t>(mesh.indices.size()), 0, core::VertexLayout::kModel};
  }
  double complexity(const Parameters& p, int level) const override { return steps(p, level); }
  double steps(const Parameters&, int level) const override {
    return 20 + static_cast<double>(at(level).vertices.size());
  }
  double step_seconds() const override { return 12e-9; }
  double log2_cost(const Parameters&) const override {
    return std::log2(static_cast<double>(at(0).indices.size()) / 3);
  }
  core::Bounds synthesise(const Parameters& p, int level,
                          const models::MeshView& out) const override;
  std::uint64_t identity() const override { return shape_->identity; }
  models::Collider collider(const Parameters& p) const override {
    models::Collider collider;
    if (shape_->solid.empty()) return collider;
    const Turn turn(p);
    models::Collider::Hull hull;
    for (const glm::vec3& point : shape_->solid)
      hull.points.push_back(turn.place(point));
    collider.shapes.emplace_back(std::move(hull));
    return collider;
  }
  bool may_run_on_main_thread() const override { return true; }
  std::optional<double> turn_deg(const Parameters& p) const override { return p.real(kTurn); }

 private:
  const Level& at(int level) const { return shape_->levels[static_cast<std::size_t>(level)]; }

  std::string name_, doc_;
  std::shared_ptr<const Shape> shape_;
};

core::Bounds HandmadeType::synthesise(const Parameters& p, int level,
                                      const models::MeshView& out) const {
  const Level& mesh = at(level);
  PSYGEN_CHECK(out.vertices.size() == mesh.vertices.size() * sizeof(core::ModelVertex) &&
                   out.indices.size() == mesh.indices.size(),
               "the destination must have exactly the size of the mesh");
  const core::Bounds box = bounds(p);
  const models::BoxPacker packer(box);
  const Turn turn(p);
  core::ModelVertex low{{32767, 32767, 32767}, 0, 0, {}, {}, 0};
  core::ModelVertex high{{-32767, -32767, -32767}, 0, 0, {}, {}, 0};
  std::byte* to = out.vertices.data();
  for (const Vertex& corner : mesh.vertices) {
    core::ModelVertex v{};
    packer.pack(turn.place(corner.position), v.position);
    const glm::vec2 normal = models::encode_octahedral(turn.direction(corner.normal));
    v.normal[0] = models::pack_snorm16(normal.x);
    v.normal[1] = models::pack_snorm16(normal.y);
    v.ambient = 255;
    std::ranges::copy(corner.colour, v.colour);
    v.material = corner.leaf;
    std::memcpy(to, &v, sizeof v);
    to += sizeof v;
    for (int i = 0; i < 3; ++i) {
      low.position[i] = std::min(low.position[i], v.position[i]);
      high.position[i] = std::max(high.position[i], v.position[i]);
    }
  }
  std::ranges::copy(mesh.indices, out.indices.begin());
  return {models::unpack_position(low, box), models::unpack_position(high, box)};
}

}  // namespace

std::unique_ptr<models::ModelType> make_handmade_type(std::string name, std::string doc,
                                                      std::shared_ptr<const Shape> shape) {
  return std::make_unique<HandmadeType>(std::move(name), std::move(doc), std::move(shape));
}

}  // namespace psygen::handmade
