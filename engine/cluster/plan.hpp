// Who makes which blocks: most are shared out at the start by predicted cost, the rest is cut into
// chunks that ranks claim when they have nothing left. Every rank makes the same plan from the same
// arguments, so that a chunk is its number. Pure; any thread. It sends nothing (claim_source.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/amplify/block_ranges.hpp"
#include "engine/amplify/cost_map.hpp"

namespace psygen::cluster {

// How to cut.
struct PlanOptions {
  // The part of the cost that is shared out at the start. What predictions are off by, and what
  // other programs take from a rank, should fit into the rest: half a rank's speed does.
  double fixed_share = 0.5;
  // The least chunk, as a part of what a rank makes in the mean: how unevenly ranks end. Chunks
  // before are larger: a half of what each rank has left to claim in the mean.
  double min_chunk = 0.0025;
};

class Plan {
 public:
  // `todo`: what is to be made, of the blocks that `costs` knows. Requires ranks >= 1.
  Plan(amplify::BlockRanges todo, const amplify::CostMap& costs, unsigned ranks,
       const PlanOptions& options = {});

  // What is shared out to a rank, a part of a stretch of equal cost.
  amplify::BlockRanges own(unsigned rank) const;
  // The chunks to claim, in this order: what is left of the stretches, largest cost first.
  std::uint64_t chunk_count() const { return chunks_.empty() ? 0 : chunks_.size() - 1; }
  amplify::BlockRanges chunk(std::uint64_t i) const;

 private:
  // Of positions in `todo_`: where the stretch of each rank begins, and what it keeps of it ends.
  std::vector<std::uint64_t> begins_, keeps_;
  amplify::BlockRanges todo_, rest_;
  std::vector<std::uint64_t> chunks_;  // positions in rest_
};

}  // namespace psygen::cluster
