#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/render/device/device.hpp"
#include "engine/render/memory/memory.hpp"
#include "engine/render/renderer.hpp"
#include "tests/faults.hpp"

namespace psygen::render {
namespace {

TEST(RendererFailure, AnUnknownDeviceNameIsAnsweredWithTheNamesThereAre) {
  RendererOptions options;
  options.device_name = "no such card";
  const auto renderer = Renderer::create(options);
  ASSERT_FALSE(renderer);
  EXPECT_EQ(renderer.error().code, core::ErrorCode::kNoDevice);
  EXPECT_NE(renderer.error().message.find("no such card"), std::string::npos);
  const auto devices = list_devices();
  ASSERT_TRUE(devices) << devices.error().message;
  ASSERT_FALSE(devices->empty());
  EXPECT_NE(renderer.error().message.find(devices->front().name), std::string::npos);
}

TEST(RendererFailure, IndexUuidAndAPartOfTheNameChooseADevice) {
  const auto devices = list_devices();
  ASSERT_TRUE(devices) << devices.error().message;
  const DeviceInfo& last = devices->back();
  const std::string index = std::to_string(devices->size() - 1), part = last.name.substr(0, 6);
  for (const std::string& wish : {index, last.uuid, part}) {
    RendererOptions options;
    options.size = {16, 16};
    options.device_name = wish;
    const auto renderer = Renderer::create(options);
    ASSERT_TRUE(renderer) << renderer.error().message;
    EXPECT_NE((*renderer)->device().name.find(part), std::string::npos) << wish;
    EXPECT_EQ((*renderer)->device().uuid, last.uuid) << wish;
    EXPECT_FALSE((*renderer)->device().driver.empty());
  }
}

TEST(RendererFailure, APictureWithoutPixelsIsRefused) {
  RendererOptions options;
  options.size = {0, 720};
  const auto renderer = Renderer::create(options);
  ASSERT_FALSE(renderer);
  EXPECT_EQ(renderer.error().code, core::ErrorCode::kInvalidArgument);
}

TEST(RendererFailure, APictureLargerThanMemoryIsRefused) {
  RendererOptions options;
  options.size = {1u << 30, 1u << 30};
  EXPECT_FALSE(Renderer::create(options));
}

TEST(RendererFailure, AnAllocationThatTheDriverDoesNotAllowNamesTheBytes) {
  const auto instance = Instance::create("test", false, nullptr);
  ASSERT_TRUE(instance) << instance.error().message;
  const auto candidates = find_devices(**instance, VK_NULL_HANDLE);
  ASSERT_FALSE(candidates.empty());
  const auto device = Device::create(candidates.front(), {});
  ASSERT_TRUE(device) << device.error().message;
  const std::uint64_t most = (*device)->info.max_allocation_bytes;
  ASSERT_GT(most, 1U << 20);
  const auto buffer = make_buffer(**device, most + (1 << 20), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                  MemoryUse::kDevice);
  ASSERT_FALSE(buffer);
  EXPECT_EQ(buffer.error().code, core::ErrorCode::kOutOfMemory);
  const std::string end = "the driver allows " + std::to_string(most) + " bytes at once";
  EXPECT_NE(buffer.error().message.find(end), std::string::npos) << buffer.error().message;
}

// In a process of its own: the environment decides which drivers the loader finds.
void create_without_drivers() {
  setenv("VK_ICD_FILENAMES", "/nonexistent/driver.json", 1);
  setenv("VK_DRIVER_FILES", "/nonexistent/driver.json", 1);
  const auto renderer = Renderer::create({});
  const bool clear = !renderer && renderer.error().code == core::ErrorCode::kNoDevice;
  std::fprintf(stderr, "%s\n", renderer ? "there was a device" : renderer.error().message.c_str());
  std::_Exit(clear ? 4 : 1);
}

TEST(RendererFailureDeathTest, AMachineWithoutADriverGetsOneClearSentence) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(create_without_drivers(), testing::ExitedWithCode(4), "no Vulkan driver");
}

// llvmpipe that gets only some of its threads waits for the others for ever.
void create_with_few_threads_of_the_driver() {
  for (std::size_t left = 0; left < 6; ++left) {
    const FewThreads few(left, "libvulkan_");
    RendererOptions options;
    options.size = {16, 16};
    options.device_timeout_seconds = 0.2;
    const auto renderer = Renderer::create(options);
    if (!renderer) std::fprintf(stderr, "%s\n", renderer.error().message.c_str());
  }
  std::_Exit(0);
}

TEST(RendererFailureDeathTest, ADriverThatNeverAnswersIsGivenUpAndNotWaitedForAtTheEnd) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(create_with_few_threads_of_the_driver(), testing::ExitedWithCode(0), "");
}

int destroyed_buffers = 0;

TEST(RendererFailure, ObjectsOfADeviceThatHangsAreNotDestroyed) {
  DeviceTable table;
  table.vkDestroyBuffer = [](VkDevice, VkBuffer, const VkAllocationCallbacks*) {
    ++destroyed_buffers;
  };
  // A value that is never used as a pointer.
  const auto buffer = reinterpret_cast<VkBuffer>(&table);
  { const UniqueBuffer answers(table, VK_NULL_HANDLE, buffer); }
  EXPECT_EQ(destroyed_buffers, 1);
  {
    const UniqueBuffer used(table, VK_NULL_HANDLE, buffer);
    table.hangs = true;
  }
  EXPECT_EQ(destroyed_buffers, 1);
}

}  // namespace
}  // namespace psygen::render
