// `psygen schedule`: compares policies, or simulates a cluster (docs/cli.md). Main thread.
#pragma once

#include <string>

#include "engine/cli/commands.hpp"
#include "engine/cli/shipped_files.hpp"

namespace psygen::cli {

// Options of the job that `psygen schedule --ranks` simulates.
struct ClusterOptions {
  unsigned ranks = 0;  // 0: no cluster
  unsigned cores = 1, threads = 0;
  std::string world = kDefaultWorld;
  std::string share = "claims";
  double terabytes = 8;       // 10^12 bytes of files
  double error_percent = 20;  // largest error of predictions
  double latency_us = 2, claims_per_s = 1e6;
  double rank_gb_per_s = 25, storage_gb_per_s = 4600, files_per_s = 64000, file_latency_ms = 3;
};

// The command.
class ScheduleCommand final : public Command {
 public:
  explicit ScheduleCommand(CLI::App& cli);
  int run() override;

 private:
  int compare_policies() const;
  int simulate_cluster() const;

  std::string file_;
  unsigned modelers_ = 2;
  double slower_ = 1;
  ClusterOptions cluster_;
  bool json_ = false;
};

}  // namespace psygen::cli
