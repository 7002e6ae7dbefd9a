// `psygen history`: keeps the figures of runs, shows them, and judges the last revision
// (docs/frame-tests.md, "History").
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/cli/commands.hpp"
#include "engine/cli/history_bisect.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/frametest/run.hpp"
#include "engine/history/additions.hpp"
#include "engine/history/check.hpp"
#include "engine/history/exchange.hpp"
#include "engine/history/show.hpp"
#include "engine/history/store.hpp"
#include "engine/telemetry/output_file.hpp"

namespace psygen::cli {
namespace {

namespace fs = std::filesystem;

std::int64_t now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class HistoryCommand final : public Command {
 public:
  explicit HistoryCommand(CLI::App& cli);
  int run() override;

 private:
  CLI::App* add_subcommand(const char* name, const char* description,
                           int (HistoryCommand::*action)());
  void declare_add();
  void declare_show();
  void declare_check();
  void declare_exchange();
  void declare_bisect();

  int add();
  int show();
  int check();
  int rename();
  int import();
  int export_entries();
  int bisect();
  int judge_commit();
  core::Result<std::vector<history::Entry>> read() const;
  core::Result<void> check_output(const fs::path& file) const;
  core::Result<void> write_page(const history::Shown& shown) const;

  fs::path file_ = "history.sqlite", html_, from_, to_;
  std::vector<std::string> paths_, tests_, figures_, names_;
  history::AddOptions add_;
  history::CheckOptions check_;
  BisectOptions bisect_;
  std::string format_ = "csv";
  bool json_ = false;
  telemetry::PullRequestWords words_;
  std::vector<std::pair<CLI::App*, int (HistoryCommand::*)()>> actions_;
};

HistoryCommand::HistoryCommand(CLI::App& cli)
    : Command(cli, "history", "Keep the figures of runs, and find changes in them") {
  command_->require_subcommand(1);
  declare_add();
  declare_show();
  declare_check();
  declare_exchange();
  declare_bisect();
}

CLI::App* HistoryCommand::add_subcommand(const char* name, const char* description,
                                         int (HistoryCommand::*action)()) {
  CLI::App* sub = command_->add_subcommand(name, description);
  sub->add_option("--history", file_, "File of the history")->capture_default_str();
  actions_.emplace_back(sub, action);
  return sub;
}

void HistoryCommand::declare_add() {
  CLI::App& c = *add_subcommand("add", "Add runs of one job", &HistoryCommand::add);
  c.add_option("RUN", paths_,
               "Folders of runs, summaries, captures, or outputs of callgrind; runs of one test "
               "become one entry, their median")
      ->required();
  c.add_option("--test", add_.test, "Name of the test; default: the folder");
  c.add_option("--revision", add_.revision, "Revision of the program; default: that of the build");
  c.add_option("--machine", add_.machine,
               "Name of the machine, for captures and outputs of callgrind");
  c.add_option("--figure", add_.figures,
               "Another number of summary.json to keep; may be given several times");
  c.add_option("--time", add_.time, "Unix seconds; default: now")
      ->transform(integer_between(0, std::int64_t{1} << 40));
}

void HistoryCommand::declare_show() {
  CLI::App& c =
      *add_subcommand("show", "Show all figures and their changes", &HistoryCommand::show);
  c.add_option("--test", tests_, "Only this test; may be given several times");
  c.add_option("--figure", figures_, "Only this figure; may be given several times");
  c.add_option("--html", html_, "Write a page with a plot of each figure to this file");
}

void HistoryCommand::declare_check() {
  CLI::App& c = *add_subcommand("check", "Judge the last revision by the entries before it",
                                &HistoryCommand::check);
  c.add_option("--test", check_.tests, "Only this test; may be given several times");
  c.add_option("--figure", check_.figures,
               "A figure that decides; may be given several times; default: instructions, "
               "load.cpu_seconds and frame_ms.p50");
  auto* revision = c.add_option("--revision", check_.revision,
                                "Revision to judge; default: the last one of each test");
  c.add_option("--last", check_.last, "Judge so many last entries, whatever their revisions")
      ->transform(integer_between(history::kFewestRuns, history::kMaxBefore))
      ->excludes(revision);
  c.add_flag("--confirm", check_.confirm,
             "A change counts only with a second look: ten entries of the revision");
  c.add_flag("--json", json_, "Print the result as JSON");
  frametest::add_words(c, words_);
}

void HistoryCommand::declare_exchange() {
  CLI::App& r = *add_subcommand("rename", "Give a test a new name", &HistoryCommand::rename);
  r.add_option("OLD", names_, "Old and new name")->required()->expected(2);
  CLI::App& i =
      *add_subcommand("import", "Add entries from CSV or JSON lines", &HistoryCommand::import);
  i.add_option("FILE", from_, "File with a row for each figure of each entry")->required();
  CLI::App& e = *add_subcommand("export", "Write all entries", &HistoryCommand::export_entries);
  e.add_option("--format", format_, "csv, or jsonl: a JSON object on each line")
      ->capture_default_str()
      ->check(one_of({"csv", "jsonl"}));
  e.add_option("--out", to_, "File; default: stdout");
}

void HistoryCommand::declare_bisect() {
  for (const bool step : {false, true}) {
    CLI::App& c =
        step ? *add_subcommand("judge-commit", "A step of bisect", &HistoryCommand::judge_commit)
             : *add_subcommand("bisect", "Find the commit that made a figure worse",
                               &HistoryCommand::bisect);
    c.add_option("GOOD", bisect_.good, "Commit with entries in the history, before the change")
        ->required();
    c.add_option("BAD", bisect_.bad, "Commit after the change")->required();
    c.add_option("COMMAND", bisect_.command,
                 "After --: builds the commit and writes runs into $PSYGEN_OUT")
        ->required();
    c.add_option("--test", bisect_.test, "Test of the history")->required();
    c.add_option("--figure", bisect_.figure, "Figure that decides")->required();
    c.add_option("--runs", bisect_.runs, "Runs of each commit")
        ->capture_default_str()
        ->transform(integer_between(1, history::kMaxBefore));
    c.add_option("--machine", bisect_.machine, "As for psygen history add");
    if (step) c.group("");  // git calls it; not listed in the help
  }
}

int HistoryCommand::run() {
  for (const auto& [sub, action] : actions_)
    if (sub->parsed()) return (this->*action)();
  return kUsage;
}

core::Result<std::vector<history::Entry>> HistoryCommand::read() const {
  const auto store = history::Store::open_to_read(file_);
  if (!store) return tl::unexpected(store.error());
  return store->read();
}

int HistoryCommand::add() {
  if (add_.time == 0) add_.time = now_s();
  const std::vector<fs::path> paths(paths_.begin(), paths_.end());
  const auto additions = history::read_additions(paths, add_);
  if (!additions) return fail_with(additions.error());
  auto store = history::Store::open(file_);
  if (!store) return fail_with(store.error());
  const auto first = store->add(additions->entries);
  if (!first) return fail_with(first.error());
  std::string text;
  std::int64_t order = 0;
  for (const history::Entry& entry : additions->entries) {
    if (entry.order == order) continue;
    order = entry.order;
    text += fmt::format("{}: entry {} at {}\n", entry.test, *first + order - 1, entry.revision);
  }
  text += fmt::format("{} run{}\n", additions->runs, additions->runs == 1 ? "" : "s");
  for (const std::string& note : additions->notes)
    text += fmt::format("note: {}\n", note);
  return print(text);
}

// Outputs never replace the history.
core::Result<void> HistoryCommand::check_output(const fs::path& file) const {
  const std::array inputs{file_};
  if (auto ok = telemetry::check_no_input(file, inputs); !ok) return ok;
  return telemetry::check_output_file(file);
}

core::Result<void> HistoryCommand::write_page(const history::Shown& shown) const {
  // Reports were added by paths from the current folder.
  std::error_code error;
  const fs::path folder = fs::absolute(html_, error).parent_path();
  std::string base = fs::current_path(error).lexically_relative(folder).string();
  if (base == ".") base.clear();
  return check_output(html_).and_then(
      [&] { return core::replace_file(html_, history::to_html(shown, file_.string(), base)); });
}

int HistoryCommand::show() {
  const auto entries = read();
  if (!entries) return fail_with(entries.error());
  const auto shown = history::analyse(*entries, tests_, figures_);
  if (!shown) return fail_with(shown.error());
  if (!html_.empty())
    if (auto ok = write_page(*shown); !ok) return fail_with(ok.error());
  return print(history::to_text(*shown));
}

int HistoryCommand::check() {
  if (json_ && words_.annotations.to_stdout()) {
    core::log_error("--json and --annotations both print; give --annotations a file: github:FILE");
    return kUsage;
  }
  for (const fs::path& file : {words_.markdown, words_.annotations.file})
    if (auto ok = file.empty() ? core::Result<void>() : check_output(file); !ok)
      return fail_with(ok.error());
  const auto entries = read();
  if (!entries) return fail_with(entries.error());
  const auto result = history::check(*entries, check_);
  if (!result) return fail_with(result.error());
  const auto remarks = history::remarks_of(*result);
  std::string text = json_ ? history::to_json(*result) : history::to_text(*result);
  if (words_.annotations.to_stdout()) text += telemetry::to_text(words_.annotations, remarks);
  if (auto ok = words_.write(history::to_markdown(*result), remarks); !ok)
    return fail_with(ok.error());
  const int printed = print(text);
  if (printed != kOk) return printed;
  return result->outcome == history::Outcome::kWorse ? int{frametest::kMissed} : kOk;
}

int HistoryCommand::rename() {
  auto store = history::Store::open_to_read(file_);  // makes no new one
  if (!store) return fail_with(store.error());
  const auto count = store->rename(names_[0], names_[1]);
  if (!count) return fail_with(count.error());
  return print(fmt::format("{} entries of {} are now of {}\n", *count, names_[0], names_[1]));
}

int HistoryCommand::import() {
  const auto rows = history::read_entries(from_);
  if (!rows) return fail_with(rows.error());
  auto store = history::Store::open(file_);
  if (!store) return fail_with(store.error());
  if (const auto ok = store->add(rows->entries); !ok) return fail_with(ok.error());
  std::string text = fmt::format("{} figures\n", rows->entries.size());
  for (const std::string& note : rows->notes)
    text += fmt::format("note: {}\n", note);
  return print(text);
}

int HistoryCommand::export_entries() {
  const auto entries = read();
  if (!entries) return fail_with(entries.error());
  const std::string text =
      history::to_text(*entries, format_ == "csv" ? history::ExchangeFormat::kCsv
                                                  : history::ExchangeFormat::kJsonLines);
  if (to_.empty()) return print(text);
  const auto ok = check_output(to_).and_then([&] { return core::replace_file(to_, text); });
  return ok ? int{kOk} : fail_with(ok.error());
}

int HistoryCommand::bisect() {
  bisect_.history = file_;
  return run_bisect(bisect_);
}

int HistoryCommand::judge_commit() {
  bisect_.history = file_;
  return judge_bisected_commit(bisect_);
}

}  // namespace

std::unique_ptr<Command> make_history_command(CLI::App& cli) {
  return std::make_unique<HistoryCommand>(cli);
}

}  // namespace psygen::cli
