// `psygen convert`: converts the frames of a recorded run for other viewers.
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/compare/viewer_csv.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/telemetry/output_file.hpp"

namespace psygen::cli {
namespace {

class ConvertCommand final : public Command {
 public:
  explicit ConvertCommand(CLI::App& cli)
      : Command(cli, "convert", "Convert the frames of a run for other viewers") {
    CLI::App& c = *command_;
    c.add_option("RUN", run_, "Folder of a run, with frames.csv and summary.json")->required();
    c.add_option("--to", viewer_, "Format: mangohud, or capframex (PresentMon 1.x)")
        ->required()
        ->check(one_of({compare::kViewers.begin(), compare::kViewers.end()}));
    c.add_option("--out", out_, "Output file: .csv")->required();
  }

  int run() override {
    const std::filesystem::path run = run_;
    const std::filesystem::path inputs[] = {run / "frames.csv", run / "summary.json"};
    const auto written =
        telemetry::check_no_input(out_, inputs)
            .and_then([&] { return compare::viewer_csv(viewer_, run); })
            .and_then([this](const std::string& text) { return core::replace_file(out_, text); });
    if (!written) return fail_with(written.error());
    core::log_info(fmt::format("wrote {}", out_));
    return kOk;
  }

 private:
  std::string run_, viewer_, out_;
};

}  // namespace

std::unique_ptr<Command> make_convert_command(CLI::App& cli) {
  return std::make_unique<ConvertCommand>(cli);
}

}  // namespace psygen::cli
