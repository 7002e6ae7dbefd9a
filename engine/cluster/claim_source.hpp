// Source of the blocks of one rank: first its fixed share, then chunks that it claims one at a
// time. Threads take runs of blocks. The thread that finds none left claims the next chunk while
// the others wait some microseconds. Records finished runs in the rank's ledger. Any thread.
#pragma once

#include <mutex>

#include "engine/amplify/shard.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/cluster/plan.hpp"

namespace psygen::cluster {

class ClaimSource final : public amplify::RunSource {
 public:
  // All arguments must outlive the source. A null `ledger` records nothing.
  ClaimSource(const Plan& plan, Peers& peers, unsigned threads, amplify::Ledger* ledger);

  // See amplify::RunSource.
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
