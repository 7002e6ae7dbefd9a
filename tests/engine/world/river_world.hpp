// A land with a river from a spring through a lake into the sea, and a brook that joins it.
#pragma once

#include <string>

#include "engine/core/hash.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world::testing {

// 3 × 3 km, 140 m high, with a sea around (1560, 1650).
inline constexpr const char* kBrookLand = R"(format = 1

[world]
name = "brook land"
seed = 77
blocks = [48, 48]
cell_m = 1
block_vertices = 65

[terrain]
octaves = 9
feature_m = 1500
relief_m = 140
height = 1.1
gain = 1.8
offset = 0.92

[water]
level_m = 26.25
)";

inline constexpr const char* kLakeTable = R"(
[[lake]]
points_m = [[1795, 1662], [1788, 1700], [1752, 1704], [1728, 1728], [1696, 1690], [1712, 1655], [1722, 1618],
            [1756, 1640]]
depth_m = 5
shore_m = 14
)";
inline constexpr const char* kRiverTable = R"(
[[river]]
points_m = [[2150, 1750], [2085, 1768], [2020, 1735], [1960, 1752], [1905, 1715], [1860, 1715], [1820, 1680],
            [1780, 1670], [1740, 1670], [1705, 1675], [1660, 1655], [1620, 1662], [1560, 1655]]
width_m = [2.5, 3, 3.5, 4, 5, 6, 6, 6, 7, 8, 9, 10, 12]
depth_m = [0.4, 0.5, 0.6, 0.7, 0.8, 1, 1, 1, 1, 1.2, 1.3, 1.4, 1.5]
bank_m = 8
)";
inline constexpr const char* kBrookTable = R"(
[[river]]
points_m = [[1950, 1250], [1890, 1270], [1852, 1330], [1800, 1350], [1789, 1411], [1740, 1440], [1734, 1495],
            [1690, 1530], [1705, 1580], [1665, 1610], [1660, 1655]]
width_m = [2, 2.5, 3, 3, 4, 4, 5, 5, 5, 5, 5]
depth_m = 0.7
)";

inline std::string river_text() {
  return std::string(kBrookLand) + kLakeTable + kRiverTable + kBrookTable;
}
inline const World& river_world() {
  static const World world = parsed(river_text());
  return world;
}

// Names of its bodies.
inline constexpr WaterBody kTheLake = kSea + 1, kTheRiver = kSea + 2, kTheBrook = kSea + 3;

inline double ground_in(const World& world, glm::dvec2 at_m) {
  const core::WorldPosition at = world.position(at_m);
  return models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z);
}

}  // namespace psygen::world::testing
