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
    int width_px = 1;  // river_width_px()
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

// The five looks of channels on maps, one for each decade of the discharge: from pale brooks of
// about 10 l/s or less, 1 pixel wide, to rivers of about 100 m³/s or more.
inline constexpr int kMaxRiverPx = 5;
int river_width_px(double discharge_m3_s);
// The colour, as on screen, of channels of a width from 1 to kMaxRiverPx.
glm::vec3 river_colour(int width_px);
// The discharge in m³/s that stands for a width in legends.
double usual_discharge_m3_s(int width_px);
inline constexpr glm::vec3 kShoreColour{0.62F, 0.95F, 1.0F}, kDivideColour{0.95F, 0.55F, 0.25F};

}  // namespace psygen::editor
