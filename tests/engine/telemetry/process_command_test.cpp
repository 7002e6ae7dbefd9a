#include "engine/telemetry/process_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace psygen::telemetry {
namespace {

TEST(ProcessCommand, HasTheNameOfThisProgram) {
  EXPECT_THAT(process_command(), testing::HasSubstr("psygen_test_telemetry"));
}

TEST(ProcessCommand, CanBeTypedIntoAShell) {
  const std::string words("psygen\0fly\0--out\0a b\0it's\0\0$(x)\0", 31);
  EXPECT_EQ(shell_text(words), "psygen fly --out 'a b' 'it'\\''s' '' '$(x)'");
  EXPECT_EQ(shell_text(""), "");
}

TEST(ProcessCommand, AcceptsALastWordWithoutAnEnd) {
  EXPECT_EQ(shell_text("a"), "a");
}

}  // namespace
}  // namespace psygen::telemetry
