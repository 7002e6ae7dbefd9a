// psygen schedule: simulates each policy on a recorded stream of requests, under the virtual clock.
#include "engine/cli/schedule_command.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/cli/option_checks.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/core/log.hpp"
#include "engine/synthesis/request_stream.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::cli {
namespace {

constexpr double kOverloadPercent = 100;

core::Result<std::vector<synthesis::SimulatedJob>> read_stream(const std::string& file) {
  const auto text = world::read_text_file(file, synthesis::kMaxStreamBytes);
  if (!text) return tl::unexpected(text.error());
  return synthesis::parse_stream(*text, file);
}

constexpr const char* kColumns =
    "fill      time to finish the requests of the first frame alone, and the fraction of it in\n"
    "          which modelers were idle\n"
    "visible   time from wanted in view to finished: how long a hole or a coarse model is visible\n"
    "late      fraction of the predicted requests that missed their deadline\n"
    "lateness  lateness of those requests, 0 if in time: mean and maximum\n"
    "deadline, the default, minimises the maximum lateness. If not all requests can be in time,\n"
    "shortest may be late less often and less on average, but delays some requests much longer.";

std::string table_of(std::span<const synthesis::PolicyStats> rows,
                     const synthesis::StreamLoad& load, unsigned modelers) {
  std::string text = fmt::format(
      "{} requests in {:.2f} s, {:.3g} s of work: {:.3g} % of the capacity of {} modeler{}\n",
      load.requests, load.span_s, load.work_s, load.percent, modelers, modelers == 1 ? "" : "s");
  if (load.percent > kOverloadPercent)
    text += "The modelers are overloaded: some requests have to wait under any policy.\n";
  text +=
      "           fill    idle   visible p50       p99       max    late  lateness       max\n"
      "             ms       %            ms        ms        ms       %        ms        ms\n";
  for (const synthesis::PolicyStats& row : rows) {
    fmt::format_to(
        std::back_inserter(text),
        "{:<8} {:>6.1f} {:>7.2f} {:>13.3f} {:>9.3f} {:>9.3f} {:>7.2f} {:>9.3f} {:>9.3f}\n",
        synthesis::name_of(row.policy), row.fill_s * 1e3, row.fill_idle_percent,
        row.visible_p50_s * 1e3, row.visible_p99_s * 1e3, row.visible_max_s * 1e3, row.late_percent,
        row.lateness_mean_s * 1e3, row.lateness_max_s * 1e3);
  }
  return text + "\n" + kColumns + "\n";
}

std::string json_of(std::span<const synthesis::PolicyStats> rows) {
  auto list = nlohmann::ordered_json::array();
  for (const synthesis::PolicyStats& row : rows) {
    list.push_back(
        {{"policy", synthesis::name_of(row.policy)},
         {"fill_seconds", row.fill_s},
         {"visible_seconds",
          {{"p50", row.visible_p50_s}, {"p99", row.visible_p99_s}, {"max", row.visible_max_s}}},
         {"late_percent", row.late_percent},
         {"lateness_seconds", {{"mean", row.lateness_mean_s}, {"max", row.lateness_max_s}}},
         {"fill_idle_percent", row.fill_idle_percent}});
  }
  return list.dump(2) + "\n";
}

CLI::Option* add_cluster_options(CLI::App& c, ClusterOptions& o) {
  auto* ranks = c.add_option("--ranks", o.ranks, "Simulate psygen amplify on this many ranks");
  ranks->transform(integer_between(1, 65536));
  const auto number = [&](const char* name, double& value, double low, double high,
                          const char* meaning) {
    c.add_option(name, value, meaning)
        ->capture_default_str()
        ->check(number_between(low, high))
        ->needs(ranks);
  };
  c.add_option("--world", o.world, "World whose block costs are used")
      ->capture_default_str()
      ->needs(ranks);
  c.add_option("--cores", o.cores, "Cores of each rank")
      ->capture_default_str()
      ->transform(integer_between(1, 1024))
      ->needs(ranks);
  c.add_option("--threads", o.threads, "Threads of each rank; default: one per core")
      ->transform(integer_between(1, 4096))
      ->needs(ranks);
  c.add_option("--share", o.share,
               "Distribution of blocks: by count, by predicted cost, or by cost with claims")
      ->check(one_of({"count", "cost", "claims"}))
      ->capture_default_str()
      ->needs(ranks);
  number("--terabytes", o.terabytes, 1e-3, 1e9,
         "Total size of all files, in 10^12 bytes; 0.001: 1 GB");
  number("--error-percent", o.error_percent, 0, 100,
         "Largest error of the predicted time of a run of blocks");
  number("--latency-us", o.latency_us, 0, 1e6, "Latency of a claim at rank 0");
  number("--claims-per-s", o.claims_per_s, 1, 1e12, "Claims per second that rank 0 can answer");
  number("--rank-gb-per-s", o.rank_gb_per_s, 1e-6, 1e9, "Bandwidth from a rank to the file system");
  number("--storage-gb-per-s", o.storage_gb_per_s, 1e-6, 1e9,
         "Bandwidth of the file system, for all ranks");
  number("--files-per-s", o.files_per_s, 1e-3, 1e12,
         "Files per second that the file system creates");
  number("--file-latency-ms", o.file_latency_ms, 0, 1e5, "Latency of writing a file to disk");
  return ranks;
}

}  // namespace

ScheduleCommand::ScheduleCommand(CLI::App& cli)
    : Command(cli, "schedule", "Compare scheduling policies on recorded requests") {
  CLI::App& c = *command_;
  auto* requests =
      c.add_option("--requests", file_, "File written by `psygen fly --record-requests`");
  c.add_option("--modelers", modelers_, "Simulated modelers")
      ->capture_default_str()
      ->transform(integer_between(1, 256));
  c.add_option("--slower", slower_, "Multiply the time of every synthesis")
      ->capture_default_str()
      ->check(number_between(0.001, 1e6));
  add_cluster_options(c, cluster_)->excludes(requests);
  c.add_flag("--json", json_, "Print the results as JSON");
  c.callback([this] {
    if (file_.empty() && cluster_.ranks == 0)
      throw CLI::RequiredError("psygen schedule: one of --requests and --ranks");
  });
  c.footer(std::string("Columns:\n") + kColumns);
}

int ScheduleCommand::run() {
  return cluster_.ranks > 0 ? simulate_cluster() : compare_policies();
}

int ScheduleCommand::compare_policies() const {
  auto jobs = read_stream(file_);
  if (!jobs) {
    core::log_error(jobs.error().message);
    return exit_code_of(jobs.error());
  }
  for (synthesis::SimulatedJob& job : *jobs)
    job.seconds *= slower_;
  const auto rows = synthesis::compare_policies(*jobs, modelers_);
  return print(json_ ? json_of(rows)
                     : table_of(rows, synthesis::load_of(*jobs, modelers_), modelers_));
}

}  // namespace psygen::cli
