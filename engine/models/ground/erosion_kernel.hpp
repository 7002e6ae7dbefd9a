// The seam between the settings of erosion (erosion.cpp) and its SIMD kernel (erosion_kernel.cpp),
// which is compiled once per instruction set. Internal to the erosion. Pure, any thread.
// docs/models.md, "Erosion".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace psygen::models {

inline constexpr int kMaxErosionOctaves = 8;
// Longest axis of one call, and of the guide under it; a multiple of the lanes of every instruction
// set.
inline constexpr std::size_t kMaxErosionAxis = 144;
// Most pivots along an axis of an octave in one call, and the padded length of their rows.
inline constexpr std::size_t kMaxPivots = 48, kPivotStride = 64;

// Positions along an axis count in this part of a cell of node level 0, from the world's origin.
inline constexpr std::int64_t kErosionUnits = 256;

// One octave of gullies: square cells with one pivot each, around which stripes run straight.
struct ErosionOctave {
  std::int64_t size = 1;                    // of a cell, in units; half that of the octave before
  std::int64_t origin_x = 0, origin_z = 0;  // of cell 0, in units
  std::uint32_t key = 0;                    // of the pivots' random numbers
  float depth_m = 0;                        // half the height from a gully's bed to its ridge
  float side = 0;                           // steepest slope of its sides, for finer octaves
  float reach2_m2 = 0;                      // square of the distance over which slopes count
};

// A smooth step: 0 at `from` and below, 1 at from + 1 / per and above.
struct ErosionRamp {
  float from = 0, per = 0;
};

// The constants of an erosion at one detail. Lengths in metres, slopes as tangents.
struct ErosionKernel {
  std::array<ErosionOctave, kMaxErosionOctaves> octaves{};
  std::size_t octave_count = 0;
  float turns = 0;                             // waves per cell
  float ridge_softness = 0, bed_softness = 0;  // squares of fractions of a gully's width
  float profile_scale = 1;                     // keeps profiles within ±1
  float carve_m = 0;                           // gullies lower the ground by this on average
  ErosionRamp lowest, highest;                 // heights where it acts
  ErosionRamp slope, full;                     // slopes where gullies begin; their depth by slope
  float wear = 0;                              // fraction of narrow octaves that is worn away
  float floor_share = 0, scree_share = 0;      // fraction of sediment that stays, by slope
  float max_fill_m = 0, bury = 0;  // most sediment; the thickness that buries gullies, inverted
  ErosionRamp scree, cliff;        // slopes where scree begins, and ends at cliffs
  float strata_m = 0, strata_turns = 0;  // thickness of layers of rock, and inverted
  float strata = 0;                      // their height in metres over 2π
  float unit_m = 1, highest_value = 1;   // of the values
};

// One axis of a call. Cells are those of the pivots in the call's tables.
struct ErosionAxis {
  std::size_t count = 0;
  // Of the guide: line of each sample's first tap, and its position between the second and the
  // third tap.
  std::array<std::int32_t, kMaxErosionAxis> line;
  std::array<float, kMaxErosionAxis> share;
  // Of each octave: each sample's cell, and its position in it.
  std::array<std::array<std::int32_t, kMaxErosionAxis>, kMaxErosionOctaves> cell;
  std::array<std::array<float, kMaxErosionAxis>, kMaxErosionOctaves> fraction;
  // Of each octave: first cell of the table, from the world's origin, and number of cells.
  std::array<std::int64_t, kMaxErosionOctaves> first_cell;
  std::array<std::size_t, kMaxErosionOctaves> cells;
  std::int64_t first_line = 0;  // of the guide, from the world's origin
  std::size_t lines = 0;
};

// Everything that one call reads.
struct ErosionCall {
  const ErosionKernel* kernel = nullptr;
  const ErosionAxis *x = nullptr, *z = nullptr;
  const float* guide = nullptr;  // heights in metres, guide[line_z · kMaxErosionAxis + line_x]
  int passes = 0;                // of the blur whose excess over the guide is sediment; 0: none
  std::int64_t spacing = 0;      // between lines of the guide, in units
  float spacing_m = 0;
  const float* worn = nullptr;  // values without narrow octaves; null: as `values`
  std::size_t worn_stride = 0;
  bool wears_to_guide = false;  // the guide takes the place of `worn`
};

// Erodes values[r · stride + c], on the best instruction set of this CPU.
void erode_rows(const ErosionCall& call, float* values, std::size_t stride);

}  // namespace psygen::models
