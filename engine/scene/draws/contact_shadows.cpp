#include "engine/scene/draws/contact_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/scene/facts/world_facts.hpp"

namespace psygen::scene {
namespace {

// Spots are drawn up to render::kNearGroundM; the largest reach into that range from this distance.
constexpr float kReachM = render::kNearGroundM + 12.0F;
constexpr float kMinRadiusM = 0.9F;  // the smallest that cells of one metre can show
constexpr float kTreeM = 2.0F;       // taller models have a stem
constexpr float kMinSunrise =
    0.25F;  // height of the sun below which shadows fade instead of growing

}  // namespace

void add_spots(const core::Bounds& tight, bool grass, glm::vec3 foot, glm::vec3 sun, bool shadow,
               std::vector<render::GroundSpot>& spots) {
  const glm::vec2 size(tight.max.x - tight.min.x, tight.max.z - tight.min.z);
  const float height = tight.max.y, radius = 0.25F * (size.x + size.y);
  if (!(height > 0) || !(radius > 0)) return;
  const glm::vec2 middle(foot.x + 0.5F * (tight.min.x + tight.max.x),
                         foot.z + 0.5F * (tight.min.z + tight.max.z));
  const auto add = [&](glm::vec2 at, float reach_m, float of_sun, float of_sky) {
    spots.push_back({at, std::max(reach_m, kMinRadiusM), of_sun, of_sky});
  };
  if (grass) return add(middle, radius, 0, 0.12F);
  const bool tree = height > kTreeM && radius < height;
  if (tree) {
    add(middle, radius, 0, 0.3F);
    add({foot.x, foot.z}, 1.1F + 0.05F * height, shadow ? 0.45F : 0.2F, 0.6F);
  } else {
    add(middle, 1.3F * radius + 0.25F, shadow ? 0.5F : 0, 0.75F);
  }
  if (!shadow || sun.y <= 0) return;
  const float aside = height * (tree ? 0.6F : 0.35F) / std::max(sun.y, kMinSunrise);
  const float strength = 0.65F * std::min(sun.y / kMinSunrise, 1.0F);
  add(middle - glm::vec2(sun.x, sun.z) * aside, tree ? 0.95F * radius : 1.1F * radius, strength,
      0.05F);
}

void add_spots_near(const RenderContext& context, std::span<const ecs::Entity> entities_of_cut,
                    const RenderQuery& entities, glm::vec3 sun,
                    std::vector<render::GroundSpot>& spots) {
  const WorldFacts& facts = context.facts;
  const View& view = context.view;
  const int grass = facts.registry.find("grass");
  for (std::size_t i = 0; i < view.cut.nodes.size(); ++i) {
    const visibility::CutNode& node = view.cut.nodes[i];
    const ecs::Entity entity = entities_of_cut[i];
    if (node.node.level > 0 || node.distance_m > kReachM || !entities.alive(entity)) continue;
    const glm::vec3 corner = corner_of(node.node, context.camera, facts);
    entities.each_of<const MeshPlacement, const MeshDemand, const MeshSource, const Mesh>(
        entities.children(*entities.get<ecs::Children>(entity)),
        [&](auto rows, auto placed, auto demands, auto sources, auto meshes) {
          for (std::size_t k = 0; k < rows.size(); ++k) {
            const glm::vec3 foot = corner + placed[k].position;
            if (demands[k].drawn_level == kNoLevel || glm::dot(foot, foot) > kReachM * kReachM ||
                placed[k].surface == core::SurfaceKind::kWater)
              continue;
            add_spots(meshes[k].tight, int{sources[k].model} == grass, foot, sun, !facts.shadows,
                      spots);
          }
        });
  }
}

}  // namespace psygen::scene
