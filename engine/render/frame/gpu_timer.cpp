#include "engine/render/frame/gpu_timer.hpp"

#include <array>
#include <cstring>

namespace psygen::render {

using core::Result;

namespace {
// Queries: begin, end, then the end of each pass, of which the shadows are the first.
constexpr std::uint32_t kFirstPass = 2, kMarks = kFirstPass + kPassNames.size();
using Ticks = std::array<std::uint64_t, kMarks>;
}  // namespace

Result<void> GpuTimer::create(const Device& device) {
  if (device.timestamp_mask == 0) return {};
  const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                   .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                   .queryCount = kMarks};
  return device
      .make<UniqueQueryPool>(&VolkDeviceTable::vkCreateQueryPool, info, "creating a query pool")
      .map(into(queries_))
      .and_then([&] {
        return make_buffer(device, sizeof(Ticks), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           MemoryUse::kRead);
      })
      .map(into(ticks_));
}

void GpuTimer::begin(const Device& device, VkCommandBuffer commands) {
  if (queries_.get() == VK_NULL_HANDLE) return;
  if (recorded_.timed) {
    device.vk.vkCmdCopyQueryPoolResults(
        commands, queries_.get(), 0,
        recorded_.passes    ? kMarks
        : recorded_.shadows ? kFirstPass + 1
                            : kFirstPass,
        ticks_.buffer.get(), 0, sizeof(Ticks::value_type),
        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);  // available, so it does not wait
    // Software devices write the host's memory, and would finish all drawing at a barrier.
    if (!device.info.software()) {
      memory_barrier(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                     VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    }
  }
  copied_ = recorded_;
  recorded_ = {};
  device.vk.vkCmdResetQueryPool(commands, queries_.get(), 0, kMarks);
}

void GpuTimer::mark(const Device& device, VkCommandBuffer commands, Mark mark) {
  if (queries_.get() == VK_NULL_HANDLE) return;
  write(device, commands, static_cast<std::uint32_t>(mark));
  recorded_.timed = recorded_.timed || mark == Mark::kEnd;
  recorded_.shadows = recorded_.shadows || mark == Mark::kShadows;
}

void GpuTimer::mark_pass(const Device& device, VkCommandBuffer commands, std::uint32_t pass) {
  if (queries_.get() == VK_NULL_HANDLE || !device.info.pass_times) return;
  const bool marked = pass == 0 && recorded_.shadows;  // by the pass itself
  if (!marked) write(device, commands, kFirstPass + pass);
  recorded_.passes = true;
}

void GpuTimer::write(const Device& device, VkCommandBuffer commands, std::uint32_t query) const {
  device.vk.vkCmdWriteTimestamp2(commands,
                                 query == static_cast<std::uint32_t>(Mark::kBegin)
                                     ? VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT
                                     : VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT,
                                 queries_.get(), query);
}

void GpuTimer::submitted(std::uint64_t frame, double now_s) {
  recorded_.number = frame;
  recorded_.submitted_s = now_s;
}

std::optional<GpuTime> GpuTimer::read(const Device& device) const {
  if (!copied_.timed) return std::nullopt;
  Ticks ticks{};
  std::memcpy(ticks.data(), ticks_.mapped, sizeof(ticks));
  const auto ms = [&](std::size_t from, std::size_t to) {  // ticks may wrap around once
    const std::uint64_t passed = ticks[to] - ticks[from];
    return static_cast<double>(passed & device.timestamp_mask) * device.timestamp_period_ns * 1e-6;
  };
  constexpr auto kBegin = static_cast<std::size_t>(Mark::kBegin),
                 kEnd = static_cast<std::size_t>(Mark::kEnd);
  GpuTime time{.frame = copied_.number, .submitted_s = copied_.submitted_s, .ms = ms(kBegin, kEnd)};
  if (copied_.shadows) time.shadows_ms = ms(kBegin, kFirstPass);
  for (std::size_t i = 0; copied_.passes && i < time.pass_ms.size(); ++i)
    time.pass_ms[i] = ms(i == 0 ? kBegin : kFirstPass + i - 1, kFirstPass + i);
  return time;
}

}  // namespace psygen::render
