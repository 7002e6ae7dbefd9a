#include "engine/frametest/run.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "engine/app/flight.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/frametest/judge.hpp"
#include "engine/frametest/rounds.hpp"
#include "engine/program/command_line.hpp"
#include "engine/program/program.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/telemetry/summary_fields.hpp"

namespace psygen::frametest {
namespace {

// Reads the files of a run, and the bases of their tests.
core::Result<std::vector<PreparedTest>> prepare(const RunOptions& options) {
  const std::filesystem::path& remarks = options.words.annotations.file;
  for (const auto& file : {options.junit, options.usual, options.words.markdown, remarks}) {
    if (file.empty()) continue;
    if (auto ok = telemetry::check_no_input(file, options.files); !ok)
      return tl::unexpected(ok.error());
    if (auto ok = telemetry::check_output_file(file); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = options.words.check(); !ok) return tl::unexpected(ok.error());
  auto files = load_frame_tests(options.files);
  if (!files) return tl::unexpected(files.error());
  std::vector<PreparedTest> tests;
  for (TestFile& file : *files) {
    std::optional<Base> base;
    if (file.test) {
      auto found = base_for(*file.test, options);
      if (found)
        base = std::move(*found);
      else
        file.test = core::fail(found.error().code,
                               fmt::format("{}: {}", file.file.string(), found.error().message));
    }
    tests.push_back({std::move(file), std::move(base)});
  }
  return tests;
}

// Prints a result. Returns false if stdout takes no more.
bool tell(const TestResult& result) {
  if (result.error) core::log_error(fmt::format("{}: {}", result.name, result.error->message));
  return program::print(to_text(result)) == program::kOk;
}

// Results of all tests, in the order of the files.
struct Told {
  std::vector<TestResult> results;
  bool printed = true;
};

// Flies each test once in a round, until none wants more, and tells results when they are final.
Told fly_in_turn(std::span<const PreparedTest> tests, const RunOptions& options, const Hooks& hooks,
                 UsualLoadFile& usual) {
  std::vector<TestFlights> flights;
  flights.reserve(tests.size());
  for (const PreparedTest& test : tests)
    flights.emplace_back(test, options, hooks, usual);
  Told told{std::vector<TestResult>(tests.size()), true};
  std::vector<bool> finished(tests.size(), false);
  while (std::ranges::find(finished, false) != finished.end()) {
    for (std::size_t i = 0; i < flights.size(); ++i) {
      if (finished[i]) continue;
      if (flights[i].wants_more()) flights[i].fly();
      if (flights[i].wants_more()) continue;
      finished[i] = true;
      told.results[i] = flights[i].finish();
      told.printed = tell(told.results[i]) && told.printed;
    }
  }
  for (const TestFlights& each : flights)
    for (UsualLoadFile::Run& run : each.record())
      usual.add(std::move(run));
  return told;
}

core::Result<void> write_results(const RunOptions& options, std::span<const TestResult> results) {
  if (!options.junit.empty()) {
    if (auto ok = core::replace_file(options.junit, to_junit(results)); !ok) return ok;
  }
  return options.words.write(to_markdown(results), remarks_of(results));
}

}  // namespace

core::Result<std::unique_ptr<app::Flight>> start_flight(app::FlightOptions flight,
                                                        const RunOptions& options,
                                                        const Hooks& hooks, app::Plugin last) {
  flight.session.device_name = options.device;
  flight.session.stop = options.stop;
  if (hooks.prepare) {
    if (auto ok = hooks.prepare(flight.session); !ok) return tl::unexpected(ok.error());
  }
  flight.camera = hooks.camera;
  if (!last.name.empty()) flight.session.plugins.push_back(std::move(last));
  auto made = app::Flight::create(std::move(flight));
  if (made && hooks.start) {
    if (auto ok = hooks.start((*made)->session()); !ok) return tl::unexpected(ok.error());
  }
  return made;
}

bool TestResult::holds() const {
  return !error && std::ranges::all_of(budgets, &BudgetResult::holds);
}

bool TestResult::misses() const {
  return !error && std::ranges::any_of(budgets, &BudgetResult::misses);
}

int exit_code_of(std::span<const TestResult> results) {
  const auto any = [&](auto predicate) { return std::ranges::any_of(results, predicate); };
  const auto skipped = [](const TestResult& r) {
    return r.error && r.error->code == core::ErrorCode::kNoDevice;
  };
  if (any([&](const TestResult& r) { return r.error && !skipped(r); })) return kFailed;
  if (any(&TestResult::misses)) return kMissed;
  if (any([](const TestResult& r) { return !r.error && !r.holds(); })) return kNotJudged;
  return any(skipped) ? kSkipped : kHeld;
}

TestResult run_frame_test(const TestFile& file, const RunOptions& options, const Hooks& hooks) {
  const PreparedTest test{file};
  const UsualLoadFile usual;
  TestFlights flights(test, options, hooks, usual);
  while (flights.wants_more())
    flights.fly();
  return flights.finish();
}

int run_frame_tests(const RunOptions& options, const Hooks& hooks) {
  const auto tests = prepare(options);
  if (!tests) return program::fail_with(tests.error());
  core::Result<UsualLoadFile> usual = UsualLoadFile();
  if (!options.usual.empty()) usual = UsualLoadFile::load(options.usual);
  if (!usual) return program::fail_with(usual.error());
  Told told = fly_in_turn(*tests, options, hooks, *usual);
  const int code = exit_code_of(told.results);
  std::string last =
      code == kNotJudged ? "not judged: no budget is missed, but the machine was too busy\n" : "";
  if (options.words.annotations.to_stdout())
    last += to_text(options.words.annotations, remarks_of(told.results));
  told.printed = program::print(last) == program::kOk && told.printed;
  auto written = write_results(options, told.results);
  if (written && !options.usual.empty()) written = usual->save(options.usual);
  if (!written) return program::fail_with(written.error());
  return told.printed ? code : kFailed;
}

void add_words(CLI::App& cli, telemetry::PullRequestWords& words) {
  cli.add_option("--markdown", words.markdown,
                 "Write the results to this file as Markdown, for a page of a pull request");
  cli.add_option_function<std::string>(
         "--annotations",
         [&words](const std::string& text) {
           words.annotations = *telemetry::annotations_from(text);
         },
         "Remarks at the lines of files, for a pull request; without FILE to stdout")
      ->check(CLI::Validator(
          [](std::string& text) {
            const auto where = telemetry::annotations_from(text);
            return where ? std::string() : where.error().message;
          },
          "github|gitlab[:FILE]"));
}

void add_options(CLI::App& cli, RunOptions& options) {
  cli.add_option("FILE", options.files, "Frame tests: TOML files")->required();
  cli.add_option("--junit", options.junit, "Write the results to this file as JUnit XML");
  cli.add_option("--out", options.out, "Folder for the outputs, with one subfolder per test");
  cli.add_option("--base", options.base,
                 "Folder of former runs (their --out) to which limits are relative");
  cli.add_option("--usual", options.usual,
                 "File with the last runs of this machine, which scale limits; this run is added");
  cli.add_option("--worst", options.worst_frames,
                 "Number of worst frames of a failed test written as images to --out")
      ->capture_default_str()
      ->check(CLI::Range(0, kMaxWorstFrames));
  cli.add_flag("--profile", options.profile,
               "Write profile.json to --out also for tests that hold: the work of each system");
  cli.add_option("--device", options.device, "Vulkan device: index, UUID or part of its name");
  add_words(cli, options.words);
}

int frame_test_main(int argc, char** argv, const Hooks& hooks) {
  const std::string name = argc > 0 ? std::filesystem::path(argv[0]).filename().string() : "";
  return program::run(name, [&] {
    RunOptions options;
    CLI::App cli("Runs frame tests", name);
    add_options(cli, options);
    if (const auto code = program::read_command_line(cli, argc, argv)) return *code;
    options.stop = &program::stop_at_interrupt();
    return run_frame_tests(options, hooks);
  });
}

}  // namespace psygen::frametest
