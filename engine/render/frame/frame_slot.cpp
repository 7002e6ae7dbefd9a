#include "engine/render/frame/frame_slot.hpp"

#include <bit>
#include <cstring>

#include "engine/render/frame/swapchain.hpp"

namespace psygen::render {

using core::Result;

namespace {

constexpr std::uint64_t kFirstDraws = 4096;

Result<Buffer> storage_buffer(const Device& device, std::uint64_t bytes) {
  return make_buffer(device, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::kWrite);
}

}  // namespace

Result<void> FrameSlot::create(const Device& device, std::size_t number) {
  number_ = number;
  VkCommandPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool_info.queueFamilyIndex = device.queue_family;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkResult result = device.vk.vkCreateCommandPool(device.handle, &pool_info, nullptr, &pool);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a command pool");
  pool_ = UniqueCommandPool(device.vk, device.handle, pool);
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = pool;
  info.commandBufferCount = 1;
  result = device.vk.vkAllocateCommandBuffers(device.handle, &info, &commands_);
  if (result != VK_SUCCESS) return vulkan_failure(result, "allocating a command buffer");

  Result<UniqueSemaphore> acquired = make_semaphore(device);
  if (!acquired) return tl::unexpected(acquired.error());
  acquired_ = std::move(*acquired);
  if (Result<void> timed = timer_.create(device); !timed) return timed;
  Result<Buffer> frame = make_buffer(device, sizeof(shaders::FrameData),
                                     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryUse::kWrite);
  if (!frame) return tl::unexpected(frame.error());
  Result<Buffer> draws = storage_buffer(device, kFirstDraws * sizeof(shaders::DrawData));
  if (!draws) return tl::unexpected(draws.error());
  constexpr std::size_t kShadeBytes = std::size_t{PSYGEN_SHADE_SIDE} * PSYGEN_SHADE_SIDE * 2;
  Result<Buffer> shade = storage_buffer(device, kShadeBytes);
  if (!shade) return tl::unexpected(shade.error());
  shade_ = std::move(*shade);
  std::memset(shade_.mapped, 0, kShadeBytes);
  frame_ = std::move(*frame);
  draws_ = std::move(*draws);
  return {};
}

void FrameSlot::use(const Device& device, const FrameSets& sets) const {
  sets.write(device, number_, {frame_, draws_, shade_});
}

Result<void> FrameSlot::write(const Device& device, const FrameSets& sets,
                              const shaders::FrameData& frame,
                              std::span<const shaders::DrawData> draws) {
  if (draws.size_bytes() > draws_.bytes) {
    Result<Buffer> larger = storage_buffer(device, std::bit_ceil(draws.size_bytes()));
    if (!larger) return tl::unexpected(larger.error());
    draws_ = std::move(*larger);
    use(device, sets);
  }
  std::memcpy(frame_.mapped, &frame, sizeof(frame));
  if (!draws.empty()) std::memcpy(draws_.mapped, draws.data(), draws.size_bytes());
  return {};
}

void FrameSlot::write_shade(std::span<const std::uint32_t> words) {
  std::memcpy(shade_.mapped, words.data(), words.size_bytes());
}

Result<void> FrameSlot::begin(const Device& device) {
  VkResult result = device.vk.vkResetCommandPool(device.handle, pool_.get(), 0);
  if (result != VK_SUCCESS) return vulkan_failure(result, "resetting a command pool");
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  result = device.vk.vkBeginCommandBuffer(commands_, &info);
  if (result != VK_SUCCESS) return vulkan_failure(result, "beginning a command buffer");
  timer_.begin(device, commands_);
  return {};
}

Result<void> FrameSlot::end(const Device& device) {
  const VkResult result = device.vk.vkEndCommandBuffer(commands_);
  if (result != VK_SUCCESS) return vulkan_failure(result, "ending a command buffer");
  return {};
}

}  // namespace psygen::render
