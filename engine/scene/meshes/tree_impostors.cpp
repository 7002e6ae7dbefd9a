#include "engine/scene/meshes/tree_impostors.hpp"

#include <fmt/format.h>

#include <any>
#include <memory>
#include <utility>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/log.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/world/far/tree_impostors.hpp"

namespace psygen::scene {
namespace {

// Meshes in view within this many layers of the camera go before impostors, which are visible only
// at a distance and take long.
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

void forget_pictures(const WorldFacts& facts, synthesis::MeshSupply& supply) {
  for (std::size_t i = 0; i < facts.picture_parameters.size(); ++i)
    supply.forget(supply.find(key_of_picture(facts, i)));
}

bool show_stand_ins(const WorldFacts& facts, const world::ImpostorSet* before, SceneMeshes& meshes,
                    Output& output) {
  if (output.renderer == nullptr) return true;
  const std::size_t count = facts.pictures ? facts.pictures->count() : 0;
  if (meshes.pictures_shown == count) {
    for (std::size_t i = 0; i < count; ++i) {
      const bool same = before != nullptr &&
                        before->identity_of_impostor(i) == facts.pictures->identity_of_impostor(i);
      if (!same) meshes.pictures_lacking |= 1U << i;
    }
    return true;
  }
  std::vector<core::ImpostorTexture> stand_ins;
  for (std::size_t i = 0; i < count; ++i)
    stand_ins.push_back(facts.pictures->stand_in(i));
  meshes.pictures_lacking = 0;
  meshes.pictures_shown.reset();
  if (const auto set = output.renderer->set_model_pictures(stand_ins); !set) {
    core::log_warning(fmt::format("far trees have no pictures: {}", set.error().message));
    return false;
  }
  meshes.pictures_shown = count;
  meshes.pictures_lacking = all_of(count);
  return true;
}

void want_pictures(const WorldFacts& facts, const SceneMeshes& meshes,
                   synthesis::MeshSupply& supply) {
  for (std::size_t i = 0; meshes.pictures_lacking >> i != 0; ++i) {
    if ((meshes.pictures_lacking >> i & 1) == 0) continue;
    supply.want({key_of_picture(facts, i), &facts.picture_parameters[i], owner_of(ecs::kNullEntity),
                 synthesis::Rank::by_layer(synthesis::RankGroup::kVisibleCoarse, kLayers, 0.0F)});
  }
}

bool take_picture(const synthesis::Completion& job, const WorldFacts& facts,
                  const UploadWork& work) {
  if (!facts.pictures || job.key.model != facts.picture_model) return false;
  const std::size_t number = job.key.index;
  work.meshes.pictures_lacking &= ~(1U << number);
  const synthesis::MeshRecord* record = work.supply.ready(job.handle);
  if (!job.ok || record == nullptr) {
    core::log_warning(fmt::format("a picture of a tree could not be made: {}", job.error));
    return true;
  }
  const auto* picture = std::any_cast<std::shared_ptr<const core::ImpostorTexture>>(&record->note);
  PSYGEN_CHECK(picture != nullptr, "a picture is what is noted of its request");
  if (const auto set = work.output.renderer->set_model_picture(number, **picture); !set) {
    core::log_warning(fmt::format("a picture of a tree: {}", set.error().message));
    if (set.error().code == core::ErrorCode::kDeviceLost) work.output.error = set.error();
  }
  work.supply.forget(job.handle);
  return true;
}

}  // namespace psygen::scene
