// psygen history as users run it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kSeries = "tests/engine/history/series.csv";

Outcome history(const std::string& arguments, const TemporaryFolder& folder,
                const std::string& environment = "") {
  return run_psygen("history " + arguments + " --history " + (folder / "h.sqlite").string(),
                    environment);
}

TEST(History, IsNotReplacedByItsOwnOutputs) {
  const TemporaryFolder folder;
  const std::string file = (folder / "h.sqlite").string();
  ASSERT_EQ(history(std::string("import ") + kSeries, folder).code, 0);
  const std::string before = read(file);
  for (const std::string& command : std::initializer_list<std::string>{
           "export --out " + file, "show --html " + file, "check --markdown " + file,
           "check --annotations github:" + file}) {
    const Outcome refused = history(command, folder);
    EXPECT_EQ(refused.code, 1) << command;
    EXPECT_THAT(refused.err, HasSubstr("is read here, and is not replaced")) << command;
  }
  EXPECT_TRUE(read(file) == before);
}

TEST(History, ImportedEntriesAreShownJudgedAndExported) {
  const TemporaryFolder folder;
  const Outcome imported = history(std::string("import ") + kSeries, folder);
  ASSERT_EQ(imported.code, 0) << imported.err;
  EXPECT_THAT(imported.out, HasSubstr("missing_values: 6 values are missing or not a number"));
  const Outcome worse = history(
      "check --test cpu_5_percent_20_and_5 --markdown " + (folder / "words.md").string(), folder);
  EXPECT_EQ(worse.code, 3) << worse.out << worse.err;
  EXPECT_THAT(worse.out, StartsWith("verdict: worse\n"));
  EXPECT_THAT(read(folder / "words.md"), HasSubstr("## History: worse"));
  EXPECT_EQ(history("check --test better_10_percent", folder).code, 0);
  const Outcome noisy = history(
      "check --test wall_15_percent_lost_in_noise --figure frame_ms.p99 "
      "--annotations github",
      folder);
  EXPECT_EQ(noisy.code, 0);
  EXPECT_THAT(noisy.out, HasSubstr("verdict: undecided"));
  EXPECT_THAT(noisy.out, HasSubstr("\n::warning"));
  const Outcome shown = history("show --html " + (folder / "page/h.html").string(), folder);
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("clock_goes_back: the clock goes back"));
  EXPECT_THAT(read(folder / "page/h.html"), HasSubstr("</html>"));
  const Outcome csv = history("export", folder), lines = history("export --format jsonl", folder);
  std::ofstream(folder / "again.jsonl") << lines.out;
  const std::string other = " --history " + (folder / "again.sqlite").string();
  ASSERT_EQ(run_psygen("history import " + (folder / "again.jsonl").string() + other).code, 0);
  EXPECT_EQ(run_psygen("history export" + other).out, csv.out) << "every bit survives";
}

TEST(History, BadInputIsRefusedWithItsName) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& arguments, int code, const std::string& message) {
    const Outcome outcome = history(arguments, folder);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << arguments;
  };
  refused("check", 1, "h.sqlite: cannot be opened: No such file or directory");
  refused("add nothing", 1, "nothing");
  refused("check --last 4", 2, "'4' is not a whole number from 5 to 40");
  refused("check --last 5 --revision r", 2, "excludes");
  refused("check --json --annotations gitlab", 2, "both print");
  refused("chekc", 2, "unknown command 'chekc'; did you mean check?");
  refused("export --format xml", 2, "'xml' is unknown; allowed are csv, jsonl");
  refused("bisect a b --test t --figure f", 2, "COMMAND");
  EXPECT_EQ(run_psygen("history").code, 2);
  EXPECT_THAT(run_psygen("history").err, HasSubstr("a command is missing"));
  std::ofstream(folder / "h.sqlite") << "no database, but a text of some length " << kSeries;
  refused("show", 1, "h.sqlite");
  EXPECT_EQ(read(folder / "h.sqlite"),
            std::string("no database, but a text of some length ") + kSeries);
}

TEST(History, AFullDiskIsAMessage) {
  const TemporaryFolder folder;
  ASSERT_EQ(history(std::string("import ") + kSeries, folder).code, 0);
  const std::string before = history("export", folder).out;
  const std::string full =
      "LD_PRELOAD=" PSYGEN_FAULTS " PSYGEN_CALLS_LEFT=0 PSYGEN_FULL_DISK=" + folder.path().string();
  const Outcome outcome = history("export --out " + (folder / "out.csv").string(), folder, full);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("No space left"));
  EXPECT_EQ(history("export", folder).out, before);
}

// A repository with eight commits: from the fifth on, the program takes 5 % more instructions.
// The third does not build.
constexpr const char* kMakeRepository = R"(set -e
git init -q -b main . && git config user.email a@b.c && git config user.name A
cat > job.sh <<'END'
set -e
test ! -e broken
printf '# callgrind format\nevents: Ir\ntotals: %s\n' $((1000000 * $(cat work) / 100)) > "$PSYGEN_OUT/job.callgrind"
END
for i in 1 2 3 4 5 6 7 8; do
  if [ $i -ge 5 ]; then echo 105 > work; else echo 100 > work; fi
  if [ $i = 3 ]; then touch broken; elif [ $i = 4 ]; then git rm -q broken; fi
  echo $i > step && git add . && git commit -q -m "commit $i"
done
)";

class Bisect : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(repository_);
    ASSERT_EQ(shell(kMakeRepository), 0);
  }
  int shell(const std::string& script) const {
    std::ofstream(folder_ / "script.sh") << script;
    return std::system(fmt::format("cd '{}' && {} sh '{}' >'{}' 2>&1", repository_.string(), kClean,
                                   (folder_ / "script.sh").string(),
                                   (folder_ / "script.txt").string())
                           .c_str());
  }
  std::string commit(const std::string& name) const {
    shell("git rev-parse --short=12 " + name);
    std::string text = read(folder_ / "script.txt");
    text.pop_back();
    return text;
  }
  // Entries of a commit, as its jobs would have added them.
  void add(const std::string& name, int instructions) const {
    std::string rows = "test,figure,value,revision,fingerprint\n";
    for (int i = 0; i < 5; ++i)
      rows += fmt::format("job,instructions,{},{},counter: callgrind; CPU: bench\n", instructions,
                          commit(name));
    std::ofstream(folder_ / "rows.csv") << rows;
    ASSERT_EQ(history("import " + (folder_ / "rows.csv").string(), folder_).code, 0);
  }
  Outcome bisect(const std::string& good, const std::string& command) const {
    return run_psygen("history bisect " + good +
                          " main --test job --figure instructions --machine bench --history " +
                          (folder_ / "h.sqlite").string() + " -- " + command,
                      kClean, repository_);
  }
  // Hooks of git set these.
  static constexpr const char* kClean =
      "env -u GIT_DIR -u GIT_WORK_TREE -u GIT_INDEX_FILE GIT_CONFIG_GLOBAL=/dev/null";

  TemporaryFolder folder_;
  std::filesystem::path repository_ = folder_ / "repository";
};

TEST_F(Bisect, FindsTheCommitThatMadeAFigureWorse) {
  add("main~7", 1'000'000);
  const Outcome found = bisect("main~7", "sh job.sh");
  EXPECT_EQ(found.code, 0) << found.out << found.err;
  EXPECT_THAT(found.out, HasSubstr("git runs 5 times:\n  sh job.sh"));
  EXPECT_THAT(found.out, HasSubstr("first worse commit: "));
  EXPECT_THAT(found.out, ::testing::EndsWith("commit 5\n"));
  EXPECT_EQ(commit("HEAD"), commit("main")) << "the tree is as before";
}

TEST_F(Bisect, UsesTheEntriesOfTheBadCommit) {
  add("main~7", 1'000'000);
  add("main", 1'050'000);
  const Outcome found = bisect("main~7", "sh job.sh");
  EXPECT_EQ(found.code, 0) << found.out << found.err;
  EXPECT_THAT(found.out,
              ::testing::ContainsRegex(
                  "\\+5\\.0 % against [0-9a-f]{12}: bad \\([0-9a-f]{12} is \\+5\\.0 %\\)"));
  EXPECT_THAT(found.out, ::testing::EndsWith("commit 5\n"));
}

TEST_F(Bisect, NeedsTheGoodCommitInTheHistory) {
  add("main", 1'050'000);
  const Outcome without = bisect("main~7", "sh job.sh");
  EXPECT_EQ(without.code, 1);
  EXPECT_THAT(without.err, HasSubstr("no instructions of job at main~7"));
  const Outcome unknown = bisect("nothing", "sh job.sh");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("nothing: no commit of the repository in this folder"));
}

}  // namespace
}  // namespace psygen::cli
