// One scatter at a great distance: a few instances, measured once, represent all of them. Immutable
// after construction, any thread. Places nothing (node_walk.hpp, placement.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/world/far/proxy_shapes.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// A measured instance. Other instances are matched to it by the size of their bounds.
struct Representative {
  Outline outline;
  Silhouette silhouette;
  float bounds_width_m = 0, bounds_height_m = 0;
};

// The match for an instance: a representative, and the factors of its width and height.
struct Likeness {
  const Representative* model;
  float across, up;
};

// The largest ratio between two sizes, along either axis; 1: they are equal.
float unlikeness(glm::vec2 a, glm::vec2 b);

// The parameters of one of the sample instances of a scatter, numbered from 0. Their blocks exist
// in every world; instances of one block vary as much as those of many. `first` is the index of the
// scatter's first instance in a block.
models::Parameters sample_parameters(const World& world, const models::ModelType& type,
                                     const Scatter& scatter, std::uint32_t first,
                                     std::uint32_t number);

// The representatives of one scatter.
class FarScatter {
 public:
  static constexpr std::uint32_t kRepresentatives = 32;

  // Draws and synthesises kRepresentatives instances of `scatter`, whose first instance in a block
  // has the index `first`. `world`, `type` and `scatter` must outlive it. There are no
  // representatives if the type throws, makes nothing visible or is not visible from far.
  FarScatter(const World& world, const models::ModelType& type, const Scatter& scatter,
             std::uint32_t first);

  // The same representatives for an equal scatter in another world.
  FarScatter(const FarScatter& equal, const models::ModelType& type, const Scatter& scatter)
      : FarScatter(equal) {
    type_ = &type;
    scatter_ = &scatter;
  }

  // The arguments of the constructor; and the representatives; empty() if there are none.
  bool empty() const { return representatives_.empty(); }
  const models::ModelType& type() const { return *type_; }
  const Scatter& scatter() const { return *scatter_; }
  std::uint32_t first_index() const { return first_; }
  std::span<const Representative> representatives() const { return representatives_; }
  // Mean silhouette of one instance.
  Silhouette mean_silhouette() const { return mean_; }
  // True if most representatives have leaves.
  bool is_leafy() const { return leafy_; }
  // True if the coarsest meshes are small enough to be made for every instance.
  bool is_cheap() const { return cheap_; }

  // The form of single instances at a node level >= 1. `pixels_per_m` is their scale on screen at
  // the distance where such nodes begin.
  Form form_at(int node_level, double pixels_per_m) const;
  // The factor on a form's width at which it covers, on average, as many pixels as the coarsest
  // mesh. Not for billboards, which have their own dimensions.
  float width_of(Form form) const { return widths_[static_cast<std::size_t>(form)]; }

  // A level of the scattered meshes, if all instances are one shape (ModelType::turn_deg).
  struct OwnMesh {
    int level = 0;
    std::uint32_t vertices = 0, triangles = 0;
    double error_m = 0;  // of the largest representative
  };
  // The coarsest level within this error; null for other types, and for models so small that forms
  // look the same. `pixels_per_m` as above.
  const OwnMesh* own_mesh(double pixels_per_m, double max_error_m) const;

  // A representative similar to an instance with bounds of this size. `hash` selects one of those
  // that are similar enough. Requires !empty(); linear in the representatives. The pointer lives as
  // long as this object.
  Likeness like(float width_m, float height_m, std::uint64_t hash) const;

  // Largest distances in metres of any corner from the base point; all >= 0.
  struct Reach {
    float aside = 0, up = 0, down = 0;
  };
  // The extent of forms that represent up to `models` instances.
  Reach reach(float models) const;

 private:
  void measure(const World& world);
  void measure_own_meshes(const models::Parameters& p);
  void measure_shape();
  void fit_forms();

  const models::ModelType* type_;
  const Scatter* scatter_;
  std::uint32_t first_;
  std::vector<Representative> representatives_;
  std::vector<OwnMesh> own_meshes_;  // finest first
  Silhouette mean_;
  Reach reach_;         // extent of the type's bounds
  float extent_m_ = 0;  // mean of the larger of width and height
  std::array<float, kProxyCount> widths_{};
  bool leafy_ = false, conical_ = false, trunk_ = false, slender_ = false, cheap_ = false;
};

// The representatives of all scatters of a world, in its order.
class FarScatters {
 public:
  // `registry` must be that of the world; its types must outlive this object. Scatters that are
  // equal in another world (WorldParts::models) are copied from `before`, which may be null and
  // whose types may be destroyed.
  FarScatters(std::shared_ptr<const World> world, const models::Registry& registry,
              const FarScatters* before = nullptr);
  std::span<const FarScatter> all() const { return all_; }

 private:
  // The scatter with this hash, or null.
  const FarScatter* find(std::uint64_t hash) const;

  std::shared_ptr<const World> world_;  // the scatters refer to it
  std::vector<std::uint64_t> hashes_;   // one for each scatter
  std::vector<FarScatter> all_;
};

}  // namespace psygen::world
