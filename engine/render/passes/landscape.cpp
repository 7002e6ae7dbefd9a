#include "engine/render/passes/landscape.hpp"

#include "engine/render/passes/gpu_culling.hpp"
#include "engine/render/passes/mesh_draws.hpp"

namespace psygen::render {

namespace {

constexpr std::uint64_t kTrianglesOfPart = 12'000;

// Draws the meshes of the CPU's list. On software devices pixels are filled while the next
// kTrianglesOfPart triangles are set up.
void record_listed(const Recording& to) {
  begin_rendering(to.device, to.commands(), to.targets);
  std::uint64_t triangles = 0;
  draw_list(to, use_in(to.view), [&](const DrawRun& run) {
    for (std::uint32_t i = run.first; to.targets.in_parts && i < run.first + run.count; ++i)
      triangles += to.list.draws()[i].index_count / 3;
    if (triangles < kTrianglesOfPart) return;
    triangles = 0;
    split_rendering(to.device, to.commands(), to.targets);
  });
}

// Draws the meshes that the device chose in a phase of culling.
void draw_chosen(const Recording& to, std::uint32_t phase) {
  const GpuCulling& culling = *to.culling;
  MeshBinder binder(to);
  for (std::size_t i = 0; i < culling.groups().size(); ++i) {
    const DrawGroup& group = culling.groups()[i];
    binder.bind(to.meshes.find(group.layout, use_in(to.view), group.variant(to.lamps)), group);
    culling.draw_group(to.device, to.commands(), {to.slot.number(), i, phase});
  }
}

void record_chosen(const Recording& to) {
  GpuCulling& culling = *to.culling;
  const std::size_t slot = to.slot.number();
  culling.record_first(to.device, to.commands(), slot);
  begin_rendering(to.device, to.commands(), to.targets,
                  culling.two_passes() ? RenderingPart::kFirst : RenderingPart::kWhole);
  draw_chosen(to, 0);
  if (!culling.two_passes()) return;
  to.device.vk.vkCmdEndRendering(to.commands());
  culling.record_second(to.device, to.commands(), slot, to.targets.depth);
  begin_rendering(to.device, to.commands(), to.targets, RenderingPart::kSecond);
  draw_chosen(to, 1);
}

}  // namespace

void Landscape::record(const Recording& to) const {
  if (to.culling != nullptr) {
    record_chosen(to);
  } else {
    record_listed(to);
  }
}

void Landscape::warm_up(const Recording& to, const WarmUpStep& step) const {
  const auto draw = [&](core::VertexLayout layout, MeshVariant variant) {
    variant.lamps = step.lamps;
    for (const bool pushed : {false, true}) {
      variant.pushed = pushed;
      to.bind_pipeline(to.meshes.find(layout, MeshUse::kLandscape, variant));
      to.device.vk.vkCmdDrawIndexed(to.commands(), 3, 1, 0, 0, 0);
    }
  };
  if (step.feature == Feature::kObjects) {
    for (const Coverage coverage : {Coverage::kWhole, Coverage::kPart})
      draw(core::VertexLayout::kObject, {.coverage = coverage, .textured = step.number == 1});
  } else if (step.number == 0) {
    draw(core::VertexLayout::kTerrain, {.coverage = Coverage::kWhole});
    draw(core::VertexLayout::kTerrain, {.coverage = Coverage::kPart});
  } else if (step.number == 1) {
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kWhole});
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kNear});
  } else {
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kPart});
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kPictured});
  }
}

}  // namespace psygen::render
