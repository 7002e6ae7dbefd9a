#include "engine/core/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace psygen::core {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::SizeIs;
using testing::StartsWith;

std::vector<std::string> kept_lines() {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  EXPECT_TRUE(write_kept_log_lines(fileno(file.get())));
  std::rewind(file.get());
  std::vector<std::string> lines(1);
  for (int c = std::fgetc(file.get()); c != EOF; c = std::fgetc(file.get())) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += static_cast<char>(c);
  }
  EXPECT_EQ(lines.back(), "") << "the last line has no end";
  lines.pop_back();
  return lines;
}

TEST(Log, KeepsItsLastLinesInOrder) {
  set_log_name("journal");
  log_warning("first");
  EXPECT_EQ(kept_lines().back(), "journal: warning: first");
  for (std::size_t i = 0; i < kKeptLogLines + 6; ++i)
    log_info(std::to_string(i));
  const std::vector<std::string> lines = kept_lines();
  ASSERT_EQ(lines.size(), kKeptLogLines);
  EXPECT_EQ(lines.front(), "journal: info: 6");
  EXPECT_EQ(lines.back(), "journal: info: " + std::to_string(kKeptLogLines + 5));
}

TEST(Log, KeepsTheBeginningOfALongLine) {
  set_log_name("journal");
  log_error(std::string(2 * kKeptLogLineBytes, 'x'));
  EXPECT_THAT(kept_lines().back(),
              AllOf(StartsWith("journal: error: xxx"), EndsWith("x"), SizeIs(kKeptLogLineBytes)));
}

TEST(Log, SaysIfTheKeptLinesCannotBeWritten) {
  log_info("line");
  EXPECT_FALSE(write_kept_log_lines(-1));
}

}  // namespace
}  // namespace psygen::core
