#include "engine/image/image_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

#include "engine/core/read_file.hpp"
#include "engine/image/image_io.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::image {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes png(std::uint32_t side, std::uint8_t grey) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_png(folder / "a.png", make_image(side, side, grey, grey, grey)));
  auto bytes = core::read_file(folder / "a.png", 1 << 20);
  return bytes ? std::move(*bytes) : Bytes{};
}

ImagePtr decode(ImageCache& cache, const Bytes& bytes) {
  const auto image = cache.decode(bytes, "a.png", {});
  EXPECT_TRUE(image) << image.error().message;
  return image ? *image : nullptr;
}

TEST(ImageCache, SharesImagesOfEqualBytesAlone) {
  ImageCache cache;
  const Bytes white = png(4, 255), grey = png(4, 9);
  const ImagePtr first = decode(cache, white);
  EXPECT_EQ(*first, make_image(4, 4, 255, 255, 255));
  EXPECT_EQ(decode(cache, Bytes(white)), first);
  EXPECT_EQ(*decode(cache, grey), make_image(4, 4, 9, 9, 9));
}

TEST(ImageCache, KeepsTheLastImagesWithinItsBytesAndFindsThoseInUse) {
  ImageCache cache(2 * 4 * 4 * 4);
  const std::array images{png(4, 1), png(4, 2), png(4, 3)};
  const ImagePtr used = decode(cache, images[0]);
  const std::weak_ptr<const Image> middle = decode(cache, images[1]);
  EXPECT_FALSE(middle.expired());
  const std::weak_ptr<const Image> last = decode(cache, images[2]);
  EXPECT_EQ(used.use_count(), 1) << "the oldest is no longer kept";
  EXPECT_EQ(decode(cache, images[0]), used);
  EXPECT_FALSE(last.expired());
  decode(cache, png(8, 4));
  EXPECT_TRUE(middle.expired() && last.expired()) << "a larger image is not kept either";
}

TEST(ImageCache, ReportsFailuresEachTime) {
  ImageCache cache;
  const Bytes none{1, 2, 3};
  for (const char* name : {"images[0]", "images[1]"}) {
    const auto image = cache.decode(none, name, {});
    ASSERT_FALSE(image);
    EXPECT_THAT(image.error().message, testing::StartsWith(name));
  }
}

TEST(ImageCache, DecodesOnceForAllThreads) {
  ImageCache cache;
  const Bytes bytes = png(256, 7);
  std::array<ImagePtr, 4> found;
  std::vector<std::thread> threads;
  for (ImagePtr& one : found)
    threads.emplace_back([&] { one = decode(cache, bytes); });
  for (std::thread& thread : threads)
    thread.join();
  for (const ImagePtr& one : found)
    EXPECT_EQ(one, found[0]);
}

}  // namespace
}  // namespace psygen::image
