// `psygen convert` and `psygen compare` on files and programs that need no GPU.
#include <sys/stat.h>

#include <fstream>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

void write_run(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "frames.csv")
      << "frame_ms,present_ms,gpu_ms,cache_bytes,apart\n10,0,0,0,\n";
  std::ofstream(folder / "summary.json") << R"({"device": {"name": "paper and pencil"}})";
}

TEST(Convert, WritesTheFramesOfARunForAViewer) {
  const TemporaryFolder folder;
  write_run(folder / "run");
  const std::string run = (folder / "run").string(), out = (folder / "log.csv").string();
  const Outcome done = run_psygen("convert " + run + " --to mangohud --out " + out);
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(mentions(read(out), "paper and pencil")) << read(out);
  EXPECT_TRUE(mentions(read(out), "\n100.0000,10.0000,")) << read(out);
  EXPECT_EQ(run_psygen("convert " + run + " --to capframex --out " + out).code, 0);
  EXPECT_TRUE(read(out).starts_with("Application,"));
}

TEST(Convert, KeepsTheRunThatItReads) {
  const TemporaryFolder folder;
  write_run(folder / "run");
  const std::string run = (folder / "run").string(), frames = run + "/frames.csv";
  const std::string before = read(frames);
  const Outcome refused = run_psygen("convert " + run + " --to mangohud --out " + frames);
  EXPECT_EQ(refused.code, 1);
  EXPECT_TRUE(mentions(refused.err, "is read here, and is not replaced")) << refused.err;
  EXPECT_EQ(read(frames), before);
}

TEST(Convert, ReportsUnreadableUnwritableAndUnknownArguments) {
  const TemporaryFolder folder;
  write_run(folder / "run");
  const std::string run = (folder / "run").string();
  const Outcome none = run_psygen("convert /nowhere --to mangohud --out log.csv");
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(mentions(none.err, "/nowhere/frames.csv: No such file")) << none.err;
  const Outcome unwritable = run_psygen("convert " + run + " --to mangohud --out /nowhere/log.csv");
  EXPECT_EQ(unwritable.code, 1);
  EXPECT_TRUE(mentions(unwritable.err, "/nowhere/log.csv")) << unwritable.err;
  EXPECT_EQ(run_psygen("convert " + run + " --to excel --out log.csv").code, 2);
}

// Replaces valgrind: writes the last word as the number of instructions.
std::string path_with(const TemporaryFolder& folder, const std::string& script) {
  std::filesystem::create_directories(folder / "bin");
  std::ofstream(folder / "bin/valgrind") << "#!/bin/sh\n" << script;
  std::filesystem::permissions(folder / "bin/valgrind", std::filesystem::perms::owner_all);
  return "PATH=" + (folder / "bin").string() + ":$PATH";
}
constexpr const char* kCounts =
    "for word; do case $word in --callgrind-out-file=*) file=${word#*=};; esac; done\n"
    "echo \"totals: $word\" > $file\n[ $word = 7 ] && echo hash 0007 || echo hash 0001\n";

Outcome compare(const TemporaryFolder& folder, const std::string& script, const std::string& a,
                const std::string& b) {
  return run_psygen(
      "compare --instructions '" + a + "' '" + b + "' --out " + (folder / "out").string(),
      path_with(folder, script));
}

TEST(Instructions, OfTwoCommandsGiveAVerdictAndAnExitCode) {
  const TemporaryFolder folder;
  const Outcome same = compare(folder, kCounts, "a 1000", "b 1009");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_TRUE(mentions(same.out, "verdict: same")) << same.out;
  EXPECT_TRUE(mentions(read(folder / "out/compare.json"), "\"b\": 1009"));
  const Outcome worse = compare(folder, kCounts, "a 1000", "b 1011");
  EXPECT_EQ(worse.code, 3);
  EXPECT_TRUE(mentions(worse.out, "+1.10 %")) << worse.out;
}

TEST(Instructions, OfDifferentOutputsAreNotCompared) {
  const TemporaryFolder folder;
  const Outcome other = compare(folder, kCounts, "a 7", "b 8");
  EXPECT_EQ(other.code, 1);
  EXPECT_TRUE(mentions(other.err, "hashes '0007' and '0001'")) << other.err;
  EXPECT_EQ(compare(folder, "exit 5", "a 7", "b 7").code, 1) << "a command that fails";
  const std::string silent =
      std::string(kCounts).substr(0, std::string(kCounts).find("\n[")) + "\n";
  const Outcome none = compare(folder, silent, "a 1000", "b 1000");
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(mentions(none.err, "a 1000: prints no hash")) << none.err;
}

TEST(Instructions, AreSkippedWithAMessageIfValgrindCannotCount) {
  const TemporaryFolder folder;
  const Outcome unknown = compare(folder, "kill -ILL $$", "a 1000", "b 1000");
  EXPECT_EQ(unknown.code, 77);
  EXPECT_TRUE(mentions(unknown.err, "does not support an instruction")) << unknown.err;
  const Outcome none = run_psygen(
      "compare --instructions 'a 1' 'b 1' --out " + (folder / "out").string(), "PATH=/nowhere");
  EXPECT_EQ(none.code, 77);
  EXPECT_TRUE(mentions(none.err, "valgrind: cannot run")) << none.err;
}

// A program that runs until a signal ends it, and then writes a file.
std::string lasting_program(const TemporaryFolder& folder) {
  const std::string name = (folder / "my builds/lasting").string();
  std::filesystem::create_directories(folder / "my builds");
  std::ofstream(name) << "#!/bin/sh\ntrap 'echo ended > \"" << (folder / "ended").string()
                      << "\"; exit 1' TERM\necho $2 > \"" << (folder / "started").string()
                      << "\"\nwhile :; do sleep 0.1; done\n";
  std::filesystem::permissions(name, std::filesystem::perms::owner_all);
  return name;
}

TEST(Compare, ASignalEndsTheProgramThatItRuns) {
  const TemporaryFolder folder;
  // Which of the two runs first is random.
  const std::string command = "\"'" + lasting_program(folder) + "' 'a b'\"";
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    std::filesystem::remove(folder / "started");
    std::filesystem::remove(folder / "ended");
    const std::string started = (folder / "started").string();
    const Outcome outcome = run_psygen(
        "compare " + command + " " + command + " --test t.toml --out " + (folder / "out").string(),
        "run() { \"$@\" & p=$!; until [ -e " + started +
            " ]; do kill -0 $p || break; done; kill -" + signal + " $p; wait $p; }; run");
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "ended")) << signal;
    EXPECT_EQ(read(started), "t.toml\n") << "the quoted words";
  }
}

TEST(Compare, RunsThatAreNoFilesAreRefused) {
  const TemporaryFolder folder;
  for (const char* side : {"a", "b"})
    write_run(folder / side);
  std::filesystem::remove(folder / "b/frames.csv");
  ASSERT_EQ(mkfifo((folder / "b/frames.csv").c_str(), 0600), 0);
  const std::string a = (folder / "a").string(), b = (folder / "b").string();
  EXPECT_EQ(run_psygen("compare " + a + " " + b).code, 1);
  const Outcome converted = run_psygen("convert " + b + " --to mangohud --out " + a + "/log.csv");
  EXPECT_TRUE(mentions(converted.err, "is not a regular file")) << converted.err;
}

TEST(Compare, WithoutATestOrWithAMissingFolderIsAUsageError) {
  const Outcome options = run_psygen("compare 'a 1' 'b 1'");
  EXPECT_EQ(options.code, 2);
  EXPECT_TRUE(mentions(options.err, "two commands need --test and --out")) << options.err;
  const Outcome folder = run_psygen("compare /nowhere/a /nowhere/b");
  EXPECT_EQ(folder.code, 2);
  EXPECT_TRUE(mentions(folder.err, "/nowhere/a: no such folder or program")) << folder.err;
}

// A capture of 120 frames of `ms`.
std::string write_capture(const std::filesystem::path& file, double ms) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream stream(file);
  stream << "Application,ProcessID,MsBetweenPresents\n";
  for (int i = 0; i < 120; ++i)
    stream << "hill.exe,1," << ms + 0.01 * (i % 10) << "\n";
  return file.string();
}

TEST(Compare, JudgesCapturesByTheirTimesAlone) {
  const TemporaryFolder folder;
  const std::string a = write_capture(folder / "a/0.csv", 10),
                    b = write_capture(folder / "b/0.csv", 13), out = (folder / "out").string();
  const Outcome one = run_psygen("compare " + a + " " + b + " --out " + out);
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_TRUE(mentions(one.out, "verdict: inconclusive")) << one.out;
  EXPECT_TRUE(mentions(one.out, "Only frame times are compared")) << one.out;
  EXPECT_TRUE(mentions(read(folder / "out/compare.json"), "\"verdict\": \"inconclusive\""));
  EXPECT_TRUE(mentions(read(folder / "out/compare.html"), "Comparison of captures"));
  for (int i = 1; i < 5; ++i) {
    write_capture(folder.path() / "a" / (std::to_string(i) + ".csv"), 10 + 0.01 * i);
    write_capture(folder.path() / "b" / (std::to_string(i) + ".csv"), 13 + 0.01 * i);
  }
  const std::string sides = (folder / "a").string() + " " + (folder / "b").string();
  const Outcome worse = run_psygen("compare " + sides);
  EXPECT_EQ(worse.code, 3) << worse.err;
  EXPECT_TRUE(mentions(worse.out, "p50 takes 29.8 % more")) << worse.out;
  EXPECT_EQ(run_psygen("compare " + sides + " --aa 3").code, 2);
  std::ofstream(folder / "a/0.csv") << "fps=60\n";
  const Outcome refused = run_psygen("compare " + a + " " + b);
  EXPECT_NE(refused.code, 0);
  EXPECT_TRUE(mentions(refused.err, "log with mangoapp")) << refused.err;
}

// A run of 60 frames on the virtual clock, where every difference counts.
void write_virtual_run(const std::filesystem::path& folder, double frame_ms) {
  std::filesystem::create_directories(folder);
  std::ofstream frames(folder / "frames.csv");
  frames << "time_s,frame_ms,main_cpu_ms,apart,error_pixels,holes,missing_pixels_percent,"
            "too_coarse_percent\n";
  for (int i = 0; i < 60; ++i)
    frames << i / 30.0 << ',' << frame_ms << ",,,4,0,0,0\n";
  std::ofstream(folder / "summary.json")
      << R"({"schema": "psygen.summary/1", "run": {"width": 64, "height": 36, "fixed_step": 30}})";
}

TEST(Compare, TellsItsVerdictOnAPullRequest) {
  const TemporaryFolder folder;
  write_virtual_run(folder / "a", 10);
  write_virtual_run(folder / "b", 12);
  const std::string sides = "compare " + (folder / "a").string() + " " + (folder / "b").string();
  const Outcome done =
      run_psygen(sides + " --annotations github --markdown " + (folder / "words.md").string());
  EXPECT_EQ(done.code, 3) << done.err;
  EXPECT_TRUE(done.out.starts_with("verdict: worse\n")) << done.out;
  EXPECT_TRUE(mentions(done.out,
                       "\n::error title=psygen compare%3A worse::frames take 20.00 %25 "
                       "more\n"))
      << done.out;
  EXPECT_TRUE(
      read(folder / "words.md").starts_with("## Comparison: worse\n\n- frames take 20.00 %"))
      << read(folder / "words.md");
  const auto quality = folder / "quality.json";
  const Outcome json = run_psygen(sides + " --json --annotations gitlab:" + quality.string());
  EXPECT_EQ(json.code, 3);
  EXPECT_TRUE(json.out.starts_with("{") && json.out.ends_with("}\n")) << json.out;
  EXPECT_TRUE(mentions(read(quality), "\"severity\": \"major\"")) << read(quality);
  const Outcome both = run_psygen(sides + " --json --annotations github");
  EXPECT_EQ(both.code, 2);
  EXPECT_TRUE(mentions(both.err, "--json and --annotations both print")) << both.err;
  EXPECT_EQ(run_psygen(sides + " --annotations teamcity").code, 2);
}

TEST(FrameTests, OfOneNameAreRefusedBeforeTheyFly) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"})
    std::ofstream(folder / (std::string(name) + ".toml"))
        << "format = 1\nname = \"walk\"\n[at_most]\nhitches = 0\n";
  const Outcome refused =
      run_psygen("test " + (folder / "a.toml").string() + " " + (folder / "b.toml").string() +
                 " --out " + (folder / "out").string());
  EXPECT_EQ(refused.code, 1);
  EXPECT_TRUE(mentions(refused.err, "b.toml:2: name: the test of ")) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace psygen::cli
