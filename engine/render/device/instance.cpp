#include "engine/render/device/instance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace psygen::render {

using core::ErrorCode;

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                       VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data,
                                       void* instance) {
  static_cast<Instance*>(instance)->add_message(data->pMessage);
  return VK_FALSE;
}

bool has_validation_layer() {
  const auto layers = all_of<VkLayerProperties>(vkEnumerateInstanceLayerProperties);
  return std::ranges::any_of(layers, [](const VkLayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(Instance* instance) {
  return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
          .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                             VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
          .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
          .pfnUserCallback = collect,
          .pUserData = instance};
}

core::Result<void> check_loader(bool validation) {
  if (volkInitialize() != VK_SUCCESS) {
    return core::fail(ErrorCode::kNoDevice, "there is no Vulkan loader on this machine");
  }
  if (volkGetInstanceVersion() < VK_API_VERSION_1_3) {
    return core::fail(ErrorCode::kNoDevice, "the Vulkan loader is older than version 1.3");
  }
  if (validation && !has_validation_layer()) {
    return core::fail(ErrorCode::kNoDevice,
                      fmt::format("validation needs {}, which is not installed", kValidationLayer));
  }
  return {};
}

template <class Function>
void load(VkInstance instance, const char* name, Function& function) {
  function = reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

SurfaceFunctions load_surface_functions(VkInstance instance) {
  SurfaceFunctions f;
  load(instance, "vkDestroySurfaceKHR", f.destroy);
  load(instance, "vkGetPhysicalDeviceSurfaceSupportKHR", f.support);
  load(instance, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR", f.capabilities);
  load(instance, "vkGetPhysicalDeviceSurfaceFormatsKHR", f.formats);
  load(instance, "vkGetPhysicalDeviceSurfacePresentModesKHR", f.present_modes);
  return f;
}

}  // namespace

core::Error vulkan_error(VkResult result, const char* what) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_TOO_MANY_OBJECTS:
    case VK_ERROR_MEMORY_MAP_FAILED:
      return {ErrorCode::kOutOfMemory, fmt::format("{} failed: no memory is left", what)};
    case VK_ERROR_DEVICE_LOST:
      return {ErrorCode::kDeviceLost, fmt::format("{} failed: the device was lost", what)};
    case VK_TIMEOUT:
      return {ErrorCode::kDeviceLost, fmt::format("{} failed: the device does not answer", what)};
    default:
      return {ErrorCode::kInternal,
              fmt::format("{} failed with Vulkan result {}", what, static_cast<int>(result))};
  }
}

core::Result<std::unique_ptr<Instance>> Instance::create(const std::string& application_name,
                                                         bool validation,
                                                         const core::SurfaceProvider* surface) {
  if (const core::Result<void> loader = check_loader(validation); !loader) {
    return tl::unexpected(loader.error());
  }
  std::unique_ptr<Instance> self(new Instance());

  std::vector<std::string> names;
  if (surface != nullptr) names = surface->required_instance_extensions();
  if (validation) names.emplace_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  std::vector<const char*> extensions;
  for (const std::string& name : names)
    extensions.push_back(name.c_str());

  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = application_name.c_str(),
                                      .pEngineName = "psygen",
                                      .apiVersion = VK_API_VERSION_1_3};

  const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(self.get());
  const VkValidationFeatureEnableEXT enabled =
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = &enabled};

  const VkInstanceCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
      .pNext = validation ? &features : nullptr,
      .pApplicationInfo = &application,
      .enabledLayerCount = validation ? 1U : 0U,
      .ppEnabledLayerNames = &kValidationLayer,
      .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
      .ppEnabledExtensionNames = extensions.data()};
  const VkResult result = vkCreateInstance(&info, nullptr, &self->instance_);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
    return core::fail(ErrorCode::kNoDevice, "there is no Vulkan driver on this machine");
  }
  if (result == VK_ERROR_EXTENSION_NOT_PRESENT) {
    return core::fail(ErrorCode::kNoDevice, "the Vulkan driver cannot draw into windows");
  }
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating the Vulkan instance");
  volkLoadInstanceOnly(self->instance_);
  if (surface != nullptr) self->surface_functions_ = load_surface_functions(self->instance_);
  if (validation) {
    load(self->instance_, "vkDestroyDebugUtilsMessengerEXT", self->destroy_messenger_);
    vkCreateDebugUtilsMessengerEXT(self->instance_, &messenger, nullptr, &self->messenger_);
  }
  return self;
}

Instance::~Instance() {
  if (instance_ == VK_NULL_HANDLE) return;
  if (messenger_ != VK_NULL_HANDLE) destroy_messenger_(instance_, messenger_, nullptr);
  vkDestroyInstance(instance_, nullptr);
}

std::vector<VkPhysicalDevice> Instance::physical_devices() const {
  return all_of<VkPhysicalDevice>(
      [this](auto* count, auto* out) { return vkEnumeratePhysicalDevices(instance_, count, out); });
}

std::vector<std::string> Instance::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

void Instance::add_message(const char* text) {
  const std::lock_guard lock(mutex_);
  messages_.emplace_back(text);
}

}  // namespace psygen::render
