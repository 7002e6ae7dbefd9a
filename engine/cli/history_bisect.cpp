#include "engine/cli/history_bisect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <system_error>

#include "engine/cli/commands.hpp"
#include "engine/core/child_process.hpp"
#include "engine/core/log.hpp"
#include "engine/history/additions.hpp"
#include "engine/history/check.hpp"
#include "engine/history/gate.hpp"
#include "engine/history/store.hpp"
#include "engine/telemetry/output_file.hpp"

namespace psygen::cli {
namespace {

namespace fs = std::filesystem;
using history::Entry;
using Words = std::vector<std::string>;

// Exit codes of a judgement, by `man git-bisect`.
constexpr int kGood = 0, kBad = 1, kSkip = 125, kStop = 128;

// Runs a program with this program's streams. Returns its exit code, 128 and the number of the
// signal that ended it, or nothing if it cannot be started.
std::optional<int> run_program(Words words) {
  std::fflush(stdout);
  const auto child = core::start_child(std::move(words));
  if (!child) {
    core::log_error(child.error().message);
    return std::nullopt;
  }
  int status = 0;
  while (waitpid(*child, &status, 0) < 0)
    if (errno != EINTR) return std::nullopt;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// The first line that a command of git prints; empty if it fails.
std::string git_line(const std::string& arguments) {
  std::string line;
  FILE* const pipe = popen(("git " + arguments + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return line;
  std::array<char, 4096> buffer{};
  if (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) line = buffer.data();
  const bool failed = pclose(pipe) != 0;
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r'))
    line.pop_back();
  return failed ? std::string() : line;
}

// Only names that the shell takes as they are.
bool is_plain(const std::string& name) {
  return !name.empty() && name.front() != '-' && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("._-/~^@{}").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

// The full name of a commit; empty if there is none.
std::string commit_of(const std::string& name) {
  return is_plain(name) ? git_line("rev-parse --verify --quiet '" + name + "^{commit}'") : "";
}

// True if an entry's revision abbreviates this commit, with seven digits or more.
bool is_of(const Entry& entry, const std::string& commit) {
  constexpr std::size_t kShortest = 7;
  return entry.revision.size() >= kShortest && commit.starts_with(entry.revision);
}

bool is_usable(const Entry& entry) {
  return history::is_usable(entry, history::rule_of(entry.figure, entry.unit));
}

// Usable entries of the judged figure and fingerprint.
std::vector<const Entry*> entries_of(const std::vector<Entry>& all, const std::string& commit,
                                     const Entry& like) {
  std::vector<const Entry*> found;
  for (const Entry& entry : all)
    if (entry.test == like.test && entry.figure == like.figure && entry.unit == like.unit &&
        entry.fingerprint == like.fingerprint && is_of(entry, commit) && is_usable(entry))
      found.push_back(&entry);
  return found;
}

// The runs of the commit that is checked out; each is an entry of its own.
core::Result<std::vector<Entry>> run_commit(const BisectOptions& options, const fs::path& folder) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < options.runs; ++i) {
    const fs::path out = folder / fmt::format("run_{}", i + 1);
    if (auto ok = telemetry::create_output_folder(out); !ok) return tl::unexpected(ok.error());
    setenv("PSYGEN_OUT", out.c_str(), 1);
    const auto code = run_program(options.command);
    if (!code || *code != 0)
      return core::fail(core::ErrorCode::kNotReady,
                        fmt::format("the command ends with {}", code.value_or(127)));
    const std::array paths = {out};
    const auto additions = history::read_additions(
        paths,
        {.test = options.test, .revision = "HEAD", .machine = options.machine, .figures = {}});
    if (!additions) return tl::unexpected(additions.error());
    for (const Entry& entry : additions->entries)
      if (entry.figure == options.figure && is_usable(entry)) entries.push_back(entry);
  }
  if (entries.empty()) return core::invalid_argument("the runs have no value of " + options.figure);
  return entries;
}

double median_on_scale(const history::FigureRule& rule, const std::vector<const Entry*>& entries) {
  std::vector<double> values;
  values.reserve(entries.size());
  for (const Entry* entry : entries)
    values.push_back(rule.logarithms ? std::log(*entry->value) : *entry->value);
  return history::median(values);
}

// Good or bad by the entries of the good commit: by the middle between them and those of the bad
// one, if there are any, else by the gate.
int judge(const BisectOptions& options, const std::vector<Entry>& all,
          const std::vector<Entry>& runs) {
  const std::string good_commit = commit_of(options.good);
  // The command may fly other tests, too: the runs that GOOD has entries of count.
  const auto known = std::ranges::find_if(
      runs, [&](const Entry& run) { return !entries_of(all, good_commit, run).empty(); });
  const Entry& like = known != runs.end() ? *known : runs.front();
  const auto rule = history::rule_of(like.figure, like.unit);
  const auto good = entries_of(all, good_commit, like);
  const auto bad = entries_of(all, commit_of(options.bad), like);
  std::vector<const Entry*> now;
  now.reserve(runs.size());
  for (const Entry& run : runs)
    if (run.fingerprint == like.fingerprint && run.unit == like.unit) now.push_back(&run);
  if (good.empty()) {
    core::log_error(
        fmt::format("the history has no {} of {} at {} under the conditions of this "
                    "machine ({})",
                    options.figure, options.test, options.good, like.fingerprint));
    return kStop;
  }
  const double here = median_on_scale(rule, now), there = median_on_scale(rule, good);
  const std::string change = history::change_text(rule, here - there);
  if (!bad.empty()) {
    const double step = median_on_scale(rule, bad) - there;
    const bool is_bad = std::abs(here - there) > std::abs(step) / 2 && (here > there) == (step > 0);
    std::printf("psygen history: %s %s against %.12s: %s (%.12s is %s)\n", options.figure.c_str(),
                change.c_str(), options.good.c_str(), is_bad ? "bad" : "good", options.bad.c_str(),
                history::change_text(rule, step).c_str());
    return is_bad ? kBad : kGood;
  }
  history::RankTails tails;
  const auto verdict =
      history::judge(rule, history::observations_of(good), history::observations_of(now), 1, tails);
  std::printf("psygen history: %s %s: %s: %s\n", options.figure.c_str(), change.c_str(),
              std::string(history::name_of(verdict.outcome)).c_str(), verdict.reason.c_str());
  switch (verdict.outcome) {
    case history::Outcome::kWorse:
      return kBad;
    case history::Outcome::kSame:
    case history::Outcome::kBetter:
      return kGood;
    default:
      return kSkip;
  }
}

// Fails with a sentence if the history cannot judge the good commit.
core::Result<void> check_history(const BisectOptions& options, const std::string& good) {
  const auto store = history::Store::open_to_read(options.history);
  if (!store) return tl::unexpected(store.error());
  const auto entries = store->read();
  if (!entries) return tl::unexpected(entries.error());
  for (const Entry& entry : *entries)
    if (entry.test == options.test && entry.figure == options.figure && entry.value &&
        is_of(entry, good))
      return {};
  return core::invalid_argument(
      fmt::format("{}: no {} of {} at {} ({}), which judges the other commits",
                  options.history.string(), options.figure, options.test, options.good, good));
}

Words judge_words(const BisectOptions& options, const std::string& good, const std::string& bad) {
  std::error_code error;
  const std::string program = fs::read_symlink("/proc/self/exe", error).string();
  Words words = {program,
                 "history",
                 "judge-commit",
                 "--history",
                 fs::absolute(options.history, error).string(),
                 "--test",
                 options.test,
                 "--figure",
                 options.figure,
                 "--runs",
                 fmt::format("{}", options.runs)};
  if (!options.machine.empty()) words.insert(words.end(), {"--machine", options.machine});
  words.insert(words.end(), {good, bad, "--"});
  words.insert(words.end(), options.command.begin(), options.command.end());
  return words;
}

}  // namespace

int judge_bisected_commit(const BisectOptions& options) {
  const std::atomic<bool>& stop = stop_at_interrupt();
  const auto store = history::Store::open_to_read(options.history);
  const auto all = store ? store->read() : tl::unexpected(store.error());
  if (!all) {
    core::log_error(all.error().message);
    return kStop;
  }
  std::string pattern = (fs::temp_directory_path() / "psygen_bisect_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    core::log_error(fmt::format("{}: {}", pattern, std::generic_category().message(errno)));
    return kStop;
  }
  const auto runs = run_commit(options, pattern);
  std::error_code ignored;
  fs::remove_all(pattern, ignored);
  if (!runs) {
    core::log_error(runs.error().message);
    return runs.error().code == core::ErrorCode::kNotReady && !stop ? kSkip : kStop;
  }
  return judge(options, *all, *runs);
}

int run_bisect(const BisectOptions& options) {
  const std::string good = commit_of(options.good), bad = commit_of(options.bad);
  for (const auto& [name, commit] : {std::pair(options.good, good), std::pair(options.bad, bad)})
    if (commit.empty()) {
      core::log_error(fmt::format("{}: no commit of the repository in this folder", name));
      return kFailed;
    }
  if (auto ok = check_history(options, good); !ok) return fail_with(ok.error());
  std::printf(
      "psygen history: at each commit between %.12s and %.12s, git runs %zu times:\n  %s\n"
      "and psygen judges %s of %s by the entries of %.12s in %s\n",
      good.c_str(), bad.c_str(), options.runs,
      fmt::format("{}", fmt::join(options.command, " ")).c_str(), options.figure.c_str(),
      options.test.c_str(), good.c_str(), options.history.c_str());
  (void)stop_at_interrupt();  // git ends at Ctrl+C; the tree is reset all the same
  if (run_program({"git", "bisect", "start", bad, good}) != 0) return kFailed;
  Words words = {"git", "bisect", "run"};
  const Words step = judge_words(options, good, bad);
  words.insert(words.end(), step.begin(), step.end());
  const bool found = run_program(words) == 0;
  const std::string first = git_line("log -1 --format='%h %s' refs/bisect/bad");
  (void)run_program({"git", "bisect", "reset"});
  if (!found) {
    core::log_error("git bisect found no commit; its messages are above");
    return kFailed;
  }
  return print(fmt::format("\nfirst worse commit: {}\n", first));
}

}  // namespace psygen::cli
