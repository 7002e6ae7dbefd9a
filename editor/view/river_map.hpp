// The river network around a place as lines: channels with their discharge, the shores of lakes and
// of the sea, and the divides between basins. Four squares around the place, each twice as wide as
// the one inside it and made of coarser nodes, so a map costs the same anywhere: about 0.1 s, more
// where nothing is cached. A pure function of the network; any thread. Knows no renderer and no Qt.
#pragma once

#include <atomic>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/network/network.hpp"

namespace psygen::editor {

struct RiverMap {
  // Ends are metres from the corner, at the height of the water; of divides, the height is 0.
  struct Line {
    glm::vec3 from{0.0F}, to{0.0F};
  };
  struct Channel {
    Line line;
    float discharge_m3_s = 0;
  };
  core::BlockCoord corner;        // the block whose corner, at height 0, lines are relative to
  double near_m = 0;              // half the side of the finest square
  std::vector<Channel> channels;  // the finest ones first
  std::vector<Line> shores, divides;
};

// Makes the map around a place. `blocks`: of a bounded world, along x and z; lines outside are left
// out; 0: endless. Stops early, with a part of the map, once `cancelled` is true.
RiverMap make_river_map(const models::RiverNetwork& network, const core::WorldPosition& around,
                        glm::dvec2 blocks, const std::atomic<bool>& cancelled);

// The look of a channel on a map: from pale and thin streams to wide rivers, by the logarithm of
// the discharge.
struct RiverStyle {
  int width_px = 1;        // 1 … kMaxRiverPx
  glm::vec3 colour{1.0F};  // as on screen
};
inline constexpr int kMaxRiverPx = 5;
RiverStyle river_style(double discharge_m3_s);
inline constexpr glm::vec3 kShoreColour{0.62F, 0.95F, 1.0F}, kDivideColour{0.95F, 0.55F, 0.25F};

}  // namespace psygen::editor
