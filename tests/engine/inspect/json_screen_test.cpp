#include <gtest/gtest.h>

#include <string>

#include "engine/inspect/visit.hpp"

namespace psygen::inspect {
namespace {

TEST(JsonScreen, AcceptsRequestsWithLongTexts) {
  EXPECT_TRUE(is_small_json(R"({"id": 1, "do": "figures"})"));
  const std::string text(1 << 20, '[');
  EXPECT_TRUE(is_small_json(R"({"do": "set_world", "text": ")" + text + "\"}"));
  EXPECT_TRUE(is_small_json(R"({"text": "a \" [[[[[[[[ b \\"})"));
}

TEST(JsonScreen, RejectsDeepTextsAndTextsOfManyParts) {
  EXPECT_FALSE(is_small_json(std::string(1 << 20, '[')));
  EXPECT_FALSE(is_small_json("[[[[[1]]]]]"));
  std::string list = "[0";
  for (int i = 0; i < 100; ++i)
    list += ",0";
  EXPECT_FALSE(is_small_json(list + "]"));
  EXPECT_FALSE(is_small_json(std::string(1 << 20, '1')));
}

}  // namespace
}  // namespace psygen::inspect
