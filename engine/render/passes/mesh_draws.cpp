#include "engine/render/passes/mesh_draws.hpp"

#include <algorithm>
#include <cstddef>

namespace psygen::render {

static_assert(sizeof(IndexedDraw) == sizeof(VkMultiDrawIndexedInfoEXT));
static_assert(offsetof(IndexedDraw, index_count) ==
              offsetof(VkMultiDrawIndexedInfoEXT, indexCount));
static_assert(offsetof(IndexedDraw, vertex_offset) ==
              offsetof(VkMultiDrawIndexedInfoEXT, vertexOffset));

void draw_run(const Recording& to, const DrawRun& run) {
  const VkCommandBuffer commands = to.commands();
  const IndexedDraw* const draws = to.list.draws().data();
  for (std::uint32_t i = run.first; run.pushed && i < run.first + run.count; ++i) {
    to.device.vk.vkCmdPushConstants(commands, to.sets.layout(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                                    sizeof(shaders::DrawData), &to.list.data()[i]);
    to.device.vk.vkCmdDrawIndexed(commands, draws[i].index_count, 1, draws[i].first_index,
                                  draws[i].vertex_offset, 0);
  }
  const std::uint32_t most = to.device.max_multi_draw;
  for (std::uint32_t done = 0; !run.pushed && done < run.count; done += most) {
    const std::uint32_t first = run.first + done;
    to.device.vk.vkCmdDrawMultiIndexedEXT(
        commands, std::min(run.count - done, most),
        reinterpret_cast<const VkMultiDrawIndexedInfoEXT*>(draws + first), 1, first,
        sizeof(IndexedDraw), nullptr);
  }
}

}  // namespace psygen::render
