// Erosion of the ground as a filter: branching gullies and ridges along the slope, worn detail,
// sediment in valleys and below cliffs, layers of rock. It reads a slow guide, the ground without
// its narrow features, and never a neighbour's height. So a height is a pure function of its
// position, with the same bits for any grouping of samples and on every instruction set. Immutable,
// any thread. Knows no kind of ground (docs/models.md, "Erosion").
//
// The family of filters began with eroded terrain noise (Clay John 2018; Felix Westin 2023; Rune
// Skovbo Johansen 2026). Here the stripes of a cell are straight, which bounds the steepness.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/models/ground/erosion_kernel.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

// The erosion of a world. visit_erosion() has units, ranges and meanings.
struct Erosion {
  double strength = 0;
  double gully_m = 120;
  std::int64_t octaves = 5;
  double branching = 1;
  double ridge_rounding = 0.05, valley_rounding = 0.25;
  double wear = 0.9;
  double min_slope_deg = 4, slope_fade_deg = 10;
  double min_height_m = -1e5, max_height_m = 1e5, height_fade_m = 20;
  double sediment_m = 60, valley_floor = 0.5, scree = 0.5;
  double strata_m = 8, strata = 0;

  // Hash of all numbers and of the edition of the algorithm; never 0.
  std::uint64_t identity() const;
  friend bool operator==(const Erosion&, const Erosion&) = default;
};

// Calls visit(name, field, NumberSpec) for every field, in the order of the file.
inline constexpr auto visit_erosion = [](auto& e, const auto& visit) {
  using Spec = NumberSpec;
  visit("strength", e.strength,
        Spec{{0, 1},
             {0, 1},
             "",
             "depth of the gullies, about 0.5 for mountains; 0: no erosion at all"});
  visit("gully_m", e.gully_m, Spec{{4, 5000}, {20, 600}, "m", "width of the largest gullies"});
  visit("octaves", e.octaves,
        Spec{{1, kMaxErosionOctaves},
             {1, kMaxErosionOctaves},
             "",
             "sizes of gullies, each half as wide as the one before"});
  visit("branching", e.branching,
        Spec{{0, 2}, {0, 2}, "", "turns small gullies towards the beds of larger ones"});
  visit("ridge_rounding", e.ridge_rounding,
        Spec{{0, 1}, {0, 1}, "", "0: sharp ridges, 1: round ones"});
  visit("valley_rounding", e.valley_rounding,
        Spec{{0, 1}, {0, 1}, "", "0: sharp beds of gullies, 1: round ones"});
  visit("wear", e.wear,
        Spec{{0, 1}, {0, 1}, "", "fraction of the terrain's own small features that disappears"});
  visit("min_slope_deg", e.min_slope_deg,
        Spec{{0, 80}, {0, 45}, "degrees", "flatter ground has no gullies"});
  visit("slope_fade_deg", e.slope_fade_deg,
        Spec{{0.1, 80}, {1, 30}, "degrees", "range of slopes over which gullies begin"});
  visit("min_height_m", e.min_height_m,
        Spec{{-1e5, 1e5}, {0, 500}, "m", "lowest ground with erosion"});
  visit("max_height_m", e.max_height_m,
        Spec{{-1e5, 1e5}, {0, 500}, "m", "highest ground with erosion"});
  visit("height_fade_m", e.height_fade_m,
        Spec{{0.1, 1e5}, {1, 100}, "m", "height over which erosion begins and ends"});
  visit("sediment_m", e.sediment_m,
        Spec{{0, 5000},
             {0, 300},
             "m",
             "width of hollows that sediment fills, up to three quarters of gully_m"});
  visit("valley_floor", e.valley_floor,
        Spec{{0, 1}, {0, 1}, "", "fraction of that sediment in valleys"});
  visit("scree", e.scree, Spec{{0, 1}, {0, 1}, "", "fraction of that sediment below cliffs"});
  visit("strata_m", e.strata_m, Spec{{0.1, 1000}, {2, 50}, "m", "thickness of layers of rock"});
  visit("strata", e.strata, Spec{{0, 1}, {0, 1}, "", "steps that the layers form on cliffs"});
};

// The slow ground that an erosion follows, and that masks of shapes read.
class ErosionGuide {
 public:
  virtual ~ErosionGuide() = default;
  // Writes heights without features narrower than `narrowest_cells` cells of node level 0, in the
  // units of the values that are eroded: values[r · stride + c]. At most kMaxErosionAxis columns
  // and rows. A pure function of the position.
  virtual void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
                       double narrowest_cells, std::span<float> values,
                       std::size_t stride) const = 0;
  // True if the guide is so smooth that its value between lines follows from them. Then erosion
  // reads lines alone; masks read any places.
  virtual bool follows_from_lines() const { return false; }
};

// The lattice and the values that an erosion acts on.
struct ErosionScale {
  std::uint64_t seed = 0;  // selects one of all patterns of gullies
  double cell_m = 1;       // between neighbouring integers
  double unit_m = 1;       // a value of 1 in metres
  float highest = 1;       // values lie in [0, highest]
};

// An erosion on a ground, at one detail.
class ErosionFilter {
 public:
  // Detail 0 is exact; detail d leaves out features narrower than 3 · 2^d cells. Numbers must be
  // within their ranges.
  ErosionFilter(const Erosion& erosion, const ErosionScale& scale, int detail);

  // Erodes values[r · stride + c] at (columns[c], rows[r]). At most kMaxErosionAxis columns and
  // rows, any coordinates within ±2^53 / kErosionUnits. Throws std::bad_alloc.
  void apply(const ErosionGuide& guide, std::span<const std::int64_t> columns,
             std::span<const std::int64_t> rows, std::span<float> values, std::size_t stride) const;

  // True if the detail shows no gully, no sediment and no layer of rock. Then erosion lowers steep
  // ground and wears it, which needs only the guide's height and slope at each place.
  bool is_plain() const;
  // Erodes a value at such a detail. `worn` is the guide there, in the units of values.
  struct PlainGuide {
    float worn = 0, height_m = 0, slope_x = 0, slope_z = 0;
  };
  float plain(float value, const PlainGuide& guide) const;

  // Largest changes of a height in metres, where `wear` has mixed it with the guide; min_m <= 0.
  double min_m() const { return min_m_; }
  double max_m() const { return max_m_; }
  // Largest difference of a height to the same erosion at another detail, wear excluded.
  double error_m(const ErosionFilter& other) const;
  // The difference in most places, because of gullies that only one of them has.
  double usual_error_m(const ErosionFilter& other) const;

  // Time of apply() for samples `spacing` cells apart, in units of RidgedNoise::work(), without
  // that of the guide's heights, which are guide_points().
  double work(std::size_t columns, std::size_t rows, double spacing) const;
  double guide_points(std::size_t columns, std::size_t rows, double spacing) const;

  // Distance between lines of the guide, in cells.
  double line_cells() const { return static_cast<double>(line_cells_); }
  // Features of the guide that are narrower than this many cells are worn away.
  double narrowest_cells() const { return narrowest_cells_; }
  // Lines leave out features narrower than this, and lie at most so far beyond the samples.
  double lines_show_cells() const {
    return std::max(narrowest_cells_, 2 * static_cast<double>(line_cells_));
  }
  double guide_margin_cells() const;

 private:
  struct Lattices;
  double pivot_margin_cells() const;
  void erode(Lattices& memory, const ErosionGuide& guide, std::span<const std::int64_t> columns,
             std::span<const std::int64_t> rows, std::span<float> values, std::size_t stride) const;

  ErosionKernel kernel_;
  std::int64_t line_cells_ = 4;  // between lines of the guide
  int passes_ = 0;               // of the blur whose excess is the sediment
  double cell_m_ = 1, narrowest_cells_ = 0;
  double min_m_ = 0, max_m_ = 0, max_fill_m_ = 0, max_strata_m_ = 0;
};

}  // namespace psygen::models
