// The Vulkan instance: loads the loader, switches validation on when asked, collects what it says.
// Private to engine/render.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/render/vulkan.hpp"

namespace psygen::render {

// The functions of the surface extensions, of one instance. volk's own pointers are those of the
// instance made last, which need not have these extensions.
struct SurfaceFunctions {
  PFN_vkDestroySurfaceKHR destroy = nullptr;
  PFN_vkGetPhysicalDeviceSurfaceSupportKHR support = nullptr;
  PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR capabilities = nullptr;
  PFN_vkGetPhysicalDeviceSurfaceFormatsKHR formats = nullptr;
  PFN_vkGetPhysicalDeviceSurfacePresentModesKHR present_modes = nullptr;
};

class Instance {
 public:
  // Fails with kNoDevice without a loader for Vulkan 1.3 or without any driver, and where
  // validation was asked for but its layer is missing.
  static core::Result<std::unique_ptr<Instance>> create(const std::string& application_name,
                                                        bool validation,
                                                        const core::SurfaceProvider* surface);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance get() const { return instance_; }
  const SurfaceFunctions& surface_functions() const { return surface_functions_; }
  std::vector<VkPhysicalDevice> physical_devices() const;
  std::vector<std::string> messages() const;
  void add_message(const char* text);

 private:
  Instance() = default;

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger_ = nullptr;
  SurfaceFunctions surface_functions_;
  mutable std::mutex mutex_;  // layers may report from the driver's threads
  std::vector<std::string> messages_;
};

}  // namespace psygen::render
