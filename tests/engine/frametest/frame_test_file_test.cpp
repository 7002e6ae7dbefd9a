#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "engine/frametest/frame_test.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kWhole = R"(format = 1
name = "walk"

[flight]
world = "paper"
path = "walk27"
size = [320, 180]
preset = "medium"
seconds = 4
warmup = 0.5
clock = "virtual"
fixed_step = 30
budget_mib = 64
target_fps = 60

[at_most]
frame_ms.p99 = 25
missing.pixels_max_percent = 1.5
system_ms.cache.p99 = 3

[at_least]
low1_fps = 20

[equal]
missing.frames = 0
hash.world = "0123456789abcdef"
picture.grade = "good"
)";

std::string refusal(const std::string& text) {
  const auto test = parse_frame_test(text, "folder/a.toml");
  return test ? "taken" : test.error().message;
}

std::string with(const std::string& flight,
                 const std::string& budgets = "[at_most]\nhitches = 0\n") {
  return "format = 1\n[flight]\n" + flight + "\n" + budgets;
}

TEST(FrameTestFile, ReadsTheFlightAndTheBudgetsInOrder) {
  const auto test = parse_frame_test(kWhole, "folder/other.toml");
  ASSERT_TRUE(test) << test.error().message;
  EXPECT_EQ(test->name, "walk");
  EXPECT_TRUE(test->flight.session.headless);
  EXPECT_TRUE(test->flight.session.scene.virtual_time);
  EXPECT_EQ(test->flight.session.size, (core::Extent{320, 180}));
  EXPECT_EQ(test->flight.session.preset, render::Preset::kMedium);
  EXPECT_EQ(test->flight.session.scene.budget_bytes, 64ull << 20);
  EXPECT_EQ(test->flight.session.target_hz, 60);
  EXPECT_EQ(test->flight.seconds, 4);
  EXPECT_EQ(test->flight.fixed_step_hz, 30);
  ASSERT_EQ(test->budgets.size(), 7u);
  EXPECT_EQ(test->budgets[0].field, "frame_ms.p99");
  EXPECT_EQ(std::get<double>(test->budgets[0].limit), 25);
  EXPECT_EQ(test->budgets[3].relation, Relation::kAtLeast);
  EXPECT_EQ(test->budgets[6].field, "picture.grade");
  EXPECT_EQ(std::get<std::string>(test->budgets[6].limit), "good");
}

TEST(FrameTestFile, HasTheNameOfTheFileAndDefaultOptions) {
  const auto test = parse_frame_test("format = 1\n[at_most]\nhitches = 0\n", "folder/dash.toml");
  ASSERT_TRUE(test) << test.error().message;
  EXPECT_EQ(test->name, "dash");
  EXPECT_EQ(test->flight.session.world_file, "paper");
  EXPECT_FALSE(test->flight.session.scene.virtual_time);
  EXPECT_EQ(test->flight.session.preset, render::Preset::kLow) << "not chosen by GPU";
}

TEST(FrameTestFile, ReportsErrorsWithFileLineFieldAndSuggestion) {
  EXPECT_EQ(refusal(with("sise = [1, 1]")),
            "folder/a.toml:3: flight.sise: this key is unknown; did you mean size?");
  EXPECT_THAT(refusal(with("clock = \"sand\"")),
              StartsWith("folder/a.toml:3: flight.clock: it must"));
  EXPECT_THAT(refusal(with("preset = \"best\"")), StartsWith("folder/a.toml:3: flight.preset: "));
  EXPECT_THAT(refusal(with("error = 0")), HasSubstr("it must be a number from 0.1 to 1000"));
  EXPECT_THAT(refusal(with("loop = true")), HasSubstr("needs seconds or frames"));
  EXPECT_THAT(refusal(with("", "[at_most]\nframe_ms.p98 = 1\n")),
              StartsWith("folder/a.toml:5: at_most.frame_ms.p98: summary.json has no such field; "
                         "did you mean frame_ms.p9"));
  EXPECT_THAT(refusal(with("", "[at_most]\nframe_ms.p99 = \"fast\"\n")),
              HasSubstr("at_most.frame_ms.p99: the limit must be a finite number"));
  EXPECT_THAT(refusal(with("", "[at_most]\nframe_ms.p99 = nan\n")), HasSubstr("finite number"));
  EXPECT_THAT(refusal(with("", "[at_least]\npicture.grade = 1\n")),
              HasSubstr("only [equal] can compare"));
  EXPECT_THAT(refusal(with("", "[at_most]\nsystem_ms.cache.p50x = 1\n")), HasSubstr("p50 and p99"));
  EXPECT_THAT(refusal("format = 1\n"), HasSubstr("needs a budget"));
  EXPECT_THAT(refusal("format = 2\n"), HasSubstr("newer than this program"));
  EXPECT_THAT(refusal("format = 1\nname = \"a/b\"\n[at_most]\nhitches = 0\n"),
              HasSubstr("must not contain /"));
}

TEST(FrameTestFile, ReadsMarksAndTheBudgetsOfSections) {
  const auto test = parse_frame_test(
      "format = 1\n[marks]\nboss = 4\nspawn = 1.5\n"
      "[sections.boss]\nat_most.frame_ms.p99 = 12\nat_most.figures.ai.paths.p99 = 3\n"
      "[sections.start]\nfrom = \"spawn\"\nto = \"boss\"\n[sections.start.equal]\n"
      "missing.frames = 0\n[at_most]\nsections.boss.system_ms.cache.p99 = 1\n"
      "figures.ai.paths.max = 9\nmarks.boss.time_s = 5\n",
      "a.toml");
  ASSERT_TRUE(test) << test.error().message;
  ASSERT_EQ(test->flight.marks.size(), 2u);
  EXPECT_EQ(test->flight.marks[0].name, "spawn") << "in the order of time";
  ASSERT_EQ(test->flight.sections.size(), 2u);
  EXPECT_EQ(test->flight.sections[0].from, "boss") << "the section's name";
  EXPECT_EQ(test->flight.sections[0].to, "end");
  EXPECT_EQ(test->flight.sections[1].to, "boss");
  std::vector<std::string> fields;
  for (const Budget& budget : test->budgets)
    fields.push_back(budget.field);
  EXPECT_THAT(fields, testing::ElementsAre(
                          "sections.boss.frame_ms.p99", "sections.boss.figures.ai.paths.p99",
                          "sections.start.missing.frames", "sections.boss.system_ms.cache.p99",
                          "figures.ai.paths.max", "marks.boss.time_s"));
}

TEST(FrameTestFile, ReportsErrorsOfMarksFiguresAndSections) {
  const auto refused = [](const std::string& tables) {
    return refusal("format = 1\n" + tables + "[equal]\nmissing.frames = 0\n");
  };
  EXPECT_THAT(refused("[marks]\nBoss = 1\n"),
              HasSubstr("a.toml:3: marks.Boss: it must be 1 to 64"));
  EXPECT_THAT(refused("[marks]\nboss = -1\n"), HasSubstr("marks.boss: -1 is not allowed"));
  EXPECT_THAT(refused("[sections.boss]\nfom = \"a\"\n"), HasSubstr("did you mean from?"));
  EXPECT_THAT(refused("[sections.boss]\nto = \"A\"\n"), HasSubstr("sections.boss.to: it must be"));
  EXPECT_THAT(refused("[sections.\"a.b\"]\nto = \"c\"\n"), HasSubstr("the name must be"));
  EXPECT_THAT(refused("[sections.boss.at_most]\nframe_ms.p98 = 1\n"),
              HasSubstr("at_most.sections.boss.frame_ms.p98: sections have no such field; did you "
                        "mean frame_ms.p9"));
  EXPECT_THAT(refused("[at_least]\nsections.boss.low1_fps = 1\n"), HasSubstr("no such section"));
  EXPECT_THAT(refused("[at_most]\nfigures.paths = 1\n"),
              HasSubstr("figures of the game have only"));
  EXPECT_THAT(refused("[at_most]\nfigures.paths.p98 = 1\n"), HasSubstr("only mean, min, p50"));
  EXPECT_THAT(refused("[at_most]\nfigures.paths.unit = 1\n"), HasSubstr("only [equal]"));
}

TEST(FrameTestFile, FindsFilesInItsFolderThenShippedOnes) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  write("walk27.toml", "");  // the user's file
  write("test.toml", with("world = \"five_species\"\npath = \"walk27.toml\""));
  const auto test = load_frame_test(folder / "test.toml");
  ASSERT_TRUE(test) << test.error().message;
  EXPECT_EQ(test->flight.path_file, folder / "walk27.toml");
  EXPECT_THAT(test->flight.session.world_file.string(),
              testing::EndsWith("worlds/five_species.toml"));
  write("test.toml", with("world = \"nowhere\""));
  const auto refused = load_frame_test(folder / "test.toml");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, StartsWith((folder / "test.toml").string() + ": "));
  EXPECT_EQ(load_frame_test(folder / "none.toml").error().code, core::ErrorCode::kIo);
}

TEST(FrameTestFile, RefusesNamesThatAreNoFolder) {
  const auto named = [](const std::string& name) {
    return refusal("format = 1\nname = \"" + name + "\"\n[at_most]\nhitches = 0\n");
  };
  for (const char* name : {".", ".."})
    EXPECT_EQ(named(name),
              "folder/a.toml:2: name: the name is also used for a folder and must not "
              "be empty, . or ..");
  for (const char* name : {"../walk", "/walk", "a/b", "a\\\\b"})
    EXPECT_EQ(named(name),
              "folder/a.toml:2: name: the name is also used for a folder and must not contain / or "
              "\\")
        << name;
  for (const std::string& name : {std::string(), std::string("a\\n"), std::string(256, 'a')})
    EXPECT_THAT(named(name), StartsWith("folder/a.toml:2: name: it must be a string of 1 to 64"));
  const auto from_file = parse_frame_test("format = 1\n[at_most]\nhitches = 0\n", "...toml");
  ASSERT_FALSE(from_file) << "the stem is ..";
  EXPECT_THAT(from_file.error().message, StartsWith("...toml:1: name: the name is also used"));
}

TEST(FrameTestFile, HasANameOfItsOwnInARun) {
  const TemporaryFolder folder;
  const std::string text = with("", "[at_most]\nhitches = 0\n");
  std::filesystem::create_directory(folder / "old");
  std::ofstream(folder / "walk.toml") << text;
  std::ofstream(folder / "old" / "walk.toml") << text;
  std::ofstream(folder / "other.toml") << "name = \"walk\"\n" + text;
  std::ofstream(folder / "broken.toml") << "format = 2\n";
  const auto refused = [](std::vector<std::filesystem::path> files) {
    const auto tests = load_frame_tests(files);
    return tests ? std::string() : tests.error().message;
  };
  EXPECT_EQ(refused({folder / "walk.toml", folder / "broken.toml"}), "") << "a broken one has none";
  EXPECT_EQ(refused({folder / "walk.toml", folder / "broken.toml", folder / "old" / "walk.toml"}),
            (folder / "old" / "walk.toml").string() + ":1: name: the test of " +
                (folder / "walk.toml").string() +
                ":1 is also called walk, and both would write into one folder; give one another "
                "name");
  EXPECT_THAT(refused({folder / "walk.toml", folder / "other.toml"}),
              StartsWith((folder / "other.toml").string() + ":1: name: the test of "));
  EXPECT_THAT(refused({folder / "walk.toml", folder / "walk.toml"}), HasSubstr("also called walk"));
}

TEST(FrameTestFile, HasRunsRetriesAndABase) {
  const std::string budgets = "[at_most]\nframe_ms.p99 = 25\n";
  const auto test = parse_frame_test(
      with("", "[test]\nruns = 3\nretries = 2\nbase = \"main/out\"\n" + budgets), "dir/a.toml");
  ASSERT_TRUE(test) << test.error().message;
  EXPECT_EQ(test->runs, 3);
  EXPECT_EQ(test->retries, 2);
  EXPECT_EQ(test->base, "dir/main/out");
  const auto plain = parse_frame_test(with("", budgets), "dir/a.toml");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->runs, 1);
  EXPECT_EQ(plain->retries, 0);
  EXPECT_TRUE(plain->base.empty());
  for (const char* key : {"runs = 0", "runs = 100", "retries = -1", "retries = 10", "base = \"\""})
    EXPECT_THAT(refusal(with("", std::string("[test]\n") + key + "\n" + budgets)),
                StartsWith("folder/a.toml:5: test."))
        << key;
  EXPECT_THAT(refusal(with("", "[test]\nrun = 3\n" + budgets)), HasSubstr("did you mean runs?"));
}

TEST(FrameTestFile, MeasuresAReferenceLoadWhereLoadCanChangeAResult) {
  const auto measures = [](const std::string& flight, const std::string& rest) {
    const auto test = parse_frame_test(with(flight, rest), "a.toml");
    EXPECT_TRUE(test) << test.error().message;
    return test && test->flight.reference_load;
  };
  const std::string time = "[at_most]\nframe_ms.p99 = 25\n", hash = "[equal]\nhash.world = \"x\"\n";
  EXPECT_TRUE(measures("", time));
  EXPECT_FALSE(measures("", hash));
  EXPECT_FALSE(measures("clock = \"virtual\"", time));
  EXPECT_TRUE(measures("clock = \"virtual\"", "[at_most]\nload.cpu_seconds = 2\n"));
  EXPECT_TRUE(measures("clock = \"virtual\"", "[test]\nruns = 3\n" + time));
  EXPECT_FALSE(measures("", "[test]\nreference = false\n" + time));
  EXPECT_TRUE(measures("clock = \"virtual\"", "[test]\nreference = true\n" + time));
}

TEST(FrameTestFile, HasLimitsRelativeToABase) {
  const auto factor = [](const std::string& limit) -> double {
    const auto test =
        parse_frame_test(with("", "[at_most]\nframe_ms.p99 = \"" + limit + "\"\n"), "a");
    return test ? test->budgets.at(0).of_base.value_or(-1) : -2;
  };
  for (const char* limit : {"1.05 × base", "1.05 x base", "1.05*base", " 1.05×base"})
    EXPECT_EQ(factor(limit), 1.05) << limit;
  EXPECT_EQ(factor("1 × base"), 1);
  for (const char* limit : {"base", "1.05", "1.05 base", "× base", "0 × base", "-1 × base",
                            "1e9 × base", "nan × base", "1.05 × base!", "1.05 × bases", ""})
    EXPECT_EQ(factor(limit), -2) << limit;
  EXPECT_THAT(refusal(with("", "[at_most]\nframe_ms.p99 = \"fast\"\n")),
              HasSubstr("or a text like \"1.05 × base\" with a factor from 0.01 to 100"));
  EXPECT_THAT(refusal(with("", "[at_most]\npicture.grade = \"1 × base\"\n")),
              HasSubstr("only [equal] can compare"));
  const auto equal = parse_frame_test(with("", "[equal]\nworld.name = \"1 × base\"\n"), "a");
  ASSERT_TRUE(equal);
  EXPECT_FALSE(equal->budgets[0].of_base) << "a text is itself";
}

TEST(FrameTestFile, HasLimitsWithOptions) {
  const auto test = parse_frame_test(
      with("",
           "[at_most]\nwait_ms.p99 = { limit = 3, witness = \"none\" }\nframe_ms.p99.limit = 25\n"),
      "a");
  ASSERT_TRUE(test) << test.error().message;
  EXPECT_EQ(test->budgets[0].field, "wait_ms.p99");
  EXPECT_EQ(std::get<double>(test->budgets[0].limit), 3);
  EXPECT_FALSE(test->budgets[0].needs_witness);
  EXPECT_EQ(test->budgets[1].field, "frame_ms.p99");
  EXPECT_TRUE(test->budgets[1].needs_witness);
  EXPECT_THAT(refusal(with("", "[at_most]\nwait_ms.p99 = { limit = 3, witness = \"mine\" }\n")),
              StartsWith("folder/a.toml:5: at_most.wait_ms.p99.witness: it must be "));
  EXPECT_THAT(refusal(with("", "[at_most]\nwait_ms.p99 = { limit = \"x\" }\n")),
              HasSubstr("at_most.wait_ms.p99.limit: the limit must be"));
  EXPECT_THAT(refusal(with("", "[at_most]\nwait_ms.p99 = { limit = 3, wittness = \"none\" }\n")),
              HasSubstr("did you mean witness?"));
}

}  // namespace
}  // namespace psygen::frametest
