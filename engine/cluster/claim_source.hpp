// The blocks of one rank: its own share, then chunks that it claims one after the other. Threads
// take runs of them; the one that finds nothing claims, and the others wait for it, some
// microseconds. Notes in the rank's ledger what is finished. Any thread.
#pragma once

#include <mutex>

#include "engine/amplify/shard.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/cluster/plan.hpp"

namespace psygen::cluster {

class ClaimSource final : public amplify::RunSource {
 public:
  // All arguments must outlive it. `ledger` may be null: nothing is noted.
  ClaimSource(const Plan& plan, Peers& peers, unsigned threads, amplify::Ledger* ledger);

  core::Result<std::optional<amplify::BlockRun>> next() override;
  core::Result<void> finished(const amplify::BlockRun& run, const amplify::Totals& totals) override;

 private:
  const Plan& plan_;
  Peers& peers_;
  const unsigned threads_;
  amplify::Ledger* ledger_;
  std::mutex mutex_;
  amplify::BlockRanges blocks_;
  std::uint64_t position_ = 0;
  bool is_over_ = false;
};

}  // namespace psygen::cluster
