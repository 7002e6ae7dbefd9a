#include "engine/cli/merge_command.hpp"

#include "engine/amplify/merge.hpp"
#include "engine/cli/amplify_stats.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/core/log.hpp"

namespace psygen::cli {

MergeCommand::MergeCommand(CLI::App& cli)
    : Command(cli, "merge", "Check and merge the shards of psygen amplify") {
  command_->add_option("PATH", paths_, "Shard folders or ledger files")->required();
  command_->add_flag("--json", json_, "Print the results as JSON");
}

int MergeCommand::run() {
  const std::vector<std::filesystem::path> paths(paths_.begin(), paths_.end());
  const auto ledgers = amplify::read_ledgers(paths);
  if (!ledgers) {
    core::log_error(ledgers.error().message);
    return exit_code_of(ledgers.error());
  }
  const auto totals = amplify::merge(*ledgers);
  if (!totals) {
    core::log_error(totals.error().message);
    return exit_code_of(totals.error());
  }
  AmplifyStats figures;
  figures.totals = *totals;
  figures.complete = true;
  figures.parts = ledgers->size();
  return print(json_ ? json_of(figures) : text_of(figures));
}

}  // namespace psygen::cli
