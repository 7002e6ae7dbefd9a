// The Vulkan instance: loads the Vulkan loader, enables validation if requested and collects its
// messages. Selects no device (device.hpp). Main thread, except messages. Private to engine/render.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/render/vulkan.hpp"

namespace psygen::render {

// The functions of the surface extensions of one instance. volk's global pointers belong to the
// last created instance, which may lack these extensions.
struct SurfaceFunctions {
  PFN_vkDestroySurfaceKHR destroy = nullptr;
  PFN_vkGetPhysicalDeviceSurfaceSupportKHR support = nullptr;
  PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR capabilities = nullptr;
  PFN_vkGetPhysicalDeviceSurfaceFormatsKHR formats = nullptr;
  PFN_vkGetPhysicalDeviceSurfacePresentModesKHR present_modes = nullptr;
};

// One instance. Devices and surfaces must be destroyed before it.
class Instance {
 public:
  // Creates an instance. With a `surface` it has the surface's extensions. Fails with kNoDevice if
  // there is no loader for Vulkan 1.3, no driver, or no validation layer although `validation` is
  // set.
  static core::Result<std::unique_ptr<Instance>> create(const std::string& application_name,
                                                        bool validation,
                                                        const core::SurfaceProvider* surface);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  // The handle, the functions (null without a surface), and all physical devices.
  VkInstance get() const { return instance_; }
  const SurfaceFunctions& surface_functions() const { return surface_functions_; }
  std::vector<VkPhysicalDevice> physical_devices() const;
  // The messages of validation so far, and one more. Any thread.
  std::vector<std::string> messages() const;
  void add_message(const char* text);

 private:
  Instance() = default;

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger_ = nullptr;
  SurfaceFunctions surface_functions_;
  mutable std::mutex mutex_;  // layers may report from threads of the driver
  std::vector<std::string> messages_;
};

}  // namespace psygen::render
