#include "engine/scene/facts/find_impostors.hpp"

#include <memory>
#include <utility>

#include "engine/world/far/tree_impostors.hpp"

namespace psygen::scene {

core::Result<void> find_pictures(const SceneSettings& settings, WorldFacts& facts,
                                 const world::ImpostorSet* before) {
  if (settings.paradigm == Paradigm::kDataAmplification || !settings.levels_of_detail) return {};
  auto pictures = std::make_shared<const world::ImpostorSet>(facts.world, facts.registry, before);
  if (pictures->count() == 0) return {};
  const std::size_t types = facts.registry.size();
  const auto baked = facts.registry.add(world::make_impostor_type());
  if (!baked) return tl::unexpected(baked.error());
  facts.picture_model = *baked;
  facts.quad_models.assign(types, 0);
  for (std::size_t i = 0; i < types; ++i) {
    const auto model = static_cast<models::ModelIndex>(i);
    if (!pictures->has(model)) continue;
    const auto quads = facts.registry.add(world::make_quad_type(pictures, facts.registry, model));
    if (!quads) return tl::unexpected(quads.error());
    facts.quad_models[i] = *quads;
  }
  for (std::size_t i = 0; i < pictures->count(); ++i)
    facts.picture_parameters.push_back(world::picture_parameters(i));
  facts.pictures = std::move(pictures);
  return {};
}

}  // namespace psygen::scene
