// `psygen amplify`. Main thread.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/amplify/shard.hpp"
#include "engine/cli/amplify_stats.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cluster/peers.hpp"

namespace psygen::cli {

// The command.
class AmplifyCommand final : public Command {
 public:
  explicit AmplifyCommand(CLI::App& cli);
  int run() override;

 private:
  int print_heights(const world::World& world) const;
  core::Result<amplify::Region> region_of(const world::World& world) const;
  int run_rank();
  int run_rank(cluster::Peers& peers);
  core::Result<amplify::Report> amplify(const world::World& world,
                                        const models::Registry& registry);
  core::Result<amplify::Report> make_shard(amplify::Job job, const amplify::Region& region,
                                           amplify::JobFormat format,
                                           const amplify::Options& options) const;
  int print_report(const amplify::Report& report) const;
  int print_figures(const AmplifyStats& figures, bool stopped) const;

  std::string world_ = kDefaultWorld;
  std::optional<amplify::Region> region_;
  unsigned threads_ = 0;
  std::vector<glm::dvec2> samples_;  // x and z in metres
  std::string out_;                  // empty: write no files
  std::string format_ = "glb";
  std::optional<amplify::Shard> shard_;
  std::string simd_;                         // empty: the best
  std::uint64_t written_ = 0, skipped_ = 0;  // files
  bool mpi_ = false, json_ = false;
};

}  // namespace psygen::cli
