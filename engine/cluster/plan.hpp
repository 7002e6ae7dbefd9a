// Distribution of blocks over ranks. Most blocks are assigned at the start by predicted cost. The
// rest forms chunks that idle ranks claim. All ranks compute the same plan from the same arguments,
// so a number identifies a chunk. Pure; any thread. Sends nothing (job.cpp does).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/amplify/block_ranges.hpp"
#include "engine/amplify/cost_map.hpp"

namespace psygen::cluster {

// Parameters of the distribution.
struct PlanOptions {
  // Fraction of the cost that is assigned at the start. The rest must absorb prediction errors and
  // the load of other programs; it suffices if a rank runs at half its speed.
  double fixed_share = 0.5;
  // Smallest chunk, as a fraction of the mean work of a rank. It bounds how unevenly ranks finish.
  // Earlier chunks are larger: half of the mean work that each rank has left to claim.
  double min_chunk = 0.0025;
};

class Plan {
 public:
  // `todo`: the blocks to synthesise, all of which `costs` covers. Requires ranks >= 1.
  Plan(amplify::BlockRanges todo, const amplify::CostMap& costs, unsigned ranks,
       const PlanOptions& options = {});

  // Returns the fixed share of a rank: a part of its stretch of equal cost.
  amplify::BlockRanges own(unsigned rank) const;
  // The chunks to claim, in this order: the rest of each stretch, highest cost first.
  std::uint64_t chunk_count() const { return chunks_.empty() ? 0 : chunks_.size() - 1; }
  amplify::BlockRanges chunk(std::uint64_t i) const;

 private:
  // Positions in `todo_`: begin of each rank's stretch, and end of its fixed share.
  std::vector<std::uint64_t> begins_, keeps_;
  amplify::BlockRanges todo_, rest_;
  std::vector<std::uint64_t> chunks_;  // positions in rest_
};

}  // namespace psygen::cluster
