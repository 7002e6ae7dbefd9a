// The fraction of the ground that a world's models cover, and its colour.
#include <algorithm>

#include "engine/models/kit/exact_math.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/scatter.hpp"

namespace psygen::world {
namespace {

// The albedo of an instance from above, weighted like that of its upper half.
glm::vec3 albedo_of(const Outline& outline) {
  const auto reflected = [](const Corner& c) { return c.colour * c.colour * c.ambient; };
  glm::vec3 sum = reflected(outline.top) * 0.5F;
  for (const Corner& c : outline.ring)
    sum += reflected(c) * 0.125F;
  return sum;
}

}  // namespace

FarCover far_cover(const World& world, const FarScatters& scatters,
                   std::span<const double> placed) {
  const double block_m2 = world.block_size_m() * world.block_size_m();
  glm::vec3 light(0.0F);
  double covered = 0;
  for (std::size_t s = 0; s < world.scatter.size(); ++s) {
    const FarScatter& far = scatters.all()[s];
    for (const Representative& r : far.representatives()) {
      const double share = placed[s] * static_cast<double>(r.silhouette.plan_m2) /
                           (static_cast<double>(far.representatives().size()) * block_m2);
      light += albedo_of(r.outline) * static_cast<float>(share);
      covered += share;
    }
  }
  if (covered <= 0) return {};
  // Models at random positions overlap at random.
  return {light / static_cast<float>(covered),
          static_cast<float>(1 - models::exact_exp(-std::min(covered, 100.0)))};
}

}  // namespace psygen::world
