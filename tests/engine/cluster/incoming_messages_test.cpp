// Tests the order of messages whose transfers complete out of order.
#include "engine/cluster/incoming_messages.hpp"

#include <gtest/gtest.h>

namespace psygen::cluster {
namespace {

using Coming = IncomingMessages<bool>;

std::optional<Parcel> take(Coming& coming) {
  return coming.take_whole([](bool is_whole) { return is_whole; });
}

TEST(IncomingMessages, ASmallMessageWaitsForALargeOneOfItsRank) {
  Coming coming;
  Coming::Coming& large = coming.begin(1, 1000);
  coming.begin(1, 1).request = true;
  EXPECT_FALSE(take(coming).has_value());
  large.request = true;
  EXPECT_EQ(take(coming)->bytes.size(), 1000u);
  EXPECT_EQ(take(coming)->bytes.size(), 1u);
  EXPECT_FALSE(take(coming).has_value());
}

TEST(IncomingMessages, ARankThatStopsInsideAMessageDelaysNoOther) {
  Coming coming;
  coming.begin(1, 1000);
  coming.begin(2, 10).request = true;
  coming.begin(1, 1).request = true;
  EXPECT_EQ(take(coming)->from, 2u);
  EXPECT_FALSE(take(coming).has_value());
}

TEST(IncomingMessages, AnOldTransferIsNotExpectedSoon) {
  Coming coming;
  const Coming::Clock::time_point begun{std::chrono::seconds(10)};
  EXPECT_FALSE(coming.any_since({}));
  coming.begin(1, 1000, begun);
  EXPECT_TRUE(coming.any_since(begun - std::chrono::milliseconds(1)));
  EXPECT_FALSE(coming.any_since(begun));
}

}  // namespace
}  // namespace psygen::cluster
