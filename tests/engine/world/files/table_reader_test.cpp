#include "engine/world/files/table_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace psygen::world {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// Reads `text` with `read` and returns the first problem, or nothing.
template <class Read>
std::string problem_of(std::string_view text, const Read& read) {
  const auto document = parse_document(text, "f.toml");
  EXPECT_TRUE(document.has_value());
  Problems problems("f.toml");
  TableReader reader(*document, "t", 1, problems);
  read(reader);
  return problems.any() ? problems.first().message : "";
}

TEST(TableReader, ReadsAllowedValues) {
  const std::string_view text =
      "a = 1\nb = 2\nc = \"x\"\nd = [1, 0.5, 0]\ne = [-3, 4]\nf = [2, 3]\ng = [1.5, 2]\nh = 7\n";
  EXPECT_EQ(problem_of(text,
                       [](TableReader& r) {
                         double a = 0;
                         std::int64_t b = 0;
                         std::string c;
                         glm::vec3 d{};
                         std::int64_t e[2] = {};
                         glm::dvec2 f{};
                         EXPECT_TRUE(r.read("a", a, {0, 1}));
                         EXPECT_TRUE(r.read("b", b, {0, 2}));
                         EXPECT_TRUE(r.read("c", c, 1));
                         EXPECT_TRUE(r.read("d", d, {0, 1}));
                         EXPECT_TRUE(r.read_pair("e", e, {-3, 4}));
                         EXPECT_TRUE(r.read("f", f, {0, 9}));
                         EXPECT_EQ(a, 1);
                         EXPECT_EQ(b, 2);
                         EXPECT_EQ(c, "x");
                         EXPECT_EQ(d, glm::vec3(1, 0.5, 0));
                         EXPECT_EQ(e[0], -3);
                         EXPECT_EQ(f, glm::dvec2(2, 3));
                         const auto g = r.read_range("g"), h = r.read_range("h");
                         EXPECT_EQ(g->low, 1.5);
                         EXPECT_EQ(g->high, 2);
                         EXPECT_FALSE(g->integers);
                         EXPECT_EQ(h->low, 7);
                         EXPECT_EQ(h->high, 7);
                         EXPECT_TRUE(h->integers);
                         r.finish();
                       }),
            "");
}

TEST(TableReader, ProblemsNameFileLineFieldAndAllowedValues) {
  const auto read_number = [](TableReader& r) {
    double a = 3;
    EXPECT_FALSE(r.read("a", a, {0, 1}));
    EXPECT_EQ(a, 3);
  };
  EXPECT_EQ(problem_of("\na = 2\n", read_number),
            "f.toml:2: t.a: 2 is not allowed: it must be a number from 0 to 1");
  EXPECT_THAT(problem_of("a = -0.1\n", read_number), HasSubstr("-0.1 is not allowed"));
  EXPECT_THAT(problem_of("a = nan\n", read_number), HasSubstr("nan is not allowed"));
  EXPECT_THAT(problem_of("a = inf\n", read_number), HasSubstr("inf is not allowed"));
  EXPECT_THAT(problem_of("a = \"1\"\n", read_number), HasSubstr("a string is not allowed"));
  EXPECT_THAT(problem_of("a = true\n", read_number), HasSubstr("a boolean is not allowed"));
}

TEST(TableReader, AnIntegerMustHaveNoDecimalPoint) {
  std::int64_t value = 0;
  EXPECT_EQ(problem_of("a = 1.0\n",
                       [&](TableReader& r) {
                         r.read("a", value, {0, 5});
                       }),
            "f.toml:1: t.a: 1 is not allowed: it must be an integer from 0 to 5");
}

TEST(TableReader, ArraysMustHaveTheRightLength) {
  glm::vec3 value{};
  const auto read = [&](TableReader& r) { r.read("a", value, {0, 1}); };
  EXPECT_THAT(problem_of("a = [1, 1]\n", read), HasSubstr("array of 3"));
  EXPECT_THAT(problem_of("a = 1\n", read), HasSubstr("array of 3"));
  EXPECT_THAT(problem_of("a = [1, 1, 7]\n", read), HasSubstr("t.a[2]: 7 is not allowed"));
}

TEST(TableReader, RangesMustBeNumbersInOrder) {
  const auto read = [](TableReader& r) { EXPECT_FALSE(r.read_range("a").has_value()); };
  EXPECT_THAT(problem_of("a = [2, 1]\n", read), HasSubstr("is reversed"));
  EXPECT_THAT(problem_of("a = [1, 2, 3]\n", read), HasSubstr("[lowest, highest]"));
  EXPECT_THAT(problem_of("a = []\n", read), HasSubstr("[lowest, highest]"));
  EXPECT_THAT(problem_of("a = [1, \"2\"]\n", read), HasSubstr("[lowest, highest]"));
  EXPECT_THAT(problem_of("a = [1, nan]\n", read), HasSubstr("finite"));
  EXPECT_THAT(problem_of("a = -inf\n", read), HasSubstr("finite"));
}

TEST(TableReader, StringsAreBoundedAndPlain) {
  std::string value;
  const auto read = [&](TableReader& r) { r.read("a", value, 4); };
  EXPECT_THAT(problem_of("a = \"12345\"\n", read), HasSubstr("1 to 4 bytes"));
  EXPECT_THAT(problem_of("a = \"\"\n", read), HasSubstr("1 to 4 bytes"));
  EXPECT_THAT(problem_of("a = \"\\n\"\n", read), HasSubstr("control"));
  EXPECT_THAT(problem_of("a = \"\\u009B\"\n", read), HasSubstr("control"));
  EXPECT_EQ(problem_of("a = \"äö\"\n", read), "");
}

TEST(TableReader, UnknownKeysSuggestTheNearestOne) {
  const auto read = [](TableReader& r) {
    double v = 0;
    r.read("octaves", v, {0, 9});
    r.read("gain", v, {0, 9});
    r.read("gain", v, {0, 9});  // listed once
    r.finish();
  };
  EXPECT_EQ(problem_of("gain = 1\noctavse = 3\n", read),
            "f.toml:2: t.octavse: this key is unknown; did you mean octaves?");
  EXPECT_THAT(problem_of("something_else = 1\n", read), EndsWith("known here: octaves, gain"));
  EXPECT_THAT(problem_of("\"größe\" = 1\n", read), StartsWith("f.toml:1: t.größe: this key"));
  EXPECT_THAT(problem_of("\"a\\u202E\\n\" = 1\n", read), StartsWith("f.toml:1: t.a\\u202e\\n:"));
  EXPECT_THAT(problem_of('"' + std::string(100'000, 'x') + "\" = 1\n", read),
              HasSubstr("xxx...: this key is unknown"));
}

TEST(TableReader, MissingFieldsAreOnlyAProblemWhereTheyAreRequired) {
  double v = 0;
  EXPECT_EQ(problem_of("", [&](TableReader& r) { r.read("a", v, {0, 1}); }), "");
  EXPECT_EQ(problem_of("",
                       [&](TableReader& r) {
                         r.read("a", v, {0, 1}, Presence::kRequired);
                       }),
            "f.toml:1: t.a: this field is missing");
}

TEST(TableReader, TheFirstProblemOfTheFileIsReported) {
  EXPECT_THAT(problem_of("b = -1\na = -1\n",
                         [](TableReader& r) {
                           double v = 0;
                           r.read("a", v, {0, 1});
                           r.read("b", v, {0, 1});
                         }),
              StartsWith("f.toml:1: t.b"));
}

TEST(TableReader, TablesMustBeTables) {
  const auto read = [](TableReader& r) {
    r.table("a");
    r.tables("b", 2);
  };
  EXPECT_THAT(problem_of("a = 1\n", read), HasSubstr("must be a table"));
  EXPECT_THAT(problem_of("[b]\n", read), HasSubstr("at most 2 tables"));
  EXPECT_THAT(problem_of("[[b]]\n[[b]]\n[[b]]\n", read), HasSubstr("at most 2 tables"));
  EXPECT_THAT(problem_of("b = [1]\n", read), HasSubstr("at most 2 tables"));
}

}  // namespace
}  // namespace psygen::world
