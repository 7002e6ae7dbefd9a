// Block costs of a series of similar worlds, such as the values of a slider. Keeps the costs of the
// ground and of the scatters that a world has in common with the previous one. Synthesises meshes
// of one block only, and only on request. One thread.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "editor/cost/block_cost.hpp"
#include "engine/world/placement.hpp"

namespace psygen::editor {

class BlockSurvey {
 public:
  // Surveys blocks around a block. `learnt` as in block_cost(); it outlives the survey.
  BlockSurvey(core::BlockCoord around, const synthesis::CostModel* learnt)
      : around_(around), learnt_(learnt) {}

  // As block_cost().
  BlockCost cost(const ParsedWorld& parsed, bool measure);

 private:
  // Sums over all blocks, for the ground or for the instances of one scatter.
  struct Part {
    double models = 0, triangles = 0, bytes = 0, seconds = 0;
    void add(const MeshCost& mesh);
  };
  void add_unknown_parts(const ParsedWorld& parsed, const synthesis::CostModel& costs,
                         const std::vector<std::uint64_t>& keys, Part& by_hand);
  double measured_factor(const ParsedWorld& parsed, const synthesis::CostModel& costs);

  core::BlockCoord around_;
  const synthesis::CostModel* learnt_;
  std::map<std::uint64_t, Part> known_;  // of the previous world, by a hash of their inputs
  std::vector<world::Placement> placements_;
};

}  // namespace psygen::editor
