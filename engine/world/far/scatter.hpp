// One scatter as it is seen from far away: a few of its instances, measured once, that stand for
// all. Immutable after construction; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/world/far/forms.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// An instance of which everything is known, and the size of its bounds, by which others are found
// to be like it.
struct Representative {
  Outline outline;
  Silhouette silhouette;
  float bounds_width_m = 0, bounds_height_m = 0;
};

// A representative that is like an instance once it is so many times as wide and as high.
struct Likeness {
  const Representative* model;
  float across, up;
};

class FarScatter {
 public:
  static constexpr std::uint32_t kRepresentatives = 32;

  // Draws and synthesises kRepresentatives instances of `scatter`, whose first instance in a block
  // has the index `first`. `world` and the type must outlive it. Where the type throws, makes
  // nothing that can be seen or is not seen from far, there are none.
  FarScatter(const World& world, const models::ModelType& type, const Scatter& scatter,
             std::uint32_t first);

  bool empty() const { return representatives_.empty(); }
  const models::ModelType& type() const { return *type_; }
  const Scatter& scatter() const { return *scatter_; }
  std::uint32_t first_index() const { return first_; }
  std::span<const Representative> representatives() const { return representatives_; }
  // Of one instance, on average.
  Silhouette mean_silhouette() const { return mean_; }
  bool is_leafy() const { return leafy_; }
  // Whether the coarsest meshes are small enough to be made for every single instance.
  bool is_cheap() const { return cheap_; }

  // The form for single instances at a node level >= 1 that is first seen so large, and how much
  // wider it must be to cover as much of the picture as the coarsest meshes do on average; not for
  // billboards, which are made to measure.
  Form form_at(int node_level, double pixels_per_m) const;
  float width_of(Form form) const { return widths_[static_cast<std::size_t>(form)]; }

  // One that is like the instance with these bounds; which one of those is up to `hash`.
  Likeness like(float width_m, float height_m, std::uint64_t hash) const;

  // Largest reach of any corner from the foot: to the side, up and down (positive), with forms that
  // stand for up to `models` instances.
  struct Reach {
    float aside = 0, up = 0, down = 0;
  };
  Reach reach(float models) const;

 private:
  void measure(const World& world);
  void measure_shape();
  void fit_forms();

  const models::ModelType* type_;
  const Scatter* scatter_;
  std::uint32_t first_;
  std::vector<Representative> representatives_;
  Silhouette mean_;
  Reach reach_;         // of the type's bounds
  float extent_m_ = 0;  // mean width or height, what is larger
  std::array<float, kFormCount> widths_{};
  bool leafy_ = false, conical_ = false, trunk_ = false, slender_ = false, cheap_ = false;
};

}  // namespace psygen::world
