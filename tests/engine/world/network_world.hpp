// A world whose land a river network shapes.
#pragma once

#include <string>

namespace psygen::world::testing {

// Endless land, 200 m high, with a river valley every few hundred metres.
inline constexpr const char* kNetworkLand = R"(format = 1

[world]
name = "river land"
seed = 11
blocks = [0, 0]
cell_m = 1
block_vertices = 33

[terrain]
octaves = 7
feature_m = 300
relief_m = 200

[water]
level_m = 20
)";
inline constexpr const char* kNetwork =
    "[rivers]\nroot_spacing_m = 1024\nhalvings = 5\nsea_share = 0.2\n";
inline constexpr const char* kNetworkErosion = "[erosion]\nstrength = 0.5\ngully_m = 40\n";

inline std::string network_text() {
  return std::string(kNetworkLand) + kNetwork;
}

}  // namespace psygen::world::testing
