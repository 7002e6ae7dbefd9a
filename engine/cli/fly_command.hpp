// `psygen fly`. Main thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/app/flight.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/request_recorder.hpp"
#include "engine/cluster/remote_modeler_pool.hpp"

namespace psygen::cli {

// The command.
class FlyCommand final : public Command {
 public:
  explicit FlyCommand(CLI::App& cli);
  int run() override;

 private:
  void add_flight_options();
  void add_synthesis_options();
  void add_picture_options();
  void add_cluster_options();
  std::string objection() const;
  std::string validate_cluster_options() const;
  static bool prints_messages();
  core::Result<void> find_files();
  int run_alone();
  int run_here();
  int run_rank();
  int run_rank(cluster::Peers& peers);
  int run_first_rank(cluster::CompatibilityKey key, const std::vector<unsigned>& threads,
                     cluster::Peers& peers);
  void print_cluster() const;
  static int code_of(const core::Error& error);
  core::Result<void> load_image_codec() const;
  int fly();
  int tell(const app::FlightReport& report) const;
  core::Result<void> write_requests() const;

  app::FlightOptions options_;
  std::unique_ptr<app::Flight> flight_;
  int told_ = 0;          // exit code of writing the flight's outputs
  std::string requests_;  // file; empty: requests are not recorded
  RequestRecorder recorder_;
  bool inspect_ = false, json_ = false;
  bool in_cluster_ = false;
  cluster::RemoteOptions remote_options_;
  std::unique_ptr<cluster::RemoteModelerPool> remote_;  // only on rank 0
};

}  // namespace psygen::cli
