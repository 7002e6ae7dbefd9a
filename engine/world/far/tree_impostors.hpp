// Impostors of trees (core/vertex_layout.hpp): the models of a world that have one, its image, and
// the quad that shows it in place of another model of the same type. Impostors are made from the
// finest mesh of a few instances of every scatter of trees; all other instances use the most
// similar impostor, stretched to their own size. Immutable after construction, any thread. Draws
// nothing and keeps no texels. docs/models.md, "Pictures".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/far/impostor_raster.hpp"
#include "engine/world/far/proxy_shapes.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Maximum node level whose merged meshes have impostors (merged_plan.hpp).
inline constexpr int kMaxImpostorLevel = 3;

// A model that has an impostor.
struct ImpostorModel {
  models::ModelIndex model = 0;
  models::Parameters parameters;
  // Sizes by which others are matched to it: of its bounds, and the extent of its coarsest mesh
  // from the base point, sideways and up.
  glm::vec2 bounds_m{0.0F}, coarse_m{0.0F};
  ImpostorFrame frame;
  bool leafy = true;      // sways in the wind
  double turn_deg = 0;    // ModelType::turn_deg
  std::uint64_t key = 0;  // hash of everything that was measured
};

// All impostors of a world.
class ImpostorSet {
 public:
  // Maximum number of impostors of a scatter; fewer in worlds with many scatters.
  static constexpr std::size_t kMaxOfScatter = 8;

  // Synthesises one instance for each impostor (some 100 µs each). Types have none if they are not
  // visible from far, may not run on the main thread, throw, or if their finest mesh has no leaves
  // or too few triangles to need impostors. Types of one shape (ModelType::turn_deg) have one each,
  // with or without leaves. The types of `registry` must outlive it. Impostors that `before` has
  // are copied from there; it may be null, and its types may be destroyed.
  ImpostorSet(const World& world, const models::Registry& registry,
              const ImpostorSet* before = nullptr);

  std::span<const ImpostorModel> models() const { return models_; }
  std::size_t count() const { return models_.size(); }
  // True if instances of a type have an impostor.
  bool has(models::ModelIndex model) const;
  // The first level of detail of an instance that is worse than an impostor.
  int first_level(models::ModelIndex model, const models::Parameters& p) const;

  // The quad of an instance that has an impostor: a billboard as high and wide as the instance.
  // `scratch` measures its coarsest mesh; null: only its bounds are compared, which needs no
  // synthesis. Linear in the impostors.
  void make_quad(models::ModelIndex model, const models::Parameters& p, SampleMesh* scratch,
                 ProxyMesh& out) const;

  // The texels of an impostor, made from this level of the mesh; takes some milliseconds. `views`
  // views differ; they repeat.
  core::ImpostorTexture bake(std::size_t number, int level = 0,
                             std::uint32_t views = core::kImpostorViews) const;
  // A rough impostor from the coarsest mesh, until the final one is ready.
  core::ImpostorTexture stand_in(std::size_t number) const;

  // Hashes for mesh keys: of everything above; of the quads of one type; and of one impostor.
  std::uint64_t identity() const { return identity_; }
  std::uint64_t identity_of_quads(models::ModelIndex model) const;
  std::uint64_t identity_of_impostor(std::size_t number) const;

 private:
  void add_scatter(const World& world, const Scatter& scatter, std::uint32_t first,
                   std::size_t most, const ImpostorSet* before);

  std::vector<const models::ModelType*> types_;  // the registry's types
  std::vector<ImpostorModel> models_;
  std::uint64_t identity_ = 0;
};

// The model type "tree_picture": a request for it bakes an impostor. Its mesh has nothing to draw;
// the impostor is a by-product (scene/mesh_notes).
std::unique_ptr<models::ModelType> make_impostor_type();
models::Parameters picture_parameters(std::size_t number);
std::size_t picture_number(const models::Parameters& p);

// The model type of the quads for a type that has impostors. It has the parameters and bounds of
// that type, and one level.
std::unique_ptr<models::ModelType> make_quad_type(std::shared_ptr<const ImpostorSet> pictures,
                                                  const models::Registry& registry,
                                                  models::ModelIndex model);

}  // namespace psygen::world
