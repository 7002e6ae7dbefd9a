// Pictures of trees (core/model_picture.hpp): which models of a world have one, what it shows, and
// the quad that shows it in place of another model of the same type. Pictures are made from the
// finest mesh of a few instances of every scatter of trees; all other instances take the picture of
// the one most like them, stretched to their own size. Immutable after construction, any thread.
// Draws nothing and keeps no texels. docs/models.md, "Pictures".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/model_picture.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/far/forms.hpp"
#include "engine/world/far/picture_raster.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Up to this level of nodes, merged meshes have pictures (merged_plan.hpp).
inline constexpr int kMaxPicturedLevel = 3;

// A model that has a picture.
struct PicturedModel {
  models::ModelIndex model = 0;
  models::Parameters parameters;
  // By which others are matched to it: of its bounds, and of its coarsest mesh as far as that
  // reaches from the foot to any side and up.
  glm::vec2 bounds_m{0.0F}, coarse_m{0.0F};
  PictureFrame frame;
  bool leafy = true;      // sways in the wind
  double turn_deg = 0;    // ModelType::turn_deg
  std::uint64_t key = 0;  // of what all this was measured of
};

// All of a world.
class PictureSet {
 public:
  // Of at most this many instances of a scatter, and fewer where there are many scatters.
  static constexpr std::size_t kMaxOfScatter = 8;

  // Synthesises one instance for each picture (some 100 µs each). There are none for types that are
  // not seen from far, that may not run on the main thread, that throw, or whose finest mesh has no
  // leaves or too few triangles to need pictures; types of one shape (ModelType::turn_deg) have one
  // each, with or without leaves. The types of `registry` must outlive it. What is in `before` too
  // is taken over from there; it may be null, and its types may be gone.
  PictureSet(const World& world, const models::Registry& registry,
             const PictureSet* before = nullptr);

  std::span<const PicturedModel> models() const { return models_; }
  std::size_t count() const { return models_.size(); }
  // Whether instances of a type have a picture.
  bool has(models::ModelIndex model) const;
  // The first level of detail of an instance that a picture is better than.
  int first_level(models::ModelIndex model, const models::Parameters& p) const;

  // The quad of an instance that has a picture: a billboard as high and wide as the instance.
  // `scratch` measures its coarsest mesh; null: only its bounds are compared, which takes no
  // synthesis. Linear in the pictures.
  void make_quad(models::ModelIndex model, const models::Parameters& p, SampleMesh* scratch,
                 FormMesh& out) const;

  // The texels of a picture; takes some milliseconds. Made from this level of the mesh; `views`
  // different ones, which repeat.
  core::ModelPicture bake(std::size_t number, int level = 0,
                          std::uint32_t views = core::kPictureViews) const;
  // A rough one from the coarsest mesh, until the other is there.
  core::ModelPicture stand_in(std::size_t number) const;

  // Of everything above, as part of the keys of meshes; of what the quads of one type show; and of
  // one picture.
  std::uint64_t identity() const { return identity_; }
  std::uint64_t identity_of_quads(models::ModelIndex model) const;
  std::uint64_t identity_of_picture(std::size_t number) const;

 private:
  void add_scatter(const World& world, const Scatter& scatter, std::uint32_t first,
                   std::size_t most, const PictureSet* before);

  std::vector<const models::ModelType*> types_;  // of the registry
  std::vector<PicturedModel> models_;
  std::uint64_t identity_ = 0;
};

// The model type "tree_picture": what a request asks for that bakes a picture. Its mesh has nothing
// to be drawn; what counts is made beside it (scene/mesh_notes).
std::unique_ptr<models::ModelType> make_picture_type();
models::Parameters picture_parameters(std::size_t number);
std::size_t picture_number(const models::Parameters& p);

// The model type of the quads of instances of a type that has pictures. It has their parameters and
// bounds, and one level.
std::unique_ptr<models::ModelType> make_quad_type(std::shared_ptr<const PictureSet> pictures,
                                                  const models::Registry& registry,
                                                  models::ModelIndex model);

}  // namespace psygen::world
