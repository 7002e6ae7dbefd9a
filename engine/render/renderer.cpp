#include "engine/render/renderer.hpp"

#include "engine/render/renderer_impl.hpp"

namespace psygen::render {

using core::Result;

Renderer::Renderer(std::unique_ptr<RendererImpl> impl) : impl_(std::move(impl)) {}

// If the driver hangs, so would destroying its device.
void Renderer::leave(std::unique_ptr<RendererImpl> impl) {
  if (impl && impl->hangs()) (void)impl.release();
}

Renderer::~Renderer() {
  leave(std::move(impl_));
}

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
  std::unique_ptr<Renderer> renderer(new Renderer(std::make_unique<RendererImpl>(options)));
  Progress progress;
  if (options.progress)
    progress = [&](double fraction) { return options.progress(*renderer, fraction); };
  if (Result<void> made = renderer->impl_->create(progress); !made)
    return tl::unexpected(made.error());
  return renderer;
}

core::GeometryMemory& Renderer::geometry() {
  return impl_->geometry();
}

Result<std::uint32_t> Renderer::upload_shared_indices(std::span<const std::uint16_t> indices) {
  return impl_->add_shared_indices(indices);
}

Result<TextureId> Renderer::add_texture(const TexturePixels& pixels) {
  return impl_->add_texture(pixels);
}
Result<void> Renderer::set_model_pictures(std::span<const core::ImpostorTexture> pictures) {
  return impl_->set_pictures(pictures);
}

Result<void> Renderer::set_model_picture(std::size_t number, const core::ImpostorTexture& picture) {
  return impl_->set_picture(number, picture);
}

Result<MaterialId> Renderer::add_material(const Material& material) {
  return impl_->add_material(material);
}
Result<void> Renderer::prepare(Feature feature) {
  return impl_->prepare(feature);
}
std::uint64_t Renderer::texture_bytes() const {
  return impl_->texture_bytes();
}

Result<FrameResult> Renderer::render(const FrameInput& input) {
  return impl_->render(input);
}
Result<void> Renderer::show(std::span<const TextPanel> panels, float text_scale,
                            const HudDrawing& hud) {
  return impl_->show(panels, text_scale, hud);
}
ImFontAtlas& Renderer::font_atlas() {
  return impl_->font_atlas();
}
Result<void> Renderer::set_preset(Preset preset, const Progress& progress) {
  return impl_->set_preset(preset, progress);
}
Preset Renderer::preset() const {
  return impl_->preset();
}
Result<Picture> Renderer::capture() {
  return impl_->capture();
}
Result<void> Renderer::resize(core::Extent size) {
  return impl_->resize(size);
}
core::Extent Renderer::size() const {
  return impl_->size();
}
const DeviceInfo& Renderer::device() const {
  return impl_->info();
}
std::vector<std::string> Renderer::validation_messages() const {
  return impl_->messages();
}
Result<double> Renderer::replay_floor_ms(int repeats) {
  return impl_->replay_floor_ms(repeats);
}
Result<std::vector<DrawnMesh>> Renderer::drawn_meshes() {
  return impl_->drawn_meshes();
}
RenderPath Renderer::path() const {
  return impl_->path();
}
bool Renderer::casts_shadows() const {
  return impl_->casts_shadows();
}
bool Renderer::has_near_models() const {
  return impl_->has_near_models();
}
void Renderer::wait_idle() {
  impl_->wait_idle();
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
