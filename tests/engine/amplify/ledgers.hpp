// Ledgers with made-up totals.
#pragma once

#include <initializer_list>

#include "engine/amplify/ledger.hpp"

namespace psygen::amplify {

inline Finished entry(BlockRun run) {
  Finished f{run, {}};
  f.totals.blocks = run.count();
  f.totals.models = 8 * run.count();
  f.totals.triangles = 1000 * run.count();
  f.totals.bytes = 50000 * run.count();
  for (std::uint64_t i = run.first; i < run.end; ++i)
    f.totals.hash.add(core::mix64(i));
  return f;
}

// Shard 1 of 2 of a job of ten blocks.
inline LedgerText some_ledger(std::initializer_list<BlockRun> finished) {
  LedgerText ledger{{"0.1.0", "small", 0x123, 0x456, {0, 0, 10, 1}, exchange::Format::kGlb},
                    "shard 1 of 2",
                    {0, 10},
                    {},
                    0};
  for (const BlockRun& run : finished)
    ledger.finished.push_back(entry(run));
  return ledger;
}

}  // namespace psygen::amplify
