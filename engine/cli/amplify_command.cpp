// psygen amplify: synthesises a region or the whole world and prints its hash.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "engine/amplify/block_files.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/interrupt.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/places.hpp"
#include "engine/cli/text_values.hpp"
#include "engine/core/log.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/telemetry/progress_bar.hpp"
#include "engine/telemetry/units.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::cli {
namespace {

struct Files {
  std::uint64_t written, skipped;
};

std::string text_of(const amplify::Report& report, const Files* files) {
  const amplify::Totals& t = report.totals;
  std::string text;
  const auto row = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("{:<31} {}\n", name, value);
  };
  row("blocks", fmt::format("{}", t.blocks));
  row("models", fmt::format("{}", t.models));
  row("triangles", fmt::format("{}  ({})", t.triangles,
                               telemetry::count_text(static_cast<double>(t.triangles))));
  row("bytes",
      fmt::format("{}  ({})", t.bytes, telemetry::size_text(static_cast<double>(t.bytes))));
  row("seconds", fmt::format("{:.3f}", report.seconds));
  row("cpu_seconds", fmt::format("{:.3f}  (threads: {})", report.cpu_seconds, report.threads));
  row("triangles_per_second_per_core",
      fmt::format("{:.0f}  ({})", report.triangles_per_second_per_core(),
                  telemetry::count_text(report.triangles_per_second_per_core())));
  row("hash", report.complete ? fmt::format("{:016x}", t.hash.value())
                              : std::string("– (not all of the region was made)"));
  if (files != nullptr)
    row("files", fmt::format("{} written, {} there already", files->written, files->skipped));
  return text;
}

std::string json_of(const amplify::Report& report, const Files* files) {
  const amplify::Totals& t = report.totals;
  nlohmann::ordered_json json;
  json["blocks"] = t.blocks;
  json["models"] = t.models;
  json["triangles"] = t.triangles;
  json["bytes"] = t.bytes;
  json["seconds"] = report.seconds;
  json["cpu_seconds"] = report.cpu_seconds;
  json["threads"] = report.threads;
  json["triangles_per_second_per_core"] = report.triangles_per_second_per_core();
  json["complete"] = report.complete;
  json["failed"] = t.failed;
  json["hash"] = nullptr;
  if (report.complete) json["hash"] = fmt::format("{:016x}", t.hash.value());
  if (files != nullptr) {
    json["files_written"] = files->written;
    json["files_skipped"] = files->skipped;
  }
  return json.dump(2) + "\n";
}

}  // namespace

AmplifyCommand::AmplifyCommand(CLI::App& cli)
    : command_(cli.add_subcommand("amplify", "Synthesise a region or the whole world")) {
  CLI::App& c = *command_;
  c.add_option("--world", world_, "World: a TOML file, or the name of one that comes with psygen")
      ->capture_default_str();
  auto* region = c.add_option_function<std::string>(
      "--region", [this](const std::string& text) { region_ = *amplify::parse_region(text); },
      "Blocks X0,Z0,X1,Z1 without X1 and Z1; default: the whole world");
  region->check(valid_if(amplify::parse_region, "REGION"));
  c.add_option("--threads", threads_, "Threads; default: one per processor")
      ->transform(integer_between(1, amplify::kMaxThreads));
  c.add_option_function<std::vector<std::string>>(
       "--sample",
       [this](const std::vector<std::string>& texts) {
         for (const std::string& text : texts)
           samples_.push_back(*parse_place(text));
       },
       "Print the height of the ground at X,Z (metres of the world) and make nothing; may be given "
       "several times")
      ->check(valid_if(parse_place, "X,Z"))
      ->excludes(region);
  c.add_option("--out", out_, "Folder for one file per block; an interrupted run goes on")
      ->excludes("--sample");
  c.add_option("--format", format_, "Format of the files of --out: glb or obj")
      ->check(one_of({"glb", "obj"}))
      ->capture_default_str()
      ->needs("--out");
  c.add_option("--simd", simd_, "Instruction set of the kernels, to compare; default: the best")
      ->check(one_of(models::simd_targets()));
  c.add_flag("--json", json_, "Print the figures as JSON");
}

int AmplifyCommand::run() {
  if (!simd_.empty()) models::pin_simd_target(simd_);
  models::Registry registry = models::make_standard_registry();
  const auto world = load_world(world_, registry);
  if (!world) {
    core::log_error(world.error().message);
    return exit_code_of(world.error());
  }
  if (!samples_.empty()) return print_heights(*world);
  const auto report = amplify(*world, registry);
  if (!report) {
    core::log_error(report.error().message);
    return exit_code_of(report.error());
  }
  return print_report(*report);
}

int AmplifyCommand::print_heights(const world::World& world) const {
  auto list = nlohmann::ordered_json::array();
  std::string text;
  for (const glm::dvec2& place : samples_) {
    const auto at = position_at(world, place);
    if (!at) {
      core::log_error(at.error().message);
      return exit_code_of(at.error());
    }
    const double height_m =
        models::ground_height_m(world.terrain, at->block, at->local.x, at->local.z);
    text += fmt::format("{}\n", height_m);  // as many digits as name this very number
    list.push_back({{"x_m", place.x}, {"z_m", place.y}, {"height_m", height_m}});
  }
  return print(json_ ? list.dump(2) + "\n" : text);
}

core::Result<amplify::Report> AmplifyCommand::amplify(const world::World& world,
                                                      const models::Registry& registry) {
  const auto region = region_ ? core::Result<amplify::Region>(*region_) : amplify::whole(world);
  if (!region) return tl::unexpected(region.error());
  if (auto ok = amplify::check_region(world, *region); !ok) return tl::unexpected(ok.error());
  std::unique_ptr<amplify::BlockFolder> folder;
  amplify::Options options;
  if (!out_.empty()) {
    auto opened =
        amplify::BlockFolder::open(out_, world, registry, *exchange::format_from(format_));
    if (!opened) return tl::unexpected(opened.error());
    folder = std::move(*opened);
    options.make_sink = [&folder] { return folder->make_sink(); };
  }
  options.threads =
      threads_ > 0 ? threads_ : amplify::threads_for(std::thread::hardware_concurrency());
  options.stop = &stop_at_interrupt();
  telemetry::ProgressBar bar(telemetry::stderr_terminal(), "amplifying " + world.name,
                             static_cast<double>(region->block_count()));
  options.progress = [&bar](std::uint64_t blocks) { bar.update(static_cast<double>(blocks)); };
  auto report = amplify::amplify(world, registry, *region, options);
  if (folder) {
    written_ = folder->written();
    skipped_ = folder->skipped();
  }
  return report;
}

int AmplifyCommand::print_report(const amplify::Report& report) const {
  const Files files{written_, skipped_};
  const Files* shown = out_.empty() ? nullptr : &files;
  const int printed = print(json_ ? json_of(report, shown) : text_of(report, shown));
  const amplify::Totals& totals = report.totals;
  if (totals.failed > 0) {
    core::log_error(fmt::format("{} meshes failed{}; the first: {}", totals.failed,
                                shown != nullptr ? " (their blocks have no files)" : "",
                                totals.first_failure));
  }
  if (totals.blocks < report.region_blocks) {
    core::log_error(fmt::format("interrupted after {} blocks", totals.blocks));
  }
  return report.complete ? printed : kFailed;
}

}  // namespace psygen::cli
