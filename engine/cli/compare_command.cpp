#include "engine/cli/compare_command.hpp"

#include <fmt/format.h>

#include <random>

#include "engine/cli/child_process.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/compare/compare_page.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/frametest/run.hpp"
#include "engine/telemetry/output_file.hpp"

namespace psygen::cli {
namespace {

bool is_folder(const std::string& name) {
  std::error_code error;
  return std::filesystem::is_directory(name, error);
}

}  // namespace

CompareCommand::CompareCommand(CLI::App& cli)
    : Command(cli, "compare", "Compare frame times and content of two builds") {
  CLI::App& c = *command_;
  c.add_option("A", a_, "Baseline: a folder of runs, or a command like \"old/psygen test\"")
      ->required();
  c.add_option("B", b_, "Candidate: a folder or a command")->required();
  c.add_option("--test", test_, "Frame test that both commands run");
  c.add_option("--out", out_, "Folder for the runs, compare.json and compare.html");
  c.add_option("--pairs", pairs_, "Pairs of runs in a batch")
      ->capture_default_str()
      ->transform(integer_between(compare::kFewestPairs, compare::kMaxPairs));
  c.add_option("--aa", aa_,
               "Compare A with itself this many times, to measure the false alarm rate")
      ->transform(integer_between(0, 100'000));
  c.add_flag("--instructions", instructions_,
             "Compare two commands by their executed instructions, counted by callgrind")
      ->excludes("--test", "--pairs", "--aa");
  c.add_flag("--json", json_, "Print the result as JSON");
}

// Runs a command once: COMMAND TEST --out FOLDER. A missed budget (3) does not count as a failure.
core::Result<compare::RecordedRun> CompareCommand::record(
    const std::string& command, const std::filesystem::path& folder) const {
  if (auto ok = telemetry::create_output_folder(folder); !ok) return tl::unexpected(ok.error());
  std::vector<std::string> words = words_of(command);
  words.insert(words.end(), {test_, "--out", folder.string()});
  const auto log = folder / "output.txt";
  const auto code = run_program(words, log);
  if (!code) return tl::unexpected(code.error());
  if (*code != frametest::kHeld && *code != frametest::kMissed) {
    return core::fail(
        *code == frametest::kSkipped ? core::ErrorCode::kNoDevice : core::ErrorCode::kInternal,
        fmt::format("{}: exit code {}; its output is in {}", command, *code, log.string()));
  }
  auto runs = compare::read_runs(folder);
  if (!runs) return tl::unexpected(runs.error());
  return std::move(runs->front());
}

// The order within a pair is random, so that a drift of the machine does not favour one side.
core::Result<void> CompareCommand::record_batch(int batch) {
  std::random_device random;
  for (std::size_t pair = 0; pair < pairs_; ++pair) {
    const auto folder = out_ / fmt::format("batch_{}", batch) / fmt::format("pair_{:02}", pair);
    const bool b_first = random() % 2 == 1;
    for (const bool is_b : {b_first, !b_first}) {
      auto run = record(is_b ? b_ : a_, folder / (is_b ? "b" : "a"));
      if (!run) return tl::unexpected(run.error());
      const bool enough = run->virtual_clock;
      (is_b ? runs_b_ : runs_a_).push_back(std::move(*run));
      if (enough && runs_a_.size() == 1 && runs_b_.size() == 1) return {};
    }
  }
  return {};
}

// Records the runs of both sides; a second batch if the first finds a difference.
core::Result<void> CompareCommand::collect() {
  if (is_folder(a_) && is_folder(b_)) {
    auto a = compare::read_runs(a_), b = compare::read_runs(b_);
    if (!a || !b) return tl::unexpected((a ? b : a).error());
    runs_a_ = std::move(*a);
    runs_b_ = std::move(*b);
    return {};
  }
  if (auto ok = record_batch(1); !ok) return ok;
  const auto first = compare::compare(runs_a_, runs_b_);
  if (!first) return tl::unexpected(first.error());
  const bool sure = first->exact || first->verdict == compare::Verdict::kSame;
  return sure ? core::Result<void>{} : record_batch(2);
}

// Returns a usage error, or nothing: requires two folders with runs, or two commands with a test
// and an output folder.
std::string CompareCommand::misuse() const {
  if (is_folder(a_) && is_folder(b_)) return {};
  if (!test_.empty() && !out_.empty()) return {};
  std::error_code ignored;
  for (const std::string& side : {a_, b_}) {
    const bool is_path = side.find('/') != std::string::npos && side.find(' ') == std::string::npos;
    if (is_path && !std::filesystem::exists(side, ignored))
      return side + ": no such folder or program";
  }
  return "two commands need --test and --out; recorded runs need two folders";
}

int CompareCommand::run() {
  if (instructions_) return compare_instructions();
  if (const std::string sentence = misuse(); !sentence.empty()) {
    core::log_error(sentence);
    return kUsage;
  }
  const auto result = collect().and_then([this] { return compare::compare(runs_a_, runs_b_); });
  core::Result<compare::FalseAlarms> alarms = compare::FalseAlarms{};
  if (result && aa_ > 0) alarms = compare::measure_false_alarms(runs_a_, aa_, 1);
  if (!result || !alarms) {
    const core::Error& error = result ? alarms.error() : result.error();
    core::log_error(error.message);
    return exit_code_of(error);
  }
  const compare::FalseAlarms* measured = aa_ > 0 ? &*alarms : nullptr;
  const std::string json = compare::to_json(*result, measured);
  if (!out_.empty()) {
    const std::string page = compare::to_html(*result, runs_a_, runs_b_, {a_, b_, test_}, measured);
    const auto written =
        telemetry::create_output_folder(out_)
            .and_then([&] { return core::replace_file(out_ / "compare.json", json); })
            .and_then([&] { return core::replace_file(out_ / "compare.html", page); });
    if (!written) {
      core::log_error(written.error().message);
      return kFailed;
    }
  }
  const int printed = print(json_ ? json : compare::to_text(*result, measured));
  return printed != kOk                                ? printed
         : result->verdict == compare::Verdict::kWorse ? int{frametest::kMissed}
                                                       : kOk;
}

}  // namespace psygen::cli
