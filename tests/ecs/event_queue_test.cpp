// Every reader sees every event once, and a reader that does not drain costs a bounded number.
#include "ecs/event_queue.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace psygen::ecs::test {
namespace {

std::vector<int> drained(EventReader<int>& reader) {
  std::vector<int> all;
  reader.drain(
      [&all](std::span<const int> events) { all.insert(all.end(), events.begin(), events.end()); });
  return all;
}

TEST(EventQueue, EveryReaderSeesEveryEventOnceAndInOrder) {
  EventQueue<int> queue;
  EventReader<int> first = queue.reader();
  queue.emit(1);
  EventReader<int> second = queue.reader();
  queue.emit(std::vector{2, 3});
  EXPECT_EQ(drained(first), (std::vector{1, 2, 3}));
  EXPECT_EQ(drained(first), std::vector<int>{});
  queue.emit(4);
  EXPECT_EQ(drained(second), (std::vector{2, 3, 4}));
  EXPECT_EQ(drained(first), std::vector{4});
  EXPECT_EQ(queue.size(), 0U);
}

TEST(EventQueue, WithoutReadersNothingIsKept) {
  EventQueue<int> queue;
  queue.emit(1);
  EXPECT_FALSE(queue.has_readers());
  EXPECT_EQ(queue.size(), 0U);
  {
    EventReader<int> reader = queue.reader();
    queue.emit(2);
    EXPECT_EQ(queue.size(), 1U);
  }
  EXPECT_FALSE(queue.has_readers());
  EXPECT_EQ(queue.size(), 0U);
}

TEST(EventQueue, AMillionEventsWithoutADrainAreBoundedAndCounted) {
  EventQueue<int> queue(1000);
  EventReader<int> sleeper = queue.reader();
  EventReader<int> reader = queue.reader();
  std::uint64_t seen = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    queue.emit(i);
    seen += reader.drain([](std::span<const int>) {});
  }
  EXPECT_EQ(seen, 1'000'000U);
  EXPECT_LE(queue.size(), 1000U);
  const std::vector<int> left = drained(sleeper);
  EXPECT_EQ(left.size() + queue.dropped(), 1'000'000U);
  EXPECT_EQ(left.back(), 999'999);  // the newest are kept
  EXPECT_EQ(left.front(), 1'000'000 - static_cast<int>(left.size()));
}

TEST(EventQueue, ABatchLargerThanTheBoundKeepsItsNewestEvents) {
  EventQueue<int> queue(3);
  EventReader<int> reader = queue.reader();
  queue.emit(7);
  std::vector<int> many(10);
  std::iota(many.begin(), many.end(), 0);
  queue.emit(many);
  EXPECT_EQ(drained(reader), (std::vector{7, 8, 9}));
  EXPECT_EQ(queue.dropped(), 8U);
}

TEST(EventQueue, AReaderCanBeMovedAndOutliveItsQueue) {
  auto queue = std::make_unique<EventQueue<int>>();
  EventReader<int> reader = queue->reader();
  queue->emit(1);
  EventReader<int> moved = std::move(reader);
  queue->emit(2);
  queue.reset();
  EXPECT_EQ(drained(moved), (std::vector{1, 2}));
}

}  // namespace
}  // namespace psygen::ecs::test
