// Ridged multifractal over a lattice of integers (Musgrave, in Ebert et al., "Texturing and
// Modeling"; docs/models.md, "Terrain"): 2-D value-gradient noise (Peachey, in the same book) of
// several octaves, each weighted by the one before. Coordinates are exact fixed point. So values
// have the same bits at any distance from the origin, for any grouping of samples into calls, and
// on every instruction set. Immutable, any thread. Knows no metres and no meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/models/terrain/ridged_kernel.hpp"

namespace psygen::models {

// The parameters of a noise.
struct RidgedSettings {
  std::uint64_t seed = 0;
  double height = 1;          // Musgrave's H: octave o has the weight lacunarity^(−H·o)
  double lacunarity = 2;      // ratio of frequencies of two octaves, >= 1
  int octaves = 9;            // 1 … kMaxOctaves
  double offset = 1;          // of the ridge; see the formula in docs/models.md
  double gain = 2;            // factor from an octave to the weight of the next, >= 0
  double cells_per_step = 1;  // lattice cells of octave 0 between two integers, > 0
  double warp = 0;            // displacement of the coarse octaves, in cells of octave 0, 0 … 1
};

// A noise R(x, z) of integers.
class RidgedNoise {
 public:
  // Settings must be within their ranges.
  explicit RidgedNoise(const RidgedSettings& settings);

  // Values lie in [0, max_value()], up to a rounding error of 1e-5 of it.
  double max_value() const { return max_value_; }
  // The same for the sum of the first octaves only.
  double max_value(int octaves) const;

  // The number of octaves, at least one, whose lattice cells are no narrower than `steps` integers.
  int octaves_wider_than(double steps) const;

  // Writes values[r · stride + c] = R(columns[c], rows[r]). At most kMaxAxis columns and kMaxAxis
  // rows, stride >= number of columns, values.size() >= rows · stride. With fewer than all octaves:
  // the sum of the first ones. Ascending coordinates without large gaps are fastest; a warp takes
  // ten times as long. Throws std::bad_alloc.
  static constexpr std::size_t kMaxAxis = kMaxNoiseAxis;
  void evaluate(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
                std::span<float> values, std::size_t stride, int octaves = kMaxOctaves) const;

  // Approximate time of evaluate() for samples `spacing` integers apart along both axes. The unit
  // is the time of a sample of one octave with wide lattice cells. Where cells are narrower than
  // the spacing, each row of samples needs its own two lattice rows, and a sample takes nine times
  // as long.
  double work(std::size_t columns, std::size_t rows, double spacing,
              int octaves = kMaxOctaves) const;

 private:
  RidgedKernel kernel_;
  double max_value_ = 0, max_ridge_ = 0;
  double cells_per_step_, lacunarity_;
};

}  // namespace psygen::models
