#include "engine/render/renderer.hpp"

#include "engine/render/renderer_impl.hpp"

namespace psygen::render {

using core::Result;

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
  auto renderer = std::make_unique<RendererImpl>(options);
  Progress progress;
  if (options.progress)
    progress = [&](double fraction) { return options.progress(*renderer, fraction); };
  return renderer->create_all(progress).map(
      [&]() -> std::unique_ptr<Renderer> { return std::move(renderer); });
}

Result<std::vector<DeviceInfo>> list_devices() {
  Result<std::unique_ptr<Instance>> instance = Instance::create("psygen", false, nullptr);
  if (!instance) return tl::unexpected(instance.error());
  const std::vector<DeviceCandidate> candidates = find_devices(**instance, VK_NULL_HANDLE);
  if (candidates.empty()) return tl::unexpected(choose_device(candidates, "").error());
  std::vector<DeviceInfo> devices;
  for (const DeviceCandidate& candidate : candidates)
    devices.push_back(candidate.info);
  return devices;
}

}  // namespace psygen::render
