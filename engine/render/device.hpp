// Choosing a physical device and making the logical one: queue, function table, what it offers.
// Private to engine/render.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/render/instance.hpp"
#include "engine/render/types.hpp"
#include "engine/render/vulkan.hpp"

namespace psygen::render {

// A physical device that has everything the renderer needs.
struct DeviceCandidate {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;  // graphics, and presenting where there is a surface
  int rank = 0;                    // higher is better: discrete, integrated, virtual, software
  DeviceInfo info;
};

// Best first. With a surface only devices that can present to it.
std::vector<DeviceCandidate> find_devices(const Instance& instance, VkSurfaceKHR surface);

// The best candidate whose name contains `name` (any when empty); kNoDevice with the names there
// are.
core::Result<DeviceCandidate> choose_device(const std::vector<DeviceCandidate>& candidates,
                                            const std::string& name);

class Device {
 public:
  // `timestamps`: where its queue has any. `timeout_seconds`: the longest wait for the device; then
  // it counts as lost.
  static core::Result<std::unique_ptr<Device>> create(const DeviceCandidate& candidate,
                                                      bool windowed, bool timestamps,
                                                      double timeout_seconds);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // The largest number of samples up to `wanted` that colour and depth can have.
  VkSampleCountFlagBits samples_for(std::uint32_t wanted) const;

  VolkDeviceTable vk{};
  VkDevice handle = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  VkQueue transfer_queue = VK_NULL_HANDLE;  // `queue` where there is none for transfers alone
  std::uint32_t transfer_family = 0;
  VkPhysicalDeviceMemoryProperties memory{};
  std::uint32_t max_image_side = 0;                                 // pixels
  VkSampleCountFlags sampled_depth_counts = VK_SAMPLE_COUNT_1_BIT;  // of depth that shaders read
  VkSampleCountFlags sample_counts = VK_SAMPLE_COUNT_1_BIT;         // of colour and depth
  std::uint32_t max_multi_draw = 0;                                 // 0: no VK_EXT_multi_draw
  std::uint64_t timestamp_mask = 0;  // the bits that count; 0: no timestamps on the queue
  double timestamp_period_ns = 0;
  DeviceInfo info;

  // Returns when a semaphore that counts has come to `value`; `what` is "waiting for ...". Fails
  // with kDeviceLost.
  core::Result<void> wait(VkSemaphore semaphore, std::uint64_t value, const char* what) const;
  // A wait came to no end: then the driver must not be asked to end anything either.
  bool hangs() const { return hangs_; }

  // Bytes of the largest heap of its own memory that the CPU can write.
  std::uint64_t writable_bytes() const;

 private:
  Device() = default;

  std::uint64_t timeout_ns_ = 0;
  mutable bool hangs_ = false;
};

}  // namespace psygen::render
