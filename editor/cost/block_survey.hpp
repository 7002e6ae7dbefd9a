// What blocks of worlds cost that differ little, one after the other, as along the slider of a
// field: the ground and the scatters that two of them have in common are looked at once. Makes
// meshes only of one block, and only where that is asked for. One thread.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "editor/cost/block_cost.hpp"
#include "engine/world/placement.hpp"

namespace psygen::editor {

class BlockSurvey {
 public:
  // Of some blocks around one. `learnt` as in block_cost(); outlives this.
  BlockSurvey(core::BlockCoord around, const synthesis::CostModel* learnt)
      : around_(around), learnt_(learnt) {}

  // As block_cost().
  BlockCost cost(const ParsedWorld& parsed, bool measure);

 private:
  // Sums over all blocks, of the ground or the instances of one scatter.
  struct Part {
    double models = 0, triangles = 0, bytes = 0, seconds = 0;
    void add(const MeshCost& mesh);
  };
  void look_at(const ParsedWorld& parsed, const synthesis::CostModel& costs,
               const std::vector<std::uint64_t>& keys, Part& by_hand);
  double measured_factor(const ParsedWorld& parsed, const synthesis::CostModel& costs);

  core::BlockCoord around_;
  const synthesis::CostModel* learnt_;
  std::map<std::uint64_t, Part> known_;  // of the world before, by what they depend on
  std::vector<world::Placement> placements_;
};

}  // namespace psygen::editor
