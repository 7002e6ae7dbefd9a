#include "engine/scene/tree_pictures.hpp"

#include <fmt/format.h>

#include <any>
#include <memory>
#include <utility>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/log.hpp"
#include "engine/world/far/tree_pictures.hpp"

namespace psygen::scene {
namespace {

// What is in view in so many layers around the camera comes before pictures, which are seen afar
// and take long.
constexpr std::uint32_t kLayers = 3;

std::uint32_t all_of(std::size_t pictures) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << pictures) - 1);
}

synthesis::MeshKey key_of_picture(const WorldFacts& facts, std::size_t number) {
  return {{},
          static_cast<std::uint32_t>(number),
          facts.picture_model,
          0,
          facts.picture_parameters[number].hash()};
}

}  // namespace

void forget_pictures(const WorldFacts& facts, synthesis::MeshSupply& meshes) {
  for (std::size_t i = 0; i < facts.picture_parameters.size(); ++i)
    meshes.forget(meshes.find(key_of_picture(facts, i)));
}

bool show_stand_ins(const WorldFacts& facts, const world::PictureSet* before, Output& output) {
  if (output.renderer == nullptr) return true;
  const std::size_t count = facts.pictures ? facts.pictures->count() : 0;
  if (output.pictures_shown == count) {
    for (std::size_t i = 0; i < count; ++i) {
      const bool same = before != nullptr &&
                        before->identity_of_picture(i) == facts.pictures->identity_of_picture(i);
      if (!same) output.pictures_lacking |= 1U << i;
    }
    return true;
  }
  std::vector<core::ModelPicture> stand_ins;
  for (std::size_t i = 0; i < count; ++i)
    stand_ins.push_back(facts.pictures->stand_in(i));
  output.pictures_lacking = 0;
  output.pictures_shown.reset();
  if (const auto set = output.renderer->set_model_pictures(stand_ins); !set) {
    core::log_warning(fmt::format("far trees have no pictures: {}", set.error().message));
    return false;
  }
  output.pictures_shown = count;
  output.pictures_lacking = all_of(count);
  return true;
}

core::Result<void> find_pictures(const Settings& settings, WorldFacts& facts,
                                 const world::PictureSet* before) {
  if (settings.paradigm == Paradigm::kDataAmplification || !settings.levels_of_detail) return {};
  auto pictures = std::make_shared<const world::PictureSet>(facts.world, facts.registry, before);
  if (pictures->count() == 0) return {};
  const std::size_t types = facts.registry.size();
  const auto baked = facts.registry.add(world::make_picture_type());
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

void want_pictures(const WorldFacts& facts, const Output& output, synthesis::MeshSupply& meshes) {
  for (std::size_t i = 0; output.pictures_lacking >> i != 0; ++i) {
    if ((output.pictures_lacking >> i & 1) == 0) continue;
    meshes.want({key_of_picture(facts, i), &facts.picture_parameters[i], owner_of(ecs::kNullEntity),
                 synthesis::Rank::by_layer(synthesis::RankGroup::kVisibleCoarse, kLayers, 0.0F)});
  }
}

bool take_picture(const synthesis::Completion& job, const WorldFacts& facts,
                  synthesis::MeshSupply& meshes, Output& output) {
  if (!facts.pictures || job.key.model != facts.picture_model) return false;
  const std::size_t number = job.key.index;
  output.pictures_lacking &= ~(1U << number);
  const synthesis::MeshRecord* record = meshes.ready(job.handle);
  if (!job.ok || record == nullptr) {
    core::log_warning(fmt::format("a picture of a tree could not be made: {}", job.error));
    return true;
  }
  const auto* picture = std::any_cast<std::shared_ptr<const core::ModelPicture>>(&record->note);
  PSYGEN_CHECK(picture != nullptr, "a picture is what is noted of its request");
  if (const auto set = output.renderer->set_model_picture(number, **picture); !set) {
    core::log_warning(fmt::format("a picture of a tree: {}", set.error().message));
    if (set.error().code == core::ErrorCode::kDeviceLost) output.error = set.error();
  }
  meshes.forget(job.handle);
  return true;
}

}  // namespace psygen::scene
