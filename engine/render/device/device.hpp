// Selects a physical device and creates the logical one: queues, function table, features and
// limits. Allocates no memory (memory.hpp). Main thread. Private to engine/render.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/render/device/instance.hpp"
#include "engine/render/device/vulkan.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

struct MemoryBlock;

// A physical device. It can be used if info.missing is empty.
struct DeviceCandidate {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;  // for graphics, and for presenting if there is a surface
  DeviceInfo info;
};

// All devices, in the order of the driver. With a surface, a device that cannot present to it lacks
// this. device_choice.hpp chooses one by the infos alone.
std::vector<DeviceCandidate> find_devices(const Instance& instance, VkSurfaceKHR surface);
std::vector<DeviceInfo> infos_of(const std::vector<DeviceCandidate>& candidates);

// The options of Device::create().
struct DeviceOptions {
  bool windowed = false;                // it can present
  bool timestamps = true;               // used if the queue has any
  std::optional<bool> pass_times = {};  // of the passes too; none: on devices that are no software
  double timeout_seconds = 60;          // longest wait for the device; after that it counts as lost
};

// A wait for a semaphore before these stages, or its signal after them. `value`: of a timeline.
VkSemaphoreSubmitInfo semaphore_info(VkSemaphore semaphore, std::uint64_t value,
                                     VkPipelineStageFlags2 stage);

// The logical device. Everything that is created with it must be destroyed before it.
class Device {
 public:
  // Creates the device.
  static core::Result<std::unique_ptr<Device>> create(const DeviceCandidate& candidate,
                                                      const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // Creates an object with a function of the table, such as &VolkDeviceTable::vkCreateImage. `what`
  // is for the error: "creating an image". Fails like vulkan_failure().
  template <class Owner, class Create, class Info>
  core::Result<Owner> make(Create create, const Info& wish, const char* what) const {
    typename Owner::Handle made{};
    const VkResult result = (vk.*create)(handle, &wish, nullptr, &made);
    if (result != VK_SUCCESS) return vulkan_failure(result, what);
    return Owner(vk, handle, made);
  }

  // The largest number of samples up to `wanted` (a power of two) that colour and depth can have.
  VkSampleCountFlagBits samples_for(std::uint32_t wanted) const;

  // Functions, handles, queues and limits; fixed after create().
  DeviceTable vk{};
  VkDevice handle = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  VkQueue transfer_queue = VK_NULL_HANDLE;  // `queue` if there is none only for transfers
  std::uint32_t transfer_family = 0;
  VkPhysicalDeviceMemoryProperties memory{};
  // See memory_block.hpp. Some may have expired.
  mutable std::vector<std::weak_ptr<MemoryBlock>> shared_blocks;
  VkSampleCountFlags sampled_depth_counts = VK_SAMPLE_COUNT_1_BIT;  // of depth read by shaders
  VkSampleCountFlags sample_counts = VK_SAMPLE_COUNT_1_BIT;         // of colour and depth
  std::uint32_t max_multi_draw = 0;                                 // 0: no VK_EXT_multi_draw
  std::uint64_t timestamp_mask = 0;  // the valid bits; 0: no timestamps on the queue
  double timestamp_period_ns = 0;
  DeviceInfo info;

  // Returns when a timeline semaphore has reached `value`. `what` is for the error: "waiting for
  // ...". Fails with kDeviceLost, also after the timeout, which sets vk.hangs.
  core::Result<void> wait(VkSemaphore semaphore, std::uint64_t value, const char* what) const;
  // Queues, one call at a time: a software device's pictures are presented by a thread of their own
  // (RendererImpl::present). submit() fails like vulkan_failure(); `what` is for the error.
  core::Result<void> submit(VkQueue to, VkCommandBuffer commands,
                            std::span<const VkSemaphoreSubmitInfo> waits,
                            std::span<const VkSemaphoreSubmitInfo> signals, const char* what) const;
  VkResult present(const VkPresentInfoKHR& picture) const;
  // Waits for everything that was submitted.
  VkResult wait_idle() const;
  // Size in bytes of the largest device-local heap that the CPU can write.
  std::uint64_t writable_bytes() const;

 private:
  Device() = default;

  std::uint64_t timeout_ns_ = 0;
  mutable std::mutex queues_;
};

}  // namespace psygen::render
