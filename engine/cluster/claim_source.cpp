#include "engine/cluster/claim_source.hpp"

namespace psygen::cluster {

ClaimSource::ClaimSource(const Plan& plan, Peers& peers, unsigned threads, amplify::Ledger* ledger)
    : plan_(plan),
      peers_(peers),
      threads_(threads),
      ledger_(ledger),
      blocks_(plan.own(peers.rank())) {}

core::Result<std::optional<amplify::BlockRun>> ClaimSource::next() {
  const std::lock_guard lock(mutex_);
  while (position_ == blocks_.count()) {
    if (is_over_ || plan_.chunk_count() == 0) return std::nullopt;
    const std::uint64_t chunk = peers_.claim();
    is_over_ = chunk >= plan_.chunk_count();
    if (is_over_) return std::nullopt;
    blocks_ = plan_.chunk(chunk);
    position_ = 0;
  }
  const amplify::BlockRun run = amplify::next_run(blocks_, position_, threads_);
  position_ += run.count();
  return run;
}

core::Result<void> ClaimSource::finished(const amplify::BlockRun& run,
                                         const amplify::Totals& totals) {
  if (ledger_ == nullptr) return {};
  return ledger_->add({run, totals});
}

}  // namespace psygen::cluster
