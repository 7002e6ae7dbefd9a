#include "engine/render/passes/gpu_culling.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace psygen::render {

using core::Result;

namespace {

constexpr std::uint64_t kFirstCandidates = 4096;
constexpr std::uint64_t kFirstNames = 1 << 20;
constexpr std::uint32_t kWordBytes = sizeof(std::uint32_t);
constexpr std::uint32_t kCommandBytes = sizeof(VkDrawIndexedIndirectCommand);
static_assert(kCommandBytes == 5 * kWordBytes);  // cull.comp

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kSource = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
constexpr VkBufferUsageFlags kTarget = VK_BUFFER_USAGE_TRANSFER_DST_BIT;

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkAccessFlags2 kShaderRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
constexpr VkAccessFlags2 kShaderWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

template <class T>
void copy_to(const Buffer& buffer, std::span<const T> values) {
  if (!values.empty()) std::memcpy(buffer.mapped, values.data(), values.size_bytes());
}

std::uint32_t count_bytes(std::size_t groups) {
  return static_cast<std::uint32_t>(2 * groups + 2) * kWordBytes;
}

// Copies from the start of a buffer, for the CPU to read after the frame.
void record_copy(const Device& device, VkCommandBuffer commands, const Buffer& from,
                 const Buffer& to, std::uint64_t target_offset, std::uint64_t bytes) {
  if (bytes == 0) return;
  const VkBufferCopy copy{0, target_offset, bytes};
  device.vk.vkCmdCopyBuffer(commands, from.buffer.get(), to.buffer.get(), 1, &copy);
}

void to_host(const Device& device, VkCommandBuffer commands) {
  memory_barrier(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

}  // namespace

Result<void> GpuCulling::create(const Device& device, bool occlusion, VkSampleCountFlagBits samples,
                                std::size_t slots) {
  occlusion_ = occlusion;
  std::array<VkDescriptorType, 10> types{};
  types.fill(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  types[PSYGEN_CULL_FRAME] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  types[PSYGEN_CULL_PYRAMID] = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  slots_.resize(slots);
  return pipeline_.create(device, Shader::kCullComp, types, kWordBytes, slots)
      .and_then([&] { return pyramid_.create(device, samples); })
      .and_then([&] { return grow_seen(device); });
}

Result<void> GpuCulling::resize(const Device& device, core::Extent size, const Image& depth) {
  return pyramid_.resize(device, size, occlusion_ ? &depth : nullptr);
}

// New bits say that nothing was visible, so everything is tested in the second phase.
Result<void> GpuCulling::grow_seen(const Device& device) {
  const std::uint64_t names = std::max<std::uint64_t>(kFirstNames, list_.name_count());
  const std::uint64_t bytes = std::bit_ceil(names) / 8;
  if (bytes <= seen_[0].bytes) return {};
  std::array<Buffer, 2> made;
  for (Buffer& buffer : made) {
    const Result<void> larger =
        make_buffer(device, bytes, kStorage | kTarget, MemoryUse::kDevice).map(into(buffer));
    if (!larger) return larger;
  }
  // This also waits for the frames in flight, which read the old bits.
  return run_once(device,
                  [&](VkCommandBuffer commands) {
                    for (const Buffer& buffer : made)
                      device.vk.vkCmdFillBuffer(commands, buffer.buffer.get(), 0, VK_WHOLE_SIZE, 0);
                  })
      .map([&] { seen_ = std::move(made); });
}

void GpuCulling::set_frame(const FrameInput& input, const shaders::FrameData& frame,
                           core::Extent size, const ListFacts& facts) {
  list_.build(facts, input.terrain, input.models, input.objects);
  const ViewVolume volume = view_volume(frame.clip_from_camera);
  std::copy(volume.planes.begin(), volume.planes.end(), frame_.planes);
  frame_.clip_from_camera = frame.clip_from_camera;
  frame_.near = {input.projection.near_m, 0.0F, 0.0F, 0.0F};
  frame_.counts = {static_cast<std::uint32_t>(list_.candidates().size()),
                   static_cast<std::uint32_t>(list_.groups().size()), list_.command_count(),
                   pyramid_.level_count()};
  frame_.picture = {size.width, size.height, 0, 0};
}

Result<void> GpuCulling::grow(const Device& device, std::size_t slot) {
  Slot& s = slots_[slot];
  const std::uint64_t candidates =
      std::max<std::uint64_t>(list_.candidates().size(), kFirstCandidates);
  const std::uint64_t groups = std::max<std::uint64_t>(list_.groups().size(), 64);
  const VkBufferUsageFlags indirect = kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | kSource;
  struct Wish {
    Buffer& buffer;
    std::uint64_t bytes;
    VkBufferUsageFlags usage;
    MemoryUse use;
  };
  const Wish wishes[] = {
      {s.frame, sizeof(frame_), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryUse::kWrite},
      {s.candidates, candidates * sizeof(shaders::CullCandidate), kStorage, MemoryUse::kWrite},
      {s.groups, groups * kWordBytes, kStorage, MemoryUse::kWrite},
      {s.commands, 2 * candidates * kCommandBytes, indirect, MemoryUse::kDevice},
      {s.draws, 2 * candidates * sizeof(shaders::DrawData), kStorage | kSource, MemoryUse::kDevice},
      {s.counts, count_bytes(groups), indirect | kTarget, MemoryUse::kDevice},
      {s.counts_back, count_bytes(groups), kTarget, MemoryUse::kRead}};
  for (const Wish& wish : wishes) {
    const Result<bool> grown = render::grow(device, wish.buffer, wish.bytes, wish.usage, wish.use);
    if (!grown) return tl::unexpected(grown.error());
  }
  return {};
}

Result<void> GpuCulling::write(const Device& device, std::size_t slot) {
  const Result<void> grown = grow(device, slot).and_then([&] { return grow_seen(device); });
  if (!grown) return grown;
  Slot& s = slots_[slot];
  std::memcpy(s.frame.mapped, &frame_, sizeof(frame_));
  copy_to(s.candidates, list_.candidates());
  copy_to(s.groups, list_.first_commands());
  s.group_count = frame_.counts.y;
  s.command_count = list_.command_count();
  return {};
}

void GpuCulling::write_sets(const Device& device, std::size_t slot) const {
  const Slot& s = slots_[slot];
  const std::pair<std::uint32_t, const Buffer*> buffers[] = {
      {PSYGEN_CULL_FRAME, &s.frame},
      {PSYGEN_CULL_CANDIDATES, &s.candidates},
      {PSYGEN_CULL_GROUPS, &s.groups},
      {PSYGEN_CULL_COMMANDS, &s.commands},
      {PSYGEN_CULL_DRAWS, &s.draws},
      {PSYGEN_CULL_COUNTS, &s.counts},
      {PSYGEN_CULL_SEEN_BEFORE, &seen_[1 - now_]},
      {PSYGEN_CULL_SEEN_NOW, &seen_[now_]}};
  for (const auto& [binding, buffer] : buffers)
    pipeline_.sets().write(device, slot, binding, buffer->buffer.get());
  pipeline_.sets().write(device, slot, PSYGEN_CULL_PYRAMID,
                         {pyramid_.sampler(), pyramid_.view(), VK_IMAGE_LAYOUT_GENERAL});
}

void GpuCulling::dispatch(const Device& device, VkCommandBuffer commands, std::size_t slot,
                          std::uint32_t phase) const {
  const std::uint32_t groups = (frame_.counts.x + PSYGEN_CULL_THREADS - 1) / PSYGEN_CULL_THREADS;
  pipeline_.bind(device, commands, slot);
  pipeline_.dispatch(device, commands, &phase, std::max(groups, 1u), 1);
  memory_barrier(device, commands, kCompute, kShaderWrite,
                 VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                     kCompute | VK_PIPELINE_STAGE_2_COPY_BIT,
                 VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | kShaderRead | kShaderWrite |
                     VK_ACCESS_2_TRANSFER_READ_BIT);
}

void GpuCulling::record_first(const Device& device, VkCommandBuffer commands, std::size_t slot) {
  now_ = 1 - now_;
  write_sets(device, slot);
  // Waits until the last frame has used the bits.
  memory_barrier(device, commands, kCompute, kShaderWrite,
                 VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | kCompute,
                 VK_ACCESS_2_TRANSFER_WRITE_BIT | kShaderRead);
  device.vk.vkCmdFillBuffer(commands, slots_[slot].counts.buffer.get(), 0, VK_WHOLE_SIZE, 0);
  device.vk.vkCmdFillBuffer(commands, seen_[now_].buffer.get(), 0, VK_WHOLE_SIZE, 0);
  memory_barrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                 VK_ACCESS_2_TRANSFER_WRITE_BIT, kCompute, kShaderRead | kShaderWrite);
  dispatch(device, commands, slot, occlusion_ ? PSYGEN_CULL_SEEN : PSYGEN_CULL_ALL);
}

void GpuCulling::record_second(const Device& device, VkCommandBuffer commands, std::size_t slot,
                               const Image& depth) const {
  pyramid_.record(device, commands, depth, {frame_.picture.x, frame_.picture.y});
  // Both phases write the same buffers.
  memory_barrier(device, commands,
                 VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
                 VK_ACCESS_2_NONE, kCompute, VK_ACCESS_2_NONE);
  dispatch(device, commands, slot, PSYGEN_CULL_NEWLY_SEEN);
}

void GpuCulling::record_counts(const Device& device, VkCommandBuffer commands,
                               std::size_t slot) const {
  const Slot& s = slots_[slot];
  record_copy(device, commands, s.counts, s.counts_back, 0, count_bytes(s.group_count));
  to_host(device, commands);
}

void GpuCulling::draw_group(const Device& device, VkCommandBuffer commands,
                            const GroupDraw& draw) const {
  const Slot& s = slots_[draw.slot];
  const DrawGroup& group = list_.groups()[draw.group];
  const std::uint64_t first = std::uint64_t{draw.phase} * s.command_count + group.first_command;
  const std::uint64_t count = std::uint64_t{draw.phase} * s.group_count + draw.group;
  device.vk.vkCmdDrawIndexedIndirectCount(commands, s.commands.buffer.get(), first * kCommandBytes,
                                          s.counts.buffer.get(), count * kWordBytes, group.capacity,
                                          kCommandBytes);
}

GpuCulling::Counts GpuCulling::read_counts(std::size_t slot) const {
  const Slot& s = slots_[slot];
  Counts counts;
  if (s.counts_back.mapped == nullptr) return counts;
  const auto* values = reinterpret_cast<const std::uint32_t*>(s.counts_back.mapped);
  for (std::uint32_t i = 0; i < 2 * s.group_count; ++i)
    counts.draws += values[i];
  counts.triangles = std::uint64_t{values[2 * s.group_count]} + values[2 * s.group_count + 1];
  return counts;
}

Result<std::vector<DrawnMesh>> GpuCulling::read_drawn(const Device& device,
                                                      std::size_t slot) const {
  const Slot& s = slots_[slot];
  const std::uint64_t all = 2 * std::uint64_t{s.command_count};
  const std::uint64_t data_at = all * kCommandBytes;
  const std::uint64_t counts_at = data_at + all * sizeof(shaders::DrawData);
  Result<Buffer> back =
      make_buffer(device, counts_at + count_bytes(s.group_count), kTarget, MemoryUse::kRead);
  if (!back) return tl::unexpected(back.error());
  const Result<void> copied = run_once(device, [&](VkCommandBuffer commands) {
    memory_barrier(device, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                   VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
                   VK_ACCESS_2_TRANSFER_READ_BIT);
    record_copy(device, commands, s.commands, *back, 0, data_at);
    record_copy(device, commands, s.draws, *back, data_at, counts_at - data_at);
    record_copy(device, commands, s.counts, *back, counts_at, count_bytes(s.group_count));
    to_host(device, commands);
  });
  if (!copied) return tl::unexpected(copied.error());
  const auto* commands = reinterpret_cast<const VkDrawIndexedIndirectCommand*>(back->mapped);
  const auto* data = reinterpret_cast<const shaders::DrawData*>(back->mapped + data_at);
  const auto* counts = reinterpret_cast<const std::uint32_t*>(back->mapped + counts_at);
  std::vector<DrawnMesh> drawn;
  for (std::uint32_t i = 0; i < 2 * s.group_count; ++i) {
    const DrawGroup& group = list_.groups()[i % s.group_count];
    const std::uint32_t first = i / s.group_count * s.command_count + group.first_command;
    for (std::uint32_t j = first; j < first + counts[i]; ++j) {
      drawn.push_back({group.layout, group.pool_block, group.shared, commands[j].firstIndex,
                       commands[j].indexCount, commands[j].vertexOffset,
                       glm::vec3(data[j].origin)});
    }
  }
  return drawn;
}

}  // namespace psygen::render
