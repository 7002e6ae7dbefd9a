#include "engine/render/memory/memory_block.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "engine/render/device/device_choice.hpp"
#include "engine/render/memory/memory.hpp"

namespace psygen::render {
namespace {

class MemoryBlocks : public testing::Test {
 protected:
  void SetUp() override {
    auto instance = Instance::create("test", false, nullptr);
    ASSERT_TRUE(instance) << instance.error().message;
    instance_ = *std::move(instance);
    const auto found = find_devices(*instance_, VK_NULL_HANDLE);
    const auto chosen = choose_device(infos_of(found), "");
    ASSERT_TRUE(chosen) << chosen.error().message;
    auto device = Device::create(found[*chosen], {});
    ASSERT_TRUE(device) << device.error().message;
    device_ = *std::move(device);
  }
  Buffer buffer(std::uint64_t bytes) {
    auto made = make_buffer(*device_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::kWrite);
    if (!made) ADD_FAILURE() << made.error().message;
    return made ? *std::move(made) : Buffer{};
  }
  std::uint64_t bytes() const { return device_->vk.memory_bytes; }

  std::unique_ptr<Instance> instance_;
  std::unique_ptr<Device> device_;
};

TEST_F(MemoryBlocks, AreSharedBySmallBuffersWhoseBytesStayApart) {
  constexpr std::size_t kBytes = 1000;
  std::vector<Buffer> buffers;
  for (int i = 0; i < 100; ++i) {
    buffers.push_back(buffer(kBytes));
    std::memset(buffers.back().mapped, i, kBytes);
  }
  EXPECT_EQ(bytes(), MemoryBlock::kSharedBytes);
  for (int i = 0; i < 100; ++i) {
    const auto& made = buffers[static_cast<std::size_t>(i)];
    EXPECT_EQ(made.memory.memory(), buffers[0].memory.memory());
    EXPECT_EQ(made.mapped[0], std::byte(i));
    EXPECT_EQ(made.mapped[kBytes - 1], std::byte(i));
  }
}

TEST_F(MemoryBlocks, AreFreedWithTheirLastRangeAndReusedBefore) {
  Buffer first = buffer(900'000);
  {
    std::vector<Buffer> others;
    for (int i = 0; i < 8; ++i)
      others.push_back(buffer(900'000));
    EXPECT_GT(bytes(), MemoryBlock::kSharedBytes);
  }
  EXPECT_EQ(bytes(), MemoryBlock::kSharedBytes);
  const Buffer again = buffer(900'000);
  EXPECT_EQ(again.memory.memory(), first.memory.memory());
  first = Buffer{};
  EXPECT_EQ(bytes(), MemoryBlock::kSharedBytes);
}

TEST_F(MemoryBlocks, HoldEitherBuffersOrImagesAndNothingLarge) {
  const Buffer small = buffer(1000), large = buffer(MemoryBlock::kSmallBytes);
  EXPECT_NE(small.memory.memory(), large.memory.memory());
  EXPECT_EQ(large.memory.offset(), 0U);
  const auto image = make_image(*device_, {8, 8}, VK_FORMAT_R8G8B8A8_UNORM,
                                VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_NE(image->memory.memory(), small.memory.memory());
}

TEST_F(MemoryBlocks, GiveRangesTheirAlignment) {
  const Buffer before = buffer(300);
  constexpr std::uint64_t kAlignment = 64 << 10;
  const MemoryWish wish{.needs = {.size = 5000, .alignment = kAlignment, .memoryTypeBits = ~0U}};
  const auto first = allocate(*device_, wish, {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT});
  const auto second = allocate(*device_, wish, {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->offset() % kAlignment, 0U);
  EXPECT_EQ(second->offset() % kAlignment, 0U);
  EXPECT_NE(first->offset(), second->offset());
  EXPECT_LE(second->offset() + 5000, MemoryBlock::kSharedBytes);
}

}  // namespace
}  // namespace psygen::render
