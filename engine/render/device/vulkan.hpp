// Vulkan for this folder: volk's function tables, owning handles, and results as errors. All other
// files include Vulkan through it. Private to engine/render.
#pragma once

#define VK_NO_PROTOTYPES
#include "volk_names.h"  // before volk.h: prefixes of its names (CMakeLists.txt)
//
#include <volk.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::render {

// A failed result as an error: kOutOfMemory, kDeviceLost or kInternal with a sentence "<what>
// failed: <result>".
core::Error vulkan_error(VkResult result, const char* what);

// The same for a return statement.
inline tl::unexpected<core::Error> vulkan_failure(VkResult result, const char* what) {
  return tl::unexpected(vulkan_error(result, what));
}

// For Result::map(): moves a value to the place where it is kept, which must outlive the call.
template <class T>
auto into(T& place) {
  return [&place](T made) { place = std::move(made); };
}

// All elements that a function of Vulkan lists: list(count, elements).
template <class T, class List>
std::vector<T> all_of(const List& list) {
  std::uint32_t count = 0;
  list(&count, static_cast<T*>(nullptr));
  std::vector<T> found(count);
  list(&count, found.data());
  found.resize(count);
  return found;
}

// The functions of a VkDevice.
struct DeviceTable : VolkDeviceTable {
  // A wait for the device has timed out. It may still use its objects, and destroying them may wait
  // for ever. So from then on they are leaked.
  mutable bool hangs = false;
  mutable std::atomic<std::uint64_t> memory_bytes{0};  // of all UniqueMemory
};

// An owning handle of an object of a VkDevice. `Destroy` is the function of the table that destroys
// it. Move-only. The table and the device must outlive it.
template <class T, auto Destroy>
class DeviceHandle {
 public:
  using Handle = T;

  // Empty, or the owner of `handle`.
  DeviceHandle() = default;
  DeviceHandle(const DeviceTable& vk, VkDevice device, T handle)
      : vk_(&vk), device_(device), handle_(handle) {}
  DeviceHandle(DeviceHandle&& other) noexcept
      : vk_(other.vk_), device_(other.device_), handle_(std::exchange(other.handle_, {})) {}
  DeviceHandle& operator=(DeviceHandle&& other) noexcept {
    std::swap(vk_, other.vk_);
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~DeviceHandle() {
    if (handle_ != T{} && !vk_->hangs) (vk_->*Destroy)(device_, handle_, nullptr);
  }
  // True if it owns a handle; the handle, null if empty; and its address for Vulkan's arrays.
  bool exists() const { return handle_ != T{}; }
  T get() const { return handle_; }
  const T* address() const { return &handle_; }

 private:
  const DeviceTable* vk_ = nullptr;
  VkDevice device_ = VK_NULL_HANDLE;
  T handle_{};
};

// An owning handle of device memory. Counts its bytes in the table. Move-only.
class UniqueMemory {
 public:
  UniqueMemory() = default;
  UniqueMemory(const DeviceTable& vk, VkDevice device, VkDeviceMemory memory, std::uint64_t bytes)
      : vk_(&vk), memory_(vk, device, memory), bytes_(bytes) {
    vk.memory_bytes += bytes;
  }
  UniqueMemory(UniqueMemory&& other) noexcept
      : vk_(other.vk_), memory_(std::move(other.memory_)), bytes_(std::exchange(other.bytes_, 0)) {}
  UniqueMemory& operator=(UniqueMemory&& other) noexcept {
    std::swap(vk_, other.vk_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~UniqueMemory() {
    if (bytes_ > 0) vk_->memory_bytes -= bytes_;
  }
  VkDeviceMemory get() const { return memory_.get(); }

 private:
  const DeviceTable* vk_ = nullptr;
  DeviceHandle<VkDeviceMemory, &VolkDeviceTable::vkFreeMemory> memory_;
  std::uint64_t bytes_ = 0;
};

// Owning handles of the objects that the renderer uses.
using UniqueBuffer = DeviceHandle<VkBuffer, &VolkDeviceTable::vkDestroyBuffer>;
using UniqueImage = DeviceHandle<VkImage, &VolkDeviceTable::vkDestroyImage>;
using UniqueImageView = DeviceHandle<VkImageView, &VolkDeviceTable::vkDestroyImageView>;
using UniqueSampler = DeviceHandle<VkSampler, &VolkDeviceTable::vkDestroySampler>;
using UniqueSemaphore = DeviceHandle<VkSemaphore, &VolkDeviceTable::vkDestroySemaphore>;
using UniqueCommandPool = DeviceHandle<VkCommandPool, &VolkDeviceTable::vkDestroyCommandPool>;
using UniqueQueryPool = DeviceHandle<VkQueryPool, &VolkDeviceTable::vkDestroyQueryPool>;
using UniqueShaderModule = DeviceHandle<VkShaderModule, &VolkDeviceTable::vkDestroyShaderModule>;
using UniquePipeline = DeviceHandle<VkPipeline, &VolkDeviceTable::vkDestroyPipeline>;
using UniquePipelineLayout =
    DeviceHandle<VkPipelineLayout, &VolkDeviceTable::vkDestroyPipelineLayout>;
using UniqueSetLayout =
    DeviceHandle<VkDescriptorSetLayout, &VolkDeviceTable::vkDestroyDescriptorSetLayout>;
using UniqueDescriptorPool =
    DeviceHandle<VkDescriptorPool, &VolkDeviceTable::vkDestroyDescriptorPool>;
using UniqueSwapchain = DeviceHandle<VkSwapchainKHR, &VolkDeviceTable::vkDestroySwapchainKHR>;

}  // namespace psygen::render
