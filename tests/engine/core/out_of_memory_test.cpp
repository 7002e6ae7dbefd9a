#include "engine/core/out_of_memory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace psygen::core {
namespace {

bool starts_with(std::string_view text, std::string_view words) {
  return text.substr(0, words.size()) == words;
}

TEST(OutOfMemory, NamesThePurposeAndTheRequestedBytes) {
  record_failed_allocation(4096);
  const std::string sentence = out_of_memory("a mesh");
  EXPECT_TRUE(starts_with(sentence, "a mesh: memory ran out (4096 bytes more were wanted; "))
      << sentence;
  EXPECT_NE(sentence.find(" MiB are in use"), std::string::npos) << sentence;
  record_failed_allocation(4096);
  EXPECT_TRUE(starts_with(out_of_memory(""), "memory ran out (4096 bytes more were wanted; "));
  record_failed_allocation(std::size_t{80} << 20);
  EXPECT_TRUE(
      starts_with(out_of_memory("a mesh"), "a mesh: memory ran out (80 MiB more were wanted; "));
}

TEST(OutOfMemory, NamesAFailedAllocationOnce) {
  record_failed_allocation(4096);
  (void)out_of_memory("a mesh");
  EXPECT_TRUE(starts_with(out_of_memory("another"), "another: memory ran out ("));
  EXPECT_EQ(out_of_memory("another").find("wanted"), std::string::npos);
}

TEST(OutOfMemory, DoesNotNameFailedAllocationsOfOtherThreads) {
  record_failed_allocation(4096);
  std::string sentence;
  std::thread([&sentence] { sentence = out_of_memory("a mesh"); }).join();
  EXPECT_EQ(sentence.find("wanted"), std::string::npos) << sentence;
}

TEST(OutOfMemory, TurnsBadAllocIntoAnErrorAndNothingElse) {
  const auto ended =
      catch_out_of_memory("a mesh", []() -> Result<void> { throw std::bad_alloc(); });
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::kOutOfMemory);
  EXPECT_TRUE(starts_with(ended.error().message, "a mesh: memory ran out ("));
  EXPECT_TRUE(catch_out_of_memory("a mesh", [] { return Result<void>{}; }));
}

TEST(OutOfMemory, IsCutToTheBuffer) {
  record_failed_allocation(1);
  const std::string whole = out_of_memory("a mesh");
  record_failed_allocation(1);
  std::array<char, 20> buffer;
  EXPECT_EQ(out_of_memory("a mesh", buffer), whole.substr(0, 19));
}

}  // namespace
}  // namespace psygen::core
