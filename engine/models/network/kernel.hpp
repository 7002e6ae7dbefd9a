// The ground and the water of one patch at a rectangle of samples, with SIMD. Every instruction set
// gives the same bits, and so does every batch: a sample never sees its neighbours. Pure; any
// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/models/network/patch.hpp"

namespace psygen::models::network {

// Samples a call takes along each axis at most.
constexpr std::size_t kMaxSamples = 80;
// Samples of a guided call span at most this many units, so that its guide fits.
constexpr std::int32_t kMaxGuidedUnits = 44 * kGuideUnits;

// Positions in units from the patch's origin, ascending.
struct Samples {
  std::span<const std::int32_t> x, z;
  bool guided = false;  // the base is read from the guide, else it is exact
};

// Rows of results, `stride` floats apart; null: not wanted. Slopes are heights over lengths.
struct BaseRows {
  float *height_m = nullptr, *slope_x = nullptr, *slope_z = nullptr;
  float* clear = nullptr;  // 0 at channels and lakes … 1 where erosion and detail act fully
  std::size_t stride = 0;
};
// Water is kDry where there is none. Flow in m/s.
constexpr float kDry = -1e30F;
struct CarvedRows {
  const float* base_m = nullptr;  // of BaseRows, rows `base_stride` floats apart
  std::size_t base_stride = 0;
  float* height_m = nullptr;  // in: the base with detail; out: the ground
  float *water_m = nullptr, *flow_x = nullptr, *flow_z = nullptr;
  std::uint32_t* body = nullptr;
  std::size_t stride = 0;
};

// The ground before channels and lakes.
void base_rows(const Patch& patch, const Samples& samples, const BaseRows& rows);
// Heights of the network's ground.
struct HeightRange {
  float lowest_m = 0, highest_m = 0;
};
// Bounds of the ground of guided or exact samples in a box.
HeightRange range_of(const Patch& patch, const Box& box, bool guided);
// Cuts channels and lakes.
void carve_rows(const Patch& patch, const Samples& samples, const CarvedRows& rows);
// Evaluates the base and carves it in one call, faster than base_rows() and carve_rows(). Of
// `rows`, base_m is not used, and height_m is only written.
void ground_rows(const Patch& patch, const Samples& samples, CarvedRows rows);

}  // namespace psygen::models::network
