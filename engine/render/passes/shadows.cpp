#include "engine/render/passes/shadows.hpp"

#include "engine/render/passes/mesh_draws.hpp"

namespace psygen::render {

void Shadows::record(const Recording& to) const {
  if (!active_) return;
  to.sets.shadows().record(to.device, to.commands(), [&](std::uint32_t cascade) {
    to.device.vk.vkCmdPushConstants(to.commands(), to.sets.layout(), VK_SHADER_STAGE_VERTEX_BIT,
                                    sizeof(shaders::DrawData), sizeof(cascade), &cascade);
    draw_list(to, MeshUse::kShadow, [](const DrawRun&) {});
  });
  to.slot.timer().mark(to.device, to.commands(), GpuTimer::Mark::kShadows);
}

}  // namespace psygen::render
