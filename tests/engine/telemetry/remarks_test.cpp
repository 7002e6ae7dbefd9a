#include "engine/telemetry/remarks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/temporary_folder.hpp"

namespace psygen::telemetry {
namespace {

using nlohmann::json;

Remark remark(std::string title, std::string message) {
  return {RemarkLevel::kError, std::move(title), std::move(message), "tests/walk.toml", 12};
}

TEST(Remarks, BecomeWorkflowCommandsOfGithub) {
  const std::vector<Remark> remarks{{RemarkLevel::kNotice, "held", "all budgets hold", {}, 0},
                                    remark("walk: frame_ms.p99", "27 ms; at most 25")};
  EXPECT_EQ(to_github(remarks),
            "::error file=tests/walk.toml,line=12,title=walk%3A frame_ms.p99::27 ms; at most 25\n"
            "::notice title=held::all budgets hold\n");
}

TEST(Remarks, CannotEndACommandOrAProperty) {
  const std::string text = to_github(
      std::vector{Remark{RemarkLevel::kWarning, "a,b:c%\nd", "50 %\r\n::error::x", "a,b.toml", 1}});
  EXPECT_EQ(text,
            "::warning file=a%2Cb.toml,line=1,title=a%2Cb%3Ac%25\\nd::50 %25%0D%0A::error::x\n");
}

TEST(Remarks, NameFilesFromTheCurrentFolder) {
  Remark inside = remark("t", "m"), outside = inside;
  inside.file = std::filesystem::current_path() / "a" / ".." / "walk.toml";
  outside.file = "/elsewhere/walk.toml";
  EXPECT_EQ(to_github(std::vector{inside}), "::error file=walk.toml,line=12,title=t::m\n");
  EXPECT_EQ(to_github(std::vector{outside}),
            "::error file=/elsewhere/walk.toml,line=12,title=t::m\n");
}

TEST(Remarks, BecomeACodeQualityReportOfGitlab) {
  const json report = json::parse(
      to_gitlab(std::vector{remark("walk: frame_ms.p99", "27 ms"),
                            Remark{.level = RemarkLevel::kNotice, .title = "t", .message = "m"}}));
  ASSERT_EQ(report.size(), 2u);
  EXPECT_EQ(report[0]["description"], "walk: frame_ms.p99: 27 ms");
  EXPECT_EQ(report[0]["severity"], "major");
  EXPECT_EQ(report[0]["check_name"], "psygen");
  EXPECT_EQ(report[0]["location"]["path"], "tests/walk.toml");
  EXPECT_EQ(report[0]["location"]["lines"]["begin"], 12);
  EXPECT_EQ(report[1]["severity"], "info");
  EXPECT_EQ(report[1]["location"]["lines"]["begin"], 1);
  EXPECT_EQ(to_gitlab({}), "[]\n");
}

TEST(Remarks, HaveAFingerprintThatOutlivesTheirValuesAndDiffersAmongThem) {
  const auto fingerprint = [](const std::vector<Remark>& remarks, std::size_t i) {
    return json::parse(to_gitlab(remarks))[i]["fingerprint"].get<std::string>();
  };
  const std::vector<Remark> first{remark("t", "27 ms"), remark("t", "27 ms"), remark("u", "1")};
  EXPECT_EQ(fingerprint(first, 0), fingerprint({remark("t", "28 ms")}, 0));
  EXPECT_NE(fingerprint(first, 0), fingerprint(first, 1));
  EXPECT_NE(fingerprint(first, 0), fingerprint(first, 2));
}

TEST(Remarks, GoWhereAnOptionSays) {
  const auto github = annotations_from("github"), gitlab = annotations_from("gitlab:a:b.json");
  ASSERT_TRUE(github && gitlab);
  EXPECT_TRUE(github->to_stdout());
  EXPECT_EQ(gitlab->file, "a:b.json");
  EXPECT_FALSE(gitlab->to_stdout());
  for (const char* refused : {"", "teamcity", "github:", ":x", "GitHub"})
    EXPECT_FALSE(annotations_from(refused)) << refused;
  EXPECT_EQ(to_text(Annotations{}, std::vector{remark("t", "m")}), "");
}

TEST(Remarks, AreWrittenAndRefusedBeforeALongJob) {
  const TemporaryFolder folder;
  PullRequestWords words{folder / "new" / "words.md",
                         {Annotations::Format::kGithub, folder / "remarks.txt"}};
  ASSERT_TRUE(words.check());
  ASSERT_TRUE(words.write("# Words\n", std::vector{remark("t", "m")}));
  std::ifstream markdown(words.markdown), remarks(words.annotations.file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(markdown), {}), "# Words\n");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(remarks), {}),
            "::error file=tests/walk.toml,line=12,title=t::m\n");
  words.markdown = folder / "remarks.txt" / "words.md";
  EXPECT_EQ(words.check().error().code, core::ErrorCode::kIo);
}

TEST(Markdown, EscapesWhatWouldChangeATable) {
  EXPECT_EQ(markdown_text("a|b <img> `x` *y* [z](u) & \\"),
            "a\\|b \\<img\\> \\`x\\` \\*y\\* \\[z\\](u) \\& \\\\");
  EXPECT_EQ(markdown_text("one\ntwo\rthree"), "one two\\\\rthree") << "a cell is one line";
}

TEST(Markdown, MentionsNobody) {
  EXPECT_EQ(markdown_text("@octocat #42"),
            "@\u200boctocat #\u200b"
            "42");
}

TEST(Markdown, HasTables) {
  const std::vector<MarkdownRow> rows{{"frame_ms.p99", "27|28"}};
  EXPECT_EQ(markdown_table({"budget", "value"}, rows),
            "\n| budget | value |\n| --- | --- |\n| frame\\_ms.p99 | 27\\|28 |\n\n");
}

}  // namespace
}  // namespace psygen::telemetry
