// Channels of a river network as curves: their water, beds and banks.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace psygen::models::network {

// A channel from the middle of an inflow towards (not through) its node to the middle of the
// outflow: a quadratic Bézier curve whose heights are blended alike, so they never rise.
//
// Water that touches other water neither rises nor has a step:
// - Arms of one node end at one height. From where two of them touch, both have that height.
// - A channel that runs into a wider and lower one ends there, and falls to its height before.
// - Other water that overlaps is blended (kernel.cpp), so that each middle keeps its own height.
struct Curve {
  static constexpr std::size_t kChords = 6;
  std::int32_t x = 0, z = 0;       // of its node, units from the patch's origin
  std::uint32_t chords = kChords;  // in use; fewer if the channel ends in a wider one
  // Metres from the node.
  std::array<float, kChords + 1> px{}, pz{};
  std::array<float, kChords> inverse_length2{};  // 1/m²; 0: the chord has no length
  std::array<float, 3> height_m{};               // of the water, never rising
  float min_m = -1e30F;                          // the water is no lower
  std::array<float, 4> turn{};  // direction x, z at the beginning and at the end, not normalised
  float width0_m = 0, width1_m = 0;
  float discharge_m3_s = 0;
  float reach_m = 0;  // no point farther from the node changes
  std::uint32_t body = 0;
  bool head = false;  // a spring: the bed begins here
};

// Mean discharge of a river with this drainage area, in m³/s: 20 litres a second from a km², about
// 630 mm of rain a year that does not evaporate. The speed of channels follows from it.
constexpr double kRunoffM3_SKm2 = 0.02;
constexpr double discharge_m3_s(double km2) {
  return kRunoffM3_SKm2 * km2;
}
// Water as wide as a river with this drainage area, at most `max_m`.
float channel_width_m(double km2, double max_m);
// Depth of the middle of a channel, in metres and in widths.
constexpr float kBedM = 0.25F, kBedWidths = 0.07F;
constexpr float channel_depth_m(float width_m) {
  return kBedM + kBedWidths * width_m;
}
// Speed in the middle of a channel, in m/s, at most kFastestM_S. Depth and speed are parabolas
// across, so it is 1.25 times the discharge over the cross-section.
constexpr float kMiddleSpeed = 1.25F / (2.0F / 3.0F), kFastestM_S = 6;
constexpr float middle_speed_m_s(float discharge_m3_s, float width_m) {
  return std::min(kMiddleSpeed * discharge_m3_s / (width_m * channel_depth_m(width_m)),
                  kFastestM_S);
}
// Height and width of the water of a curve, in metres; t: its parameter, 0 … 1.
float level_m(const Curve& c, float t);
constexpr float width_m(const Curve& c, float t) {
  return c.width0_m + t * (c.width1_m - c.width0_m);
}
// The place of a curve that is nearest to a point, which is in metres from the curve's node.
struct NearestPlace {
  float distance_m = 0, t = 0;
};
NearestPlace nearest_place(const Curve& c, float x_m, float z_m);
// Lowers the water of a curve so that it has a height, at most its own, at the end of `chords`. It
// still never rises.
void lower_end(Curve& c, std::size_t chords, float to_m);
// Width of the ground beside a channel that the channel lowers, and that it may raise.
constexpr float kValleyM = 36, kLeveeM = 12, kBankWidths = 1.5F;
// Beside the water's edge the lowered ground rises by the bank within a metre, and by this slope.
constexpr float kBankRiseM = 0.3F, kValleySlope = 0.12F;
constexpr float bank_m(float width_m) {
  return kValleyM + kBankWidths * width_m;
}

}  // namespace psygen::models::network
