// What becomes of each scatter of a world at one node level and level of detail: which form, for
// how many models, and so the size of the mesh. Depends on counts and sizes alone, not on what
// finds a place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/world/far/scatter.hpp"

namespace psygen::world {

struct ScatterPlan {
  Form form = Form::kTent;
  std::uint32_t together = 1;        // instances that one form stands for
  std::uint64_t forms = 0;           // 0: left out
  bool each_is_synthesised = false;  // else representatives stand for them
};

struct LevelPlan {
  int level = 1;                      // of the node
  int form_level = 1;                 // of the nodes that have the same forms, from `level` on
  std::vector<ScatterPlan> scatters;  // in the order of the world's
  std::uint64_t vertices = 0, triangles = 0;
  core::Bounds box;  // metres from the node's corner
};

// At most 65,536 vertices.
LevelPlan plan_level(const World& world, std::span<const FarScatter> scatters, int level,
                     int form_level);

// What making the mesh takes, in nanoseconds of one machine of which only the proportions count.
double work_of(const World& world, std::span<const FarScatter> scatters, const LevelPlan& plan);

}  // namespace psygen::world
