// Picks the model or the ground under a pixel with an exact ray, independent of the drawn levels of
// detail. Pure except for the cache of the queries. Main thread.
#pragma once

#include <QPointF>
#include <optional>

#include "editor/view/surface_shape.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/query/world.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

// A selected model or point of the ground.
struct Selection {
  query::HitKind kind = query::HitKind::kNothing;  // kGround or kModel
  core::BlockCoord block;
  std::uint32_t index = 0;  // of the model within the block
  models::ModelIndex model = 0;
  models::Parameters parameters;  // of the model, or of the block's ground
  core::WorldPosition at;         // base point of the model, or the point on the ground
  core::Bounds box;               // of a model, from its base point
  double distance_m = 0;
};

// The direction of a pixel (device pixels from the upper left corner), unit length.
glm::dvec3 direction_of(QPointF pixel, core::Extent size, const core::CameraPose& pose,
                        const core::Projection& projection);

// The first model or ground from the camera in a direction, within 20 km; nullopt: the sky.
std::optional<Selection> pick(const scene::Scene& scene, const core::CameraPose& pose,
                              const glm::dvec3& direction);

// Rays against the ground of the view's world. Cached heights stay while the ground is unchanged.
// The first ray on other ground takes some milliseconds.
class GroundRays {
 public:
  // The point of the ground from the camera in a direction, as x and z in metres of the world;
  // nullopt: the sky, or farther than 20 km. The ray ignores models.
  std::optional<glm::dvec2> at(const scene::Scene& scene, const core::CameraPose& pose,
                               const glm::dvec3& direction);
  // To be called after a change of the world.
  void note_world() { ground_.note_world(); }

 private:
  KeptGround ground_{std::size_t{32} << 20};
};

// The same model, or the same point of the ground, in the present world; nullopt if it is gone.
std::optional<Selection> relocate_selection(const Selection& selection, const scene::Scene& scene);

}  // namespace psygen::editor
