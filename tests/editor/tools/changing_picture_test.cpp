#include "editor/tools/changing_picture.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <thread>
#include <vector>

namespace psygen::editor {
namespace {

constexpr std::uint32_t kWidth = 40, kHeight = 30;

PicturePtr white() {
  auto picture = std::make_shared<world::GreyPicture>();
  picture->width = kWidth, picture->height = kHeight;
  picture->pixels.assign(std::size_t{kWidth} * kHeight, 65535);
  picture->hash = world::content_hash(*picture);
  return picture;
}

PixelRect some_rect(std::mt19937& random) {
  const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); };
  const std::uint32_t x = below(kWidth), y = below(kHeight);
  return {x, y, x + 1 + below(kWidth - x), y + 1 + below(kHeight - y)};
}

void fill(world::GreyPicture& picture, const PixelRect& rect, std::uint16_t value) {
  for (std::uint32_t y = rect.top; y < rect.bottom; ++y)
    for (std::uint32_t x = rect.left; x < rect.right; ++x)
      picture.pixels[std::size_t{y} * kWidth + x] = value;
}

TEST(ChangingPicture, EachStateContainsAllChangesAndStaysWhileItIsInUse) {
  std::mt19937 random(7);
  world::GreyPicture plain = *white();
  ChangingPicture changing(white());
  std::vector<std::pair<PicturePtr, world::GreyPicture>> held;
  for (std::uint16_t step = 1; step < 300; ++step) {
    const PixelRect rect = some_rect(random);
    fill(plain, rect, step);
    plain.hash = world::content_hash(plain);
    changing.change(rect, [&](world::GreyPicture& picture) { fill(picture, rect, step); });
    ASSERT_EQ(changing.now()->pixels, plain.pixels) << step;
    ASSERT_EQ(changing.now()->hash, plain.hash) << step;
    if (random() % 3 == 0) held.emplace_back(changing.now(), plain);
    if (held.size() > 5) held.erase(held.begin() + static_cast<std::ptrdiff_t>(random() % 5));
    for (const auto& [state, as_it_was] : held)
      ASSERT_EQ(state->pixels, as_it_was.pixels) << step;
  }
}

TEST(ChangingPicture, MemoryOfReleasedStatesIsReused) {
  ChangingPicture changing(white());
  std::set<const world::GreyPicture*> memory;
  PicturePtr shown, prepared;
  for (std::uint16_t step = 0; step < 100; ++step) {
    const PixelRect rect{step % kWidth, 3, step % kWidth + 1, 4};
    changing.change(rect, [&](world::GreyPicture& picture) { fill(picture, rect, step); });
    memory.insert(changing.now().get());
    shown = std::exchange(prepared, changing.now());
  }
  EXPECT_LE(memory.size(), 4U) << "the newest, the two that are held, and the one that is made";
}

TEST(ChangingPicture, OtherThreadsReadAndReleaseStates) {
  auto changing = std::make_unique<ChangingPicture>(white());
  std::vector<std::thread> readers;
  for (std::uint16_t step = 0; step < 40; ++step) {
    const PixelRect rect{0, 0, kWidth, kHeight};
    changing->change(rect, [&](world::GreyPicture& picture) { fill(picture, rect, step); });
    readers.emplace_back([state = changing->now(), step]() mutable {
      for (const std::uint16_t pixel : state->pixels)
        EXPECT_EQ(pixel, step);
      state.reset();
    });
  }
  const PicturePtr last = changing->now();
  changing.reset();  // ends before its states
  EXPECT_EQ(last->pixels.front(), 39);
  for (std::thread& reader : readers)
    reader.join();
}

}  // namespace
}  // namespace psygen::editor
