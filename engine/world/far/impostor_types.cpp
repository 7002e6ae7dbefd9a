// The two model types of impostors: the request that bakes one, and the quads that show it.
#include <algorithm>
#include <string>
#include <utility>

#include "engine/core/assert.hpp"
#include "engine/world/far/proxy_writer.hpp"
#include "engine/world/far/tree_impostors.hpp"

namespace psygen::world {
namespace {

using models::MeshSize;
using models::MeshView;
using models::ModelType;
using models::Parameters;
using models::ParameterSpec;

constexpr ParameterSpec kImpostorSchema[] = {
    models::placed(models::integer_parameter(
        "number", "", 0, models::HardRange{0, core::kMaxImpostors - 1},
        models::SoftRange{0, core::kMaxImpostors - 1}, "number of the impostor")),
};

class ImpostorType final : public ModelType {
 public:
  std::string_view name() const override { return "tree_picture"; }
  std::string_view doc() const override { return "a tree from several directions, as a texture"; }
  std::span<const ParameterSpec> parameters() const override { return kImpostorSchema; }
  int level_count() const override { return 1; }
  double level_error_m(const Parameters&, int) const override { return 0; }
  core::Bounds bounds(const Parameters&) const override { return {glm::vec3(0), glm::vec3(1)}; }
  MeshSize mesh_size(const Parameters&, int) const override {
    return {3, 3, 0, core::VertexLayout::kModel};
  }
  double complexity(const Parameters&, int) const override { return 1; }
  double steps(const Parameters&, int) const override { return 1; }
  double step_seconds() const override { return 10e-3; }
  double log2_cost(const Parameters&) const override { return 0; }
  core::Bounds synthesise(const Parameters&, int, const MeshView& out) const override {
    std::ranges::fill(out.vertices, std::byte{0});
    std::ranges::fill(out.indices, std::uint16_t{0});
    return {glm::vec3(0.5F), glm::vec3(0.5F)};
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {
    PSYGEN_CHECK(false, "impostors share no indices");
  }
};

class QuadType final : public ModelType {
 public:
  QuadType(std::shared_ptr<const ImpostorSet> pictures, const models::Registry& registry,
           models::ModelIndex model)
      : pictures_(std::move(pictures)),
        type_(&registry[model]),
        model_(model),
        name_("picture_of_" + std::string(type_->name())) {}

  std::string_view name() const override { return name_; }
  std::string_view doc() const override { return "a quad that shows a model's impostor"; }
  std::span<const ParameterSpec> parameters() const override { return type_->parameters(); }
  int level_count() const override { return 1; }
  double level_error_m(const Parameters&, int) const override { return 0; }
  core::Bounds bounds(const Parameters& p) const override { return type_->bounds(p); }
  MeshSize mesh_size(const Parameters&, int) const override {
    const ProxySize size = size_of(Form::kPicture);
    return {size.vertices, 3 * size.triangles, 0, core::VertexLayout::kModel};
  }
  // The time to make the coarsest mesh, which is measured.
  double complexity(const Parameters& p, int) const override {
    return type_->complexity(p, type_->level_count() - 1);
  }
  double steps(const Parameters& p, int) const override {
    return type_->steps(p, type_->level_count() - 1);
  }
  double step_seconds() const override { return type_->step_seconds(); }
  double log2_cost(const Parameters& p) const override { return type_->log2_cost(p); }
  std::uint64_t identity() const override {
    return core::combine(pictures_->identity_of_quads(model_), type_->identity());
  }
  bool may_run_on_main_thread() const override { return true; }
  core::Bounds synthesise(const Parameters& p, int, const MeshView& out) const override {
    ProxyMesh quad;
    SampleMesh scratch;
    pictures_->make_quad(model_, p, &scratch, quad);
    ProxyWriter writer(bounds(p), out);
    writer.add(Form::kPicture, quad, glm::vec3(0.0F), true);
    return writer.finish();
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {
    PSYGEN_CHECK(false, "impostors share no indices");
  }

 private:
  std::shared_ptr<const ImpostorSet> pictures_;
  const ModelType* type_;
  models::ModelIndex model_;
  std::string name_;
};

}  // namespace

std::unique_ptr<ModelType> make_impostor_type() {
  return std::make_unique<ImpostorType>();
}

Parameters picture_parameters(std::size_t number) {
  Parameters p;
  p.set_integer(0, static_cast<std::int64_t>(number));
  return p;
}

std::size_t picture_number(const Parameters& p) {
  return static_cast<std::size_t>(p.integer(0));
}

std::unique_ptr<ModelType> make_quad_type(std::shared_ptr<const ImpostorSet> pictures,
                                          const models::Registry& registry,
                                          models::ModelIndex model) {
  return std::make_unique<QuadType>(std::move(pictures), registry, model);
}

}  // namespace psygen::world
