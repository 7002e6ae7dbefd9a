// psygen calibrate: the paper's Figure 9 on this machine, and the accuracy of predictions.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "engine/cli/calibration_page.hpp"
#include "engine/cli/calibration_samples.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/telemetry/progress_bar.hpp"

namespace psygen::cli {
namespace {

// Seeds of two disjoint groups of parameter sets.
constexpr std::uint64_t kFittedSets = 1, kHeldOutSets = 2;
constexpr int kSeedsPerPoint = 12;

// Logs each message once.
void warn_of(std::vector<std::string> failures) {
  std::sort(failures.begin(), failures.end());
  failures.erase(std::unique(failures.begin(), failures.end()), failures.end());
  for (const std::string& failure : failures)
    core::log_warning(fmt::format("not measured: {}", failure));
}

class CalibrateCommand final : public Command {
 public:
  explicit CalibrateCommand(CLI::App& cli)
      : Command(cli, "calibrate", "Measure the cost of synthesis on this machine") {
    CLI::App& c = *command_;
    c.add_option("--out", out_, "Folder for calibration.html and calibration.json");
    auto* world = c.add_option("--world", world_, "World whose models are fitted and predicted")
                      ->capture_default_str();
    c.add_flag("--ranges", ranges_,
               "Use parameters drawn from all soft ranges instead of a world's models")
        ->excludes(world);
    c.add_option("--samples", samples_,
                 "Parameter sets of each type to fit, and as many others to predict")
        ->capture_default_str()
        ->transform(integer_between(4, 10000));
    c.add_flag("--json", json_, "Print the results as JSON");
  }

  int run() override {
    if (!out_.empty()) {
      if (auto ok = telemetry::create_output_folder(out_); !ok) return fail_with(ok.error());
    }
    models::Registry registry = models::make_standard_registry();
    std::optional<world::World> world;
    if (!ranges_) {
      auto loaded = load_world(world_, registry);
      if (!loaded) return fail_with(loaded.error());
      world = std::move(*loaded);
    }
    const auto sets = [&](std::uint64_t which) {
      return world ? world_samples(*world, registry, which == kFittedSets ? 0 : 1, samples_)
                   : synthesis::random_samples(registry, samples_, which);
    };
    const double start_s = core::monotonic_seconds();
    synthesis::CalibrationOptions options;
    options.seconds_limit = 600;
    options.seconds_per_measurement = 50e-6;
    options.rounds = 3;
    options.sweeps = 5;  // other programs disturb single measurements
    telemetry::ProgressBar bar(telemetry::stderr_terminal(), "calibrating", 3.0);
    Calibration found;
    if (world) found.world = world->name;
    synthesis::CostModel cost(registry);
    found.fits = cost.calibrate(sets(kFittedSets), options,
                                [&bar](double fraction) { bar.update(fraction); });
    found.curves = synthesis::cost_curves(registry, cost, options, kSeedsPerPoint,
                                          [&bar](double fraction) { bar.update(1 + fraction); });
    found.held_out_sets = samples_;
    found.held_out = synthesis::accuracy_of(registry, cost, sets(kHeldOutSets), options,
                                            [&bar](double fraction) { bar.update(2 + fraction); });
    found.seconds = core::monotonic_seconds() - start_s;
    bar.finish();
    found.fits.failures.insert(found.fits.failures.end(), found.held_out.failures.begin(),
                               found.held_out.failures.end());
    warn_of(found.fits.failures);
    if (!out_.empty()) {
      const std::filesystem::path folder = out_;
      for (const auto& [name, text] :
           {std::pair("calibration.json", calibration_json(found, registry)),
            std::pair("calibration.html", calibration_page(found, registry))}) {
        if (auto ok = core::replace_file(folder / name, text); !ok) return fail_with(ok.error());
        core::log_info(fmt::format("wrote {}", (folder / name).string()));
      }
    }
    return print(json_ ? calibration_json(found, registry) : calibration_text(found, registry));
  }

 private:
  std::string out_, world_ = kDefaultWorld;
  bool ranges_ = false;
  std::size_t samples_ = 64;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_calibrate_command(CLI::App& cli) {
  return std::make_unique<CalibrateCommand>(cli);
}

}  // namespace psygen::cli
