// `psygen compare`: compares two builds, or two recorded sets of runs (docs/frame-tests.md).
#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/compare/compare.hpp"
#include "engine/compare/compare_page.hpp"
#include "engine/compare/compare_words.hpp"
#include "engine/compare/instructions.hpp"
#include "engine/compare/times.hpp"
#include "engine/core/child_process.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/frametest/run.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::cli {
namespace {

class CompareCommand final : public Command {
 public:
  explicit CompareCommand(CLI::App& cli);
  int run() override;

 private:
  bool is_recorded(const std::string& side) const;
  std::string misuse() const;
  compare::Conditions conditions() const {
    return anyway_ ? compare::Conditions::kAcceptOthers : compare::Conditions::kMustBeEqual;
  }
  int compare_times() const;
  int tell(compare::Verdict verdict, const std::string& text, const compare::Words& words) const;
  core::Result<void> write(const std::string& json, const std::string& page) const;
  core::Result<void> collect();
  core::Result<void> record_batch(int batch);
  core::Result<compare::RecordedRun> record(const std::string& command,
                                            const std::filesystem::path& folder) const;
  core::Result<compare::Instructions> count_instructions() const;
  int compare_instructions() const;

  std::string a_, b_, test_;  // commands or folders; a bare program may count instructions
  std::filesystem::path out_;
  std::size_t pairs_ = 8, aa_ = 0;
  bool json_ = false, instructions_ = false, anyway_ = false;
  telemetry::PullRequestWords words_;
  std::vector<compare::RecordedRun> runs_a_, runs_b_;
};

// The words of a command line, by the shell's rules for blanks, quotes and backslashes; nothing is
// expanded. Fails with kInvalidArgument for an open quote and without a word.
core::Result<std::vector<std::string>> words_of(const std::string& command) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = 0;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    const bool blank = c == ' ' || c == '\t' || c == '\n';
    if (quote == 0 && blank) {
      in_word = false;
      continue;
    }
    if (!std::exchange(in_word, true)) words.emplace_back();
    if (c == '\\' && quote != '\'' && i + 1 < command.size())
      words.back() += command[++i];
    else if (quote == 0 ? c == '\'' || c == '"' : c == quote)
      quote = quote == 0 ? c : 0;
    else
      words.back() += c;
  }
  if (quote != 0) return core::invalid_argument(fmt::format("{}: a quote is open", command));
  if (words.empty()) return core::invalid_argument("an empty command");
  return words;
}

// Waits for a child, the leader of its process group. Once the user interrupts psygen, ends the
// group: with SIGTERM, and with SIGKILL after five seconds.
int status_of(pid_t child, const std::atomic<bool>& stop) {
  constexpr int kPollMs = 50, kPatienceMs = 5000;
  int status = 0, waited_ms = 0;
  for (pid_t ended = 0; (ended = waitpid(child, &status, WNOHANG)) != child;) {
    if (ended < 0 && errno != EINTR) return W_EXITCODE(127, 0);  // the system keeps no statuses
    poll(nullptr, 0, kPollMs);
    if (!stop) continue;
    if (waited_ms == 0) kill(-child, SIGTERM);
    if ((waited_ms += kPollMs) > kPatienceMs) kill(-child, SIGKILL);
  }
  return status;
}

// Runs a program to its end and writes its output to a file. Returns its exit code, or 128 plus the
// number of the signal that ended it. Fails with kIo if it cannot be started, and with kInterrupted
// after a signal to psygen.
core::Result<int> run_program(std::vector<std::string> words, const std::filesystem::path& log) {
  const std::atomic<bool>& stop = stop_at_interrupt();
  const auto child =
      core::start_child(std::move(words), {.out = log, .messages = log, .own_group = true});
  if (!child) return tl::unexpected(child.error());
  const int status = status_of(*child, stop);
  if (stop) return core::fail(core::ErrorCode::kInterrupted, "interrupted");
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool is_folder(const std::string& name) {
  std::error_code error;
  return std::filesystem::is_directory(name, error);
}

constexpr const char* kNoValgrind =
    "it counts instructions (package valgrind); nothing was compared";

// Default work: generators of the paper's world in one thread, without a GPU.
core::Result<std::vector<std::string>> work_of(const std::string& command) {
  const auto words = words_of(command);
  const bool is_program = words && words->size() == 1;
  return is_program ? words_of(command + " amplify --region 0,0,3,3 --threads 1") : words;
}

// Lets programs load a library that replaces an instruction valgrind cannot run (countable.cpp). If
// it is not installed, nothing changes, which is harmless on processors that do not need it.
void preload_stand_in() {
  void* library = dlopen("libpsygen_countable.so", RTLD_LAZY | RTLD_LOCAL);
  link_map* map = nullptr;
  if (library == nullptr || dlinfo(library, RTLD_DI_LINKMAP, &map) != 0) return;
  std::string preloaded = map->l_name;
  if (const char* others = std::getenv("LD_PRELOAD")) preloaded += ":" + std::string(others);
  setenv("LD_PRELOAD", preloaded.c_str(), 1);
}

struct Counted {
  std::uint64_t instructions = 0;
  std::string hash;
};

// Fails with kNoDevice if valgrind cannot count here.
core::Result<Counted> count(const std::string& command, const std::filesystem::path& out,
                            const char* name) {
  const auto profile = out / fmt::format("{}.callgrind", name),
             log = out / fmt::format("{}.txt", name);
  std::vector<std::string> words{"valgrind", "--tool=callgrind",
                                 "--callgrind-out-file=" + profile.string()};
  const auto work = work_of(command);
  if (!work) return tl::unexpected(work.error());
  words.insert(words.end(), work->begin(), work->end());
  const auto code = run_program(words, log);
  if (!code && code.error().code == core::ErrorCode::kInterrupted)
    return tl::unexpected(code.error());
  if (!code)
    return core::fail(core::ErrorCode::kNoDevice,
                      fmt::format("{}; {}", code.error().message, kNoValgrind));
  if (*code == 128 + SIGILL)
    return core::fail(
        core::ErrorCode::kNoDevice,
        fmt::format("{}: valgrind does not support an instruction that it executes on "
                    "this processor; see {}",
                    command, log.string()));
  if (*code != 0)
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("{}: exit code {} under valgrind; its output is in {}", command,
                                  *code, log.string()));
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;
  const auto instructions = compare::instructions_in(
      world::read_text_file(profile, kMaxBytes).value_or(""), profile.string());
  if (!instructions) return tl::unexpected(instructions.error());
  const std::string output = world::read_text_file(log, kMaxBytes).value_or("");
  const std::string hash(compare::hash_in(output));
  if (hash.empty())
    return core::invalid_argument(
        fmt::format("{}: prints no hash, so its result cannot be compared; its output is in {}",
                    command, log.string()));
  return Counted{*instructions, hash};
}

}  // namespace

CompareCommand::CompareCommand(CLI::App& cli)
    : Command(cli, "compare", "Compare frame times and content of two builds") {
  CLI::App& c = *command_;
  c.add_option("A", a_,
               "Baseline: a folder of runs or captures, a capture, or a command like \"old/psygen "
               "test\"")
      ->required();
  c.add_option("B", b_, "Candidate: the same")->required();
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
  c.add_flag("--anyway", anyway_,
             "Compare runs of different machines, devices, presets, sizes or worlds, and say so");
  c.add_flag("--json", json_, "Print the result as JSON");
  frametest::add_words(c, words_);
}

// Prints the result, writes the words for a pull request, and returns the exit code.
int CompareCommand::tell(compare::Verdict verdict, const std::string& text,
                         const compare::Words& words) const {
  const std::string commands = words_.annotations.to_stdout()
                                   ? telemetry::to_text(words_.annotations, words.remarks)
                                   : std::string();
  if (const int printed = print(text + commands); printed != kOk) return printed;
  if (auto ok = words_.write(words.markdown, words.remarks); !ok) return fail_with(ok.error());
  return verdict == compare::Verdict::kWorse ? int{frametest::kMissed} : kOk;
}

// Runs a command once: COMMAND TEST --out FOLDER. A budget that is missed or
// not judged (3, 5) does not count as a failure.
core::Result<compare::RecordedRun> CompareCommand::record(
    const std::string& command, const std::filesystem::path& folder) const {
  if (auto ok = telemetry::create_output_folder(folder); !ok) return tl::unexpected(ok.error());
  auto words = words_of(command);
  if (!words) return tl::unexpected(words.error());
  words->insert(words->end(), {test_, "--out", folder.string()});
  const auto log = folder / "output.txt";
  const auto code = run_program(*words, log);
  if (!code) return tl::unexpected(code.error());
  if (*code != frametest::kHeld && *code != frametest::kMissed && *code != frametest::kNotJudged) {
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
  const auto first = compare::compare(runs_a_, runs_b_, conditions());
  if (!first) return tl::unexpected(first.error());
  const bool sure = first->exact || first->verdict == compare::Verdict::kSame;
  return sure ? core::Result<void>{} : record_batch(2);
}

// A folder, or a file that is no program.
bool CompareCommand::is_recorded(const std::string& side) const {
  std::error_code error;
  if (is_folder(side)) return true;
  if (!test_.empty() || !std::filesystem::is_regular_file(side, error)) return false;
  std::array<char, 4> start{};
  std::ifstream(side, std::ios::binary).read(start.data(), start.size());
  const std::string_view begins(start.data(), start.size());
  return !begins.starts_with("#!") && begins !=
                                          "\x7f"
                                          "ELF";
}

// Returns a usage error, or nothing: requires two folders with runs, or two commands with a test
// and an output folder.
std::string CompareCommand::misuse() const {
  if (is_recorded(a_) && is_recorded(b_)) return {};
  if (!test_.empty() && !out_.empty()) return {};
  std::error_code ignored;
  for (const std::string& side : {a_, b_}) {
    const auto words = words_of(side);
    if (!words) return words.error().message;
    const bool is_path = words->size() == 1 && words->front().find('/') != std::string::npos;
    if (is_path && !std::filesystem::exists(words->front(), ignored))
      return side + ": no such folder or program";
  }
  return "two commands need --test and --out; recorded runs need two folders or captures";
}

int CompareCommand::run() {
  if (json_ && words_.annotations.to_stdout()) {
    core::log_error("--json and --annotations both print; give --annotations a file: github:FILE");
    return kUsage;
  }
  if (auto ok = words_.check(); !ok) return fail_with(ok.error());
  if (instructions_) return compare_instructions();
  if (const std::string sentence = misuse(); !sentence.empty()) {
    core::log_error(sentence);
    return kUsage;
  }
  if (is_recorded(a_) && is_recorded(b_) &&
      (compare::holds_captures(a_) || compare::holds_captures(b_)))
    return compare_times();
  const auto result =
      collect().and_then([this] { return compare::compare(runs_a_, runs_b_, conditions()); });
  core::Result<compare::FalseAlarms> alarms = compare::FalseAlarms{};
  if (result && aa_ > 0) alarms = compare::measure_false_alarms(runs_a_, aa_, 1);
  if (!result || !alarms) {
    const core::Error& error = result ? alarms.error() : result.error();
    return fail_with(error);
  }
  const compare::FalseAlarms* measured = aa_ > 0 ? &*alarms : nullptr;
  const std::string json = compare::to_json(*result, measured);
  if (!out_.empty()) {
    const std::string page = compare::to_html(*result, runs_a_, runs_b_, {a_, b_, test_}, measured);
    if (auto ok = write(json, page); !ok) return fail_with(ok.error());
  }
  return tell(result->verdict, json_ ? json : compare::to_text(*result, measured),
              compare::words_of(*result, test_));
}

// Writes compare.json and compare.html to --out.
core::Result<void> CompareCommand::write(const std::string& json, const std::string& page) const {
  return telemetry::create_output_folder(out_)
      .and_then([&] { return core::replace_file(out_ / "compare.json", json); })
      .and_then([&] { return core::replace_file(out_ / "compare.html", page); });
}

// Compares captures of other tools, and runs by their times alone.
int CompareCommand::compare_times() const {
  if (aa_ > 0) {
    core::log_error("--aa needs folders of psygen's runs, not captures");
    return kUsage;
  }
  auto a = compare::read_times(a_);
  if (!a) return fail_with(a.error());
  auto b = compare::read_times(b_);
  if (!b) return fail_with(b.error());
  const auto result = compare::compare_times(std::move(*a), std::move(*b));
  if (!result) return fail_with(result.error());
  const std::string json = compare::to_json(*result);
  if (!out_.empty()) {
    if (auto ok = write(json, compare::to_html(*result)); !ok) return fail_with(ok.error());
  }
  return tell(result->verdict, json_ ? json : compare::to_text(*result),
              compare::words_of(*result));
}

core::Result<compare::Instructions> CompareCommand::count_instructions() const {
  if (out_.empty()) return core::invalid_argument("--instructions needs --out");
  if (auto ok = telemetry::create_output_folder(out_); !ok) return tl::unexpected(ok.error());
  preload_stand_in();
  const auto a = count(a_, out_, "a");
  if (!a) return tl::unexpected(a.error());
  const auto b = count(b_, out_, "b");
  if (!b) return tl::unexpected(b.error());
  if (a->hash != b->hash)
    return core::invalid_argument(
        fmt::format("the outputs differ (hashes '{}' and '{}'), so the "
                    "instruction counts are not comparable",
                    a->hash, b->hash));
  return compare::Instructions{a->instructions, b->instructions};
}

// Returns 0; 3 if B executes over 1 % more instructions; 77 if valgrind is missing or cannot run a
// command; otherwise 1.
int CompareCommand::compare_instructions() const {
  const auto counted = count_instructions();
  if (!counted) {
    core::log_error(counted.error().message);
    return counted.error().code == core::ErrorCode::kNoDevice ? int{frametest::kSkipped}
                                                              : exit_code_of(counted.error());
  }
  const std::string json = compare::to_json(*counted);
  if (auto ok = core::replace_file(out_ / "compare.json", json); !ok) {
    core::log_error(ok.error().message);
    return kFailed;
  }
  return tell(counted->verdict(), json_ ? json : compare::to_text(*counted),
              compare::words_of(*counted));
}

std::unique_ptr<Command> make_compare_command(CLI::App& cli) {
  return std::make_unique<CompareCommand>(cli);
}

}  // namespace psygen::cli
