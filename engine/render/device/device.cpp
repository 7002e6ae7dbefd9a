#include "engine/render/device/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace psygen::render {

namespace {

bool has_extension(VkPhysicalDevice physical, const char* name) {
  const auto extensions = all_of<VkExtensionProperties>([&](auto* count, auto* out) {
    return vkEnumerateDeviceExtensionProperties(physical, nullptr, count, out);
  });
  return std::ranges::any_of(extensions, [&](const VkExtensionProperties& e) {
    return std::strcmp(e.extensionName, name) == 0;
  });
}

// The features that the renderer uses, chained for a query or for creation. Not movable.
struct FeatureChain {
  VkPhysicalDeviceMultiDrawFeaturesEXT multi_draw{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTI_DRAW_FEATURES_EXT};
  VkPhysicalDeviceVulkan13Features v13{.sType =
                                           VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
  VkPhysicalDeviceVulkan11Features v11{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, .pNext = &v12};
  VkPhysicalDeviceFeatures2 base{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                 .pNext = &v11};

  FeatureChain() = default;
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;

  // The features without which the renderer draws nothing, and which are not there.
  std::vector<std::string> missing() const {
    std::vector<std::string> names;
    if (!v12.timelineSemaphore) names.emplace_back("timelineSemaphore");
    if (!v13.dynamicRendering) names.emplace_back("dynamicRendering");
    if (!v13.synchronization2) names.emplace_back("synchronization2");
    return names;
  }
};

// The GPU path needs indirect draws with their number in a buffer. Its shaders, and those of
// multi-draw, look up the data of a draw by the number of the draw.
bool offers_gpu_path(const FeatureChain& features) {
  return features.v11.shaderDrawParameters && features.v12.drawIndirectCount &&
         features.base.features.multiDrawIndirect &&
         features.base.features.drawIndirectFirstInstance;
}

bool offers_multi_draw(VkPhysicalDevice physical) {
  if (!has_extension(physical, VK_EXT_MULTI_DRAW_EXTENSION_NAME)) return false;
  FeatureChain features;
  features.v13.pNext = &features.multi_draw;
  vkGetPhysicalDeviceFeatures2(physical, &features.base);
  return features.v11.shaderDrawParameters && features.multi_draw.multiDraw;
}

std::vector<VkQueueFamilyProperties> families_of(VkPhysicalDevice physical) {
  return all_of<VkQueueFamilyProperties>([&](auto* count, auto* out) {
    vkGetPhysicalDeviceQueueFamilyProperties(physical, count, out);
  });
}

std::optional<std::uint32_t> find_queue_family(const Instance& instance, VkPhysicalDevice physical,
                                               VkSurfaceKHR surface) {
  const std::vector<VkQueueFamilyProperties> families = families_of(physical);
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) continue;
    VkBool32 presents = VK_TRUE;
    if (surface != VK_NULL_HANDLE) {
      instance.surface_functions().support(physical, i, surface, &presents);
    }
    if (presents) return i;
  }
  return std::nullopt;
}

// A queue family only for transfers, or else the graphics family.
std::uint32_t transfer_family_of(VkPhysicalDevice physical, std::uint32_t graphics) {
  const std::vector<VkQueueFamilyProperties> families = families_of(physical);
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    const VkQueueFlags flags = families[i].queueFlags;
    if ((flags & VK_QUEUE_TRANSFER_BIT) != 0 &&
        (flags & (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT)) == 0)
      return i;
  }
  return graphics;
}

// The valid bits of a timestamp; 0: no timestamps.
std::uint64_t timestamp_mask_of(VkPhysicalDevice physical, std::uint32_t family) {
  const std::uint32_t bits = families_of(physical)[family].timestampValidBits;
  return bits == 0 ? 0 : UINT64_MAX >> (64 - std::min(bits, 64U));
}

DeviceType type_of(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return DeviceType::kDiscrete;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return DeviceType::kIntegrated;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return DeviceType::kVirtual;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return DeviceType::kSoftware;
    default:
      return DeviceType::kOther;
  }
}

std::string version_text(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

std::string uuid_text(const std::uint8_t (&bytes)[VK_UUID_SIZE]) {
  std::string text;
  for (std::size_t i = 0; i < VK_UUID_SIZE; ++i)
    text += fmt::format("{}{:02x}", i >= 4 && i <= 10 && i % 2 == 0 ? "-" : "", bytes[i]);
  return text;
}

std::uint64_t device_local_bytes(VkPhysicalDevice physical) {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  std::uint64_t bytes = 0;
  for (const VkMemoryHeap& heap : std::span(memory.memoryHeaps, memory.memoryHeapCount))
    if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) bytes += heap.size;
  return bytes;
}

DeviceInfo describe(VkPhysicalDevice physical, std::uint32_t& api_version) {
  VkPhysicalDeviceDriverProperties driver{.sType =
                                              VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceIDProperties ids{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES,
                                   .pNext = &driver};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &ids};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  const VkPhysicalDeviceProperties& p = properties.properties;
  api_version = p.apiVersion;
  return {.name = p.deviceName,
          .uuid = uuid_text(ids.deviceUUID),
          .driver = driver.driverInfo[0] == '\0'
                        ? driver.driverName
                        : fmt::format("{} {}", driver.driverName, driver.driverInfo),
          .api_version = version_text(p.apiVersion),
          .type = type_of(p.deviceType),
          .memory_bytes = device_local_bytes(physical)};
}

DeviceCandidate examine(const Instance& instance, VkPhysicalDevice physical, VkSurfaceKHR surface) {
  DeviceCandidate candidate{.physical = physical};
  std::uint32_t api_version = 0;
  DeviceInfo& info = candidate.info = describe(physical, api_version);
  if (api_version < VK_API_VERSION_1_3) {  // its features cannot be asked for
    info.missing.push_back(fmt::format("Vulkan 1.3: it has {}", info.api_version));
    return candidate;
  }
  FeatureChain features;
  vkGetPhysicalDeviceFeatures2(physical, &features.base);
  info.missing = features.missing();
  if (surface != VK_NULL_HANDLE && !has_extension(physical, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
    info.missing.emplace_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  const std::optional<std::uint32_t> family = find_queue_family(instance, physical, surface);
  if (!family) {
    info.missing.emplace_back(surface == VK_NULL_HANDLE
                                  ? "a queue for graphics"
                                  : "a queue for graphics that presents to this window");
    return candidate;
  }
  candidate.queue_family = *family;
  info.multi_draw = offers_multi_draw(physical);
  info.gpu_path = offers_gpu_path(features) &&
                  (families_of(physical)[*family].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0;
  info.wireframe = features.base.features.fillModeNonSolid == VK_TRUE;
  return candidate;
}

// Enables the features that psygen needs on every device, and the optional ones that exist.
void enable(const DeviceInfo& info, FeatureChain& features, std::vector<const char*>& extensions) {
  features.v11.shaderDrawParameters = info.numbers_draws() ? VK_TRUE : VK_FALSE;
  features.v12.timelineSemaphore = VK_TRUE;
  const VkBool32 indirect = info.gpu_path ? VK_TRUE : VK_FALSE;
  features.v12.drawIndirectCount = indirect;
  features.base.features.multiDrawIndirect = indirect;
  features.base.features.drawIndirectFirstInstance = indirect;
  features.v13.dynamicRendering = VK_TRUE;
  features.v13.synchronization2 = VK_TRUE;
  features.v13.maintenance4 = VK_TRUE;  // for workgroup sizes; every 1.3 device has it
  if (info.multi_draw) {
    extensions.push_back(VK_EXT_MULTI_DRAW_EXTENSION_NAME);
    features.multi_draw.multiDraw = VK_TRUE;
    features.v13.pNext = &features.multi_draw;
  }
  features.base.features.fillModeNonSolid = info.wireframe ? VK_TRUE : VK_FALSE;
}

void read_limits(Device& device) {
  VkPhysicalDeviceMultiDrawPropertiesEXT multi_draw{};
  multi_draw.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTI_DRAW_PROPERTIES_EXT;
  VkPhysicalDeviceMaintenance3Properties sizes{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES,
      .pNext = device.info.multi_draw ? &multi_draw : nullptr};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &sizes};
  vkGetPhysicalDeviceProperties2(device.physical, &properties);
  const VkPhysicalDeviceLimits& limits = properties.properties.limits;
  device.info.max_allocation_bytes = sizes.maxMemoryAllocationSize;
  device.info.max_image_side = limits.maxImageDimension2D;
  device.sampled_depth_counts = limits.sampledImageDepthSampleCounts;
  device.sample_counts = limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts;
  device.max_multi_draw = multi_draw.maxMultiDrawCount;
  device.timestamp_period_ns = static_cast<double>(limits.timestampPeriod);
}

}  // namespace

std::vector<DeviceCandidate> find_devices(const Instance& instance, VkSurfaceKHR surface) {
  std::vector<DeviceCandidate> found;
  for (VkPhysicalDevice physical : instance.physical_devices())
    found.push_back(examine(instance, physical, surface));
  return found;
}

std::vector<DeviceInfo> infos_of(const std::vector<DeviceCandidate>& candidates) {
  std::vector<DeviceInfo> infos;
  infos.reserve(candidates.size());
  for (const DeviceCandidate& candidate : candidates)
    infos.push_back(candidate.info);
  return infos;
}

VkSemaphoreSubmitInfo semaphore_info(VkSemaphore semaphore, std::uint64_t value,
                                     VkPipelineStageFlags2 stage) {
  return {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
          .semaphore = semaphore,
          .value = value,
          .stageMask = stage};
}

core::Result<std::unique_ptr<Device>> Device::create(const DeviceCandidate& candidate,
                                                     const DeviceOptions& options) {
  std::unique_ptr<Device> self(new Device());
  self->timeout_ns_ = static_cast<std::uint64_t>(options.timeout_seconds * 1e9);
  self->physical = candidate.physical;
  self->queue_family = candidate.queue_family;
  self->transfer_family = transfer_family_of(self->physical, self->queue_family);
  self->info = candidate.info;
  vkGetPhysicalDeviceMemoryProperties(self->physical, &self->memory);

  FeatureChain features;
  std::vector<const char*> extensions;
  if (options.windowed) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  enable(candidate.info, features, extensions);
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                .queueFamilyIndex = self->queue_family,
                                .queueCount = 1,
                                .pQueuePriorities = &priority};
  std::vector<VkDeviceQueueCreateInfo> queues{queue};
  queue.queueFamilyIndex = self->transfer_family;
  if (self->transfer_family != self->queue_family) queues.push_back(queue);
  VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                          .pNext = &features.base,
                          .queueCreateInfoCount = static_cast<std::uint32_t>(queues.size()),
                          .pQueueCreateInfos = queues.data(),
                          .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                          .ppEnabledExtensionNames = extensions.data()};
  const VkResult result = vkCreateDevice(self->physical, &info, nullptr, &self->handle);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating the Vulkan device");
  volkLoadDeviceTable(&self->vk, self->handle);
  self->vk.vkGetDeviceQueue(self->handle, self->queue_family, 0, &self->queue);
  self->vk.vkGetDeviceQueue(self->handle, self->transfer_family, 0, &self->transfer_queue);

  read_limits(*self);
  if (options.timestamps)
    self->timestamp_mask = timestamp_mask_of(self->physical, self->queue_family);
  self->info.timestamps = self->timestamp_mask != 0;
  self->info.pass_times =
      self->info.timestamps && options.pass_times.value_or(!self->info.software());
  return self;
}

core::Result<void> Device::wait(VkSemaphore semaphore, std::uint64_t value,
                                const char* what) const {
  const VkSemaphoreWaitInfo waited{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                   .semaphoreCount = 1,
                                   .pSemaphores = &semaphore,
                                   .pValues = &value};
  const VkResult result = vk.vkWaitSemaphores(handle, &waited, timeout_ns_);
  if (result == VK_SUCCESS) return {};
  vk.hangs = vk.hangs || result == VK_TIMEOUT;
  return vulkan_failure(result, what);
}

core::Result<void> Device::submit(VkQueue to, VkCommandBuffer commands,
                                  std::span<const VkSemaphoreSubmitInfo> waits,
                                  std::span<const VkSemaphoreSubmitInfo> signals,
                                  const char* what) const {
  const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = commands};
  const VkSubmitInfo2 work{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                           .waitSemaphoreInfoCount = static_cast<std::uint32_t>(waits.size()),
                           .pWaitSemaphoreInfos = waits.data(),
                           .commandBufferInfoCount = 1,
                           .pCommandBufferInfos = &buffer,
                           .signalSemaphoreInfoCount = static_cast<std::uint32_t>(signals.size()),
                           .pSignalSemaphoreInfos = signals.data()};
  const std::scoped_lock lock(queues_);
  const VkResult result = vk.vkQueueSubmit2(to, 1, &work, VK_NULL_HANDLE);
  return result == VK_SUCCESS ? core::Result<void>{} : vulkan_failure(result, what);
}

VkResult Device::present(const VkPresentInfoKHR& picture) const {
  const std::scoped_lock lock(queues_);
  return vk.vkQueuePresentKHR(queue, &picture);
}

VkResult Device::wait_idle() const {
  const std::scoped_lock lock(queues_);
  return vk.vkDeviceWaitIdle(handle);
}

std::uint64_t Device::writable_bytes() const {
  const VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT |
                                       VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                       VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  std::uint64_t bytes = 0;
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((memory.memoryTypes[i].propertyFlags & wanted) != wanted) continue;
    bytes =
        std::max<std::uint64_t>(bytes, memory.memoryHeaps[memory.memoryTypes[i].heapIndex].size);
  }
  return bytes;
}

VkSampleCountFlagBits Device::samples_for(std::uint32_t wanted) const {
  std::uint32_t samples = wanted;
  while (samples > 1 && (sample_counts & samples) == 0)
    samples /= 2;
  return static_cast<VkSampleCountFlagBits>(samples);
}

Device::~Device() {
  if (handle != VK_NULL_HANDLE) vk.vkDestroyDevice(handle, nullptr);
}

}  // namespace psygen::render
