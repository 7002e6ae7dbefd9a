#include "engine/render/passes/lines.hpp"

#include <algorithm>

namespace psygen::render {

using core::Result;

namespace {

constexpr std::size_t kFirstLines = 512;

}  // namespace

Result<void> Lines::create(const PassSetup& setup) {
  if (pipeline_.exists()) return {};
  const std::array bindings{
      SetBinding{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_VERTEX_BIT}};
  return set_.create(setup, bindings, setup.sets.shared())
      .and_then([&] {
        return ends_.create(setup.device, setup.sets.slots(),
                            2 * kFirstLines * sizeof(shaders::OverlayVertex),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
      })
      .and_then([&] {
        set_.write(setup.device, PSYGEN_LINE_ENDS, ends_);
        const PipelineShape shape{.vert = Shader::kLineVert,
                                  .frag = Shader::kSurfaceFrag,
                                  .topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST};
        return setup.pipelines.make(set_.layout(), shape, pipeline_);
      });
}

void Lines::list(const FrameInput& input, const FrameFacts&) {
  listed_.clear();
  for (const Line& line : input.lines.first(std::min(input.lines.size(), kMaxLines))) {
    listed_.push_back({{line.from, 1.0F}, {line.colour, 1.0F}, {}});
    listed_.push_back({{line.to, 1.0F}, {line.colour, 1.0F}, {}});
  }
}

Result<void> Lines::write(const Device& device, std::size_t slot) {
  return set_.fill(device, slot, PSYGEN_LINE_ENDS, ends_, std::as_bytes(std::span(listed_)));
}

void Lines::record(const Recording& to) const {
  if (listed_.empty()) return;
  to.bind_pipeline(pipeline_.get());
  set_.bind(to.device, to.commands(), to.slot.number());
  to.draw(static_cast<std::uint32_t>(listed_.size()));
}

}  // namespace psygen::render
