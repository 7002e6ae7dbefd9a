// The channels of river networks: crossings, discharge, depth, valleys.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/models/network/network.hpp"
#include "tests/engine/models/network/networks.hpp"

namespace psygen::models {
namespace {

using network::kUnitsPerCell;
using river_tests::kFrame;
using river_tests::network_of;
using river_tests::Place;
using river_tests::places;
using river_tests::position_of;

// A chord of a curve, in metres from the patch's origin.
struct Chord {
  double ax, az, bx, bz;
};
std::vector<Chord> chords_of(const network::Patch& patch, const network::Curve& c) {
  std::vector<Chord> chords;
  const auto unit_m = static_cast<double>(patch.unit_m);
  for (std::size_t s = 0; s < c.chords; ++s)
    chords.push_back({c.x * unit_m + static_cast<double>(c.px[s]),
                      c.z * unit_m + static_cast<double>(c.pz[s]),
                      c.x * unit_m + static_cast<double>(c.px[s + 1]),
                      c.z * unit_m + static_cast<double>(c.pz[s + 1])});
  return chords;
}
bool cross(const Chord& p, const Chord& q) {
  const auto side = [](const Chord& c, double x, double z) {
    return (c.bx - c.ax) * (z - c.az) - (c.bz - c.az) * (x - c.ax);
  };
  constexpr double kTouch = 1e-2;  // m²: ends that two curves share round differently
  return side(p, q.ax, q.az) * side(p, q.bx, q.bz) < -kTouch &&
         side(q, p.ax, p.az) * side(q, p.bx, p.bz) < -kTouch;
}

TEST(RiverNetwork, ChannelsOfDifferentNodesNeverCross) {
  const auto network = network_of({});
  std::size_t curves = 0, crossings = 0;
  for (const Place& place : places(25, 600'000)) {
    const auto patch = network->patch(network->tile_of(place[0], place[1], {}));
    std::vector<std::vector<Chord>> chords;
    for (const network::Curve& c : patch->curves)
      chords.push_back(chords_of(*patch, c));
    curves += chords.size();
    for (std::size_t a = 0; a < chords.size(); ++a) {
      for (std::size_t b = a + 1; b < chords.size(); ++b) {
        const network::Curve &c = patch->curves[a], &d = patch->curves[b];
        if ((c.x == d.x && c.z == d.z) || std::abs(c.x - d.x) > 300 * kUnitsPerCell ||
            std::abs(c.z - d.z) > 300 * kUnitsPerCell)
          continue;
        for (const Chord& p : chords[a]) {
          for (const Chord& q : chords[b])
            crossings += cross(p, q) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(curves, 2000U);
  EXPECT_EQ(crossings, 0U);
}

TEST(RiverNetwork, ChannelsHaveTheDischargeOfTheirDrainageArea) {
  EXPECT_DOUBLE_EQ(network::discharge_m3_s(50), 1);
  const auto network = network_of({.seed = 3, .sea_share = 0.2});
  const auto patch = network->patch(network->tile_of(4000, 4000, {}));
  std::size_t alone = 0;
  float least = 1e30F, most = 0;
  for (const network::Curve& c : patch->curves) {
    constexpr std::size_t kMiddle = 2;
    if (c.chords <= kMiddle || c.head) continue;
    const double x_m = static_cast<double>(patch->x + c.x) / kUnitsPerCell + double{c.px[kMiddle]};
    const double z_m = static_cast<double>(patch->z + c.z) / kUnitsPerCell + double{c.pz[kMiddle]};
    const core::WorldPosition at = position_of(x_m, z_m);
    const auto found = network->inland_water_at(at);
    if (!found || !found->channel || found->water.body != c.body) continue;
    const NetworkWater& water = found->water;
    const auto& channel = found->channel;
    const float width_m =
        network::width_m(c, static_cast<float>(kMiddle) / network::Curve::kChords);
    if (std::abs(channel->width_m - double{width_m}) > 1e-3) continue;  // another arm is nearer
    ASSERT_EQ(channel->discharge_m3_s, double{c.discharge_m3_s});
    // The speed is that of the discharge through the cross-section.
    const double cross_section_m2 = 2.0 / 3 * double{width_m * network::channel_depth_m(width_m)};
    const double speed = std::min(1.25 * channel->discharge_m3_s / cross_section_m2, 6.0);
    const double flow = std::hypot(double{water.flow_m_s.x}, double{water.flow_m_s.y});
    if (std::abs(flow - speed) < 0.02 * speed) ++alone;
    least = std::min(least, c.discharge_m3_s);
    most = std::max(most, c.discharge_m3_s);
  }
  EXPECT_GT(alone, 60U);
  EXPECT_GE(double{least}, 0.97 * network::discharge_m3_s(network->settings().channel_km2));
  EXPECT_GT(most, 20 * least);
}

// The ground of a patch, `x_m` and `z_m` from the node of a curve.
float ground_beside(const network::Patch& patch, const network::Curve& c, float x_m, float z_m) {
  const std::int32_t x = c.x + static_cast<std::int32_t>(x_m / patch.unit_m);
  const std::int32_t z = c.z + static_cast<std::int32_t>(z_m / patch.unit_m);
  const network::Samples at{{&x, 1}, {&z, 1}, true};
  float base = 0, water = 0;
  network::base_rows(patch, at, {.height_m = &base, .stride = 1});
  float height = base;
  network::carve_rows(
      patch, at,
      {.base_m = &base, .base_stride = 1, .height_m = &height, .water_m = &water, .stride = 1});
  return height;
}
// True if a place, from the node of a curve, lies in the valley of a channel twice as wide.
bool is_in_valley(const network::Patch& patch, const network::Curve& c, float x_m, float z_m) {
  return std::ranges::any_of(patch.curves, [&](const network::Curve& wide) {
    if (wide.width0_m < 2 * c.width1_m) return false;
    const network::NearestPlace near =
        network::nearest_place(wide, static_cast<float>(c.x - wide.x) * patch.unit_m + x_m,
                               static_cast<float>(c.z - wide.z) * patch.unit_m + z_m);
    const float width_m = network::width_m(wide, near.t);
    return near.distance_m - width_m / 2 < network::bank_m(width_m);
  });
}

// Streams run down the sides of the valleys of wider rivers, not over them on dams.
TEST(RiverNetwork, StreamsLieInTheValleysOfWiderRivers) {
  constexpr std::size_t kMiddle = network::Curve::kChords / 2;
  constexpr float kBesideM = 16, kDamM = 4;  // beyond levees
  std::size_t streams = 0, dams = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const auto network = network_of({.seed = seed, .mountain_share = 0.8});
    for (const Place& place : places(30, 300'000)) {
      const auto patch = network->patch(network->tile_of(place[0], place[1], {}));
      for (const network::Curve& c : patch->curves) {
        const bool falls = c.height_m[0] - c.height_m[2] > 1;  // not in a lake
        if (!falls || c.chords < network::Curve::kChords) continue;
        const float x_m = c.px[kMiddle], z_m = c.pz[kMiddle];
        if (!is_in_valley(*patch, c, x_m, z_m)) continue;
        const float ex = c.px[kMiddle + 1] - c.px[kMiddle - 1];
        const float ez = c.pz[kMiddle + 1] - c.pz[kMiddle - 1];
        const float aside = kBesideM / std::sqrt(ex * ex + ez * ez);
        const float ground_m =
            std::max(ground_beside(*patch, c, x_m - aside * ez, z_m + aside * ex),
                     ground_beside(*patch, c, x_m + aside * ez, z_m - aside * ex));
        ++streams;
        dams += ground_m < network::level_m(c, 0.5F) - kDamM ? 1 : 0;
      }
    }
  }
  EXPECT_GT(streams, 200U);
  EXPECT_LT(50 * dams, streams);
}

// Beds are as deep as their channels are wide, also in the valleys of wider rivers.
TEST(RiverNetwork, ChannelsHaveTheDepthOfTheirWidth) {
  constexpr float kDeeperM = 0.3F;  // as where channels meet
  std::size_t channels = 0, deep = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto network = network_of({.seed = seed, .mountain_share = 0.8});
    const auto level_with_sea_m = static_cast<float>(network->frame().sea_level_m) + 0.02F;
    for (const Place& place : places(15, 300'000)) {
      const auto patch = network->patch(network->tile_of(place[0], place[1], {}));
      for (const network::Curve& c : patch->curves) {
        for (std::size_t s = 1; s < c.chords && !c.head; ++s) {
          const auto cells = [](std::int64_t node, float m) {
            return static_cast<double>(node) / kUnitsPerCell + double{m};
          };
          const auto found = network->inland_water_at(
              position_of(cells(patch->x + c.x, c.px[s]), cells(patch->z + c.z, c.pz[s])));
          if (!found || !found->channel || found->water.surface_m < level_with_sea_m) continue;
          const auto width_m = static_cast<float>(found->channel->width_m);
          ++channels;
          deep += found->water.depth_m > network::channel_depth_m(width_m) + kDeeperM ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(channels, 10'000U);
  EXPECT_LT(50 * deep, channels);
}

TEST(RiverNetwork, LakesHaveNoChannel) {
  const auto network = network_of({.lake_share = 0.12, .sea_share = 0.2});
  std::size_t channels = 0, lakes = 0;
  for (const Place& place : places(150, 300'000)) {
    for (std::int64_t i = 0; i < 30 * 30; ++i) {
      const core::WorldPosition at = position_of(static_cast<double>(place[0] + 5 * (i % 30)),
                                                 static_cast<double>(place[1] + 5 * (i / 30)));
      const auto found = network->inland_water_at(at);
      if (!found) continue;
      ++(found->channel ? channels : lakes);
      if (found->channel) {
        ASSERT_GT(found->channel->discharge_m3_s, 0);
      } else {
        // Water without a channel is still, or has the level of a lake through which one runs.
        const auto patch =
            network->patch(network->tile_of(place[0] + 5 * (i % 30), place[1] + 5 * (i / 30), {}));
        const bool is_level = std::ranges::any_of(patch->lakes, [&](const network::Lake& lake) {
          return std::abs(lake.level_m - found->water.surface_m) < 0.02F;
        });
        ASSERT_TRUE(is_level || found->water.flow_m_s == glm::vec2(0.0F));
      }
    }
  }
  EXPECT_GT(channels, 200U);
  EXPECT_GT(lakes, 500U);
}

}  // namespace
}  // namespace psygen::models
