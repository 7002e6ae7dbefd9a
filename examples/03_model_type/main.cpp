// Adds a model type: a fence with the number of panels given in the world file. Saves an image.
//   example_model_type picture.png
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/model_type.hpp"
#include "engine/program/program.hpp"

using namespace psygen;

namespace {

enum HurdleParameter : std::size_t { kSeed, kPanels, kHeightM };

constexpr models::ParameterSpec kSchema[] = {
    {"seed", models::ParameterType::kInteger, "", 1, -0x1p63, 0x1p63, 0, 1000, "random seed",
     models::ParameterSource::kPlaced},
    {"panels", models::ParameterType::kInteger, "1", 3, 1, 32, 1, 8, "number of panels"},
    {"height_m", models::ParameterType::kReal, "m", 1.2, 0.2, 5, 0.6, 2, "height of the panels"},
};

// Panels of two triangles per side, in a row along x.
class HurdleType final : public models::ModelType {
 public:
  std::string_view name() const override { return "hurdle"; }
  std::string_view doc() const override { return "a row of wooden panels"; }
  std::span<const models::ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return 1; }
  double level_error_m(const models::Parameters&, int) const override { return 0; }

  core::Bounds bounds(const models::Parameters& p) const override {
    const float half = 0.5F * kPanelM * static_cast<float>(panels(p));
    return {{-half, -0.5F, -kTilt}, {half, static_cast<float>(p.real(kHeightM)), kTilt}};
  }
  models::MeshSize mesh_size(const models::Parameters& p, int) const override {
    return {panels(p) * 8, panels(p) * 12, 0, core::VertexLayout::kModel};
  }
  double complexity(const models::Parameters& p, int) const override { return panels(p); }
  double log2_cost(const models::Parameters& p) const override {
    return std::log2(4.0 * std::max(1.0, static_cast<double>(p.integer(kPanels))));
  }

  core::Bounds synthesise(const models::Parameters& p, int,
                          const models::MeshView& out) const override {
    const core::Bounds box = bounds(p);
    const models::BoxPacker packer(box);
    auto* vertices = reinterpret_cast<core::ModelVertex*>(out.vertices.data());
    std::uint16_t count = 0;
    std::size_t indices = 0;
    for (std::uint32_t i = 0; i < panels(p); ++i) {
      const float x = box.min.x + kPanelM * static_cast<float>(i);
      const float z = i % 2 == 0 ? kTilt : -kTilt;  // a zigzag, so that the fence is stable
      for (const float side : {1.0F, -1.0F}) {
        for (const int corner : {0, 1, 2, 0, 2, 3})
          out.indices[indices++] =
              static_cast<std::uint16_t>(count + (side > 0 ? corner : (4 - corner) % 4));
        for (const glm::vec2 at : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
          core::ModelVertex vertex{};
          const float y = at.y > 0 ? box.max.y : box.min.y;
          packer.pack({x + at.x * kPanelM, y, at.x > 0 ? -z : z}, vertex.position);
          const glm::vec2 normal = models::encode_octahedral({0, 0, side});
          vertex.normal[0] = models::pack_snorm16(normal.x);
          vertex.normal[1] = models::pack_snorm16(normal.y);
          vertex.ambient = at.y > 0 ? 255 : 120;  // darker at the ground
          vertex.colour[0] = models::pack_albedo(0.26F);
          vertex.colour[1] = models::pack_albedo(0.19F);
          vertex.colour[2] = models::pack_albedo(0.11F);
          vertices[count++] = vertex;
        }
      }
    }
    return box;
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}

 private:
  static constexpr float kPanelM = 1.6F, kTilt = 0.12F;
  static std::uint32_t panels(const models::Parameters& p) {
    return static_cast<std::uint32_t>(p.integer(kPanels));
  }
};

core::Result<void> take_picture(const char* file) {
  app::SessionOptions options;
  const auto world = core::data_file("farm.toml");
  if (!world) return tl::unexpected(world.error());
  options.world_file = *world;
  options.headless = true;
  app::Plugin plugin;
  plugin.name = "farm";
  plugin.register_models = [](models::Registry& registry) -> core::Result<void> {
    const auto added = registry.add(std::make_unique<HurdleType>());
    if (!added) return tl::unexpected(added.error());
    return {};
  };
  options.plugins.push_back(plugin);
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  core::CameraPose pose = (*session)->home();
  pose.position.local.y -= 20;  // 5 m above the ground
  return (*session)
      ->prepare(pose)
      .and_then([&] { return (*session)->tick(pose, 1.0 / 60); })
      .and_then([&] { return (*session)->save_picture(file); });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: example_model_type picture.png\n");
    return 2;
  }
  return program::run("example_model_type", [&] { return take_picture(argv[1]); });
}
