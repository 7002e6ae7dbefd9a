#include "engine/frametest/usual_load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using telemetry::Figure;
using testing::StartsWith;

UsualLoadFile::Run run(double pair_s, double cpu_s, std::string test = "walk",
                       std::string machine = "EPYC, 2 cores") {
  return {std::move(machine), std::move(test), Figure(pair_s), Figure(cpu_s)};
}

TEST(UsualLoad, IsTheLowerQuartileOfTheMachineAndTheMedianOfTheTest) {
  UsualLoadFile file;
  for (int i = 1; i <= 5; ++i)
    file.add(run(0.1 * i, i));
  for (int i = 0; i < 5; ++i) {
    file.add(run(0.1 * (i + 6), 100, "dash"));
    file.add(run(9, 9, "walk", "other"));
  }
  const UsualLoad usual = file.usual("EPYC, 2 cores", "walk");
  EXPECT_NEAR(*usual.pair_s, 0.325, 1e-12) << "of 0.1 to 1.0, of all tests";
  EXPECT_EQ(*usual.cpu_s, 3);
  EXPECT_EQ(file.usual("EPYC, 2 cores", "new").cpu_s.reason, "only 0 of 5 runs are recorded");
  EXPECT_FALSE(file.usual("new machine", "walk").pair_s.has_value());
}

TEST(UsualLoad, KeepsTheLastRunsOfATestOnAMachine) {
  UsualLoadFile file;
  file.add(run(7, 7, "dash"));
  for (int i = 0; i < 50; ++i)
    file.add(run(i, i + 1));
  EXPECT_EQ(*file.usual("EPYC, 2 cores", "walk").cpu_s, 30.5) << "of 11 to 50";
  const std::string text = file.text();
  EXPECT_EQ(std::ranges::count(text, '\n'), 41);
}

TEST(UsualLoad, SurvivesItsFile) {
  const TemporaryFolder folder;
  const auto path = folder / "usual.jsonl";
  auto file = UsualLoadFile::load(path);
  ASSERT_TRUE(file) << "a missing file has no runs";
  for (int i = 0; i < 5; ++i)
    file->add(run(0.25, 1.5, "wa\"lk\n"));
  UsualLoadFile::Run none = run(1, 1);
  none.pair_s = none.cpu_s = Figure::missing("no");
  file->add(none);
  ASSERT_TRUE(file->save(path));
  const auto again = UsualLoadFile::load(path);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->text(), file->text());
  EXPECT_EQ(*again->usual("EPYC, 2 cores", "wa\"lk\n").pair_s, 0.25);
}

TEST(UsualLoad, RefusesADamagedFileWithItsLine) {
  const std::string good =
      R"({"schema":"psygen.usual/1","machine":"m","test":"t","pair_s":0.2,"cpu_s":null})"
      "\n";
  ASSERT_TRUE(UsualLoadFile::parse(good + "\n" + good, "f"));
  for (const char* bad :
       {"{", "[]", R"({"schema":"psygen.usual/2","machine":"m","test":"t","pair_s":1,"cpu_s":1})",
        R"({"schema":"psygen.usual/1","machine":"m","test":"t","pair_s":-1,"cpu_s":1})",
        R"({"schema":"psygen.usual/1","machine":"m","test":"t","pair_s":"1","cpu_s":1})",
        R"({"schema":"psygen.usual/1","machine":"m","pair_s":1,"cpu_s":1})",
        R"({"schema":"psygen.usual/1","machine":"m","test":"t","pair_s":1})"}) {
    const auto refused = UsualLoadFile::parse(good + bad, "usual.jsonl");
    ASSERT_FALSE(refused) << bad;
    EXPECT_THAT(refused.error().message,
                StartsWith("usual.jsonl:2: this is no run of psygen.usual/1"));
  }
}

TEST(UsualLoad, NamesMachinesByWhatDecidesOnTimes) {
  telemetry::MachineFacts machine;
  machine.cpu = std::string("EPYC");
  machine.cores = 2;
  EXPECT_EQ(machine_name(machine), "EPYC, 2 cores");
  machine.quota_cores = 1.5;
  machine.cores = 1;
  EXPECT_EQ(machine_name(machine), "EPYC, 1 core, quota 1.5");
  machine.cpu = telemetry::MeasuredText::missing("no /proc");
  EXPECT_EQ(machine_name(machine), "unknown processor, 1 core, quota 1.5");
}

}  // namespace
}  // namespace psygen::frametest
