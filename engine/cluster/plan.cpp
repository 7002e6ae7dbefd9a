#include "engine/cluster/plan.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::cluster {
namespace {

using amplify::BlockRanges;
using amplify::BlockRun;
using amplify::CostMap;

// Cumulative costs of a set of blocks, by position in the set.
class Costs {
 public:
  Costs(const BlockRanges& blocks, const CostMap& map) : blocks_(blocks), map_(map) {
    for (const BlockRun& run : blocks.runs()) {
      until_.push_back(until_.back() + map.seconds_before(run.end) - map.seconds_before(run.first));
      counts_.push_back(counts_.back() + run.count());
    }
  }
  double total() const { return until_.back(); }
  // Returns the position at which the cumulative cost reaches `seconds`.
  std::uint64_t position_at(double seconds) const {
    if (!(seconds < total())) return blocks_.count();
    const auto after = std::upper_bound(until_.begin(), until_.end(), seconds);
    const auto k =
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - until_.begin())) - 1;
    const BlockRun& run = blocks_.runs()[k];
    const std::uint64_t block = map_.block_at(map_.seconds_before(run.first) + seconds - until_[k]);
    return counts_[k] + std::clamp(block, run.first, run.end) - run.first;
  }

 private:
  const BlockRanges& blocks_;
  const CostMap& map_;
  std::vector<double> until_{0.0};        // seconds before each run, and the total
  std::vector<std::uint64_t> counts_{0};  // blocks before each run, and the total
};

}  // namespace

Plan::Plan(BlockRanges todo, const CostMap& costs, unsigned ranks, const PlanOptions& options)
    : todo_(std::move(todo)) {
  PSYGEN_ASSERT(ranks >= 1, "a plan needs at least one rank");
  const Costs all(todo_, costs);
  const double each = all.total() / ranks;
  const double kept = ranks == 1 ? 1.0 : options.fixed_share;
  for (unsigned rank = 0; rank <= ranks; ++rank)
    begins_.push_back(rank == ranks ? todo_.count() : all.position_at(each * rank));
  for (unsigned rank = 0; rank < ranks; ++rank) {
    const std::uint64_t end = kept < 1 ? all.position_at(each * (rank + kept)) : begins_[rank + 1];
    keeps_.push_back(std::clamp(end, begins_[rank], begins_[rank + 1]));
    const BlockRanges left = todo_.sub(keeps_[rank], begins_[rank + 1]);
    for (const BlockRun& run : left.runs())
      rest_.append(run);
  }
  if (rest_.count() == 0) return;
  const Costs rest(rest_, costs);
  const double least = options.min_chunk * each;
  chunks_.push_back(0);
  for (double done = 0; chunks_.back() < rest_.count();) {
    done += std::max((rest.total() - done) / (2.0 * ranks), least);
    chunks_.push_back(std::max(rest.position_at(done), chunks_.back() + 1));
  }
}

BlockRanges Plan::own(unsigned rank) const {
  return todo_.sub(begins_[rank], keeps_[rank]);
}

BlockRanges Plan::chunk(std::uint64_t i) const {
  return rest_.sub(chunks_[i], chunks_[i + 1]);
}

}  // namespace psygen::cluster
