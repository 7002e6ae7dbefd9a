// `psygen merge`: merges the ledgers of shards.
#include <string>
#include <vector>

#include "engine/amplify/merge.hpp"
#include "engine/cli/amplify_stats.hpp"
#include "engine/cli/commands.hpp"

namespace psygen::cli {
namespace {

class MergeCommand final : public Command {
 public:
  explicit MergeCommand(CLI::App& cli)
      : Command(cli, "merge", "Check and merge the shards of psygen amplify") {
    command_->add_option("PATH", paths_, "Shard folders or ledger files")->required();
    command_->add_flag("--json", json_, "Print the results as JSON");
  }

  int run() override {
    const std::vector<std::filesystem::path> paths(paths_.begin(), paths_.end());
    const auto ledgers = amplify::read_ledgers(paths);
    if (!ledgers) return fail_with(ledgers.error());
    const auto totals = amplify::merge(*ledgers);
    if (!totals) return fail_with(totals.error());
    AmplifyStats figures;
    figures.report.totals = *totals;
    figures.report.complete = true;
    figures.parts = ledgers->size();
    return print(json_ ? json_of(figures) : text_of(figures));
  }

 private:
  std::vector<std::string> paths_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_merge_command(CLI::App& cli) {
  return std::make_unique<MergeCommand>(cli);
}

}  // namespace psygen::cli
