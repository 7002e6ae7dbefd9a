// What is under a pixel of the view: an exact ray against ground and models, whatever is drawn.
// Pure but for the cache of the queries. Main thread.
#pragma once

#include <QPointF>
#include <memory>
#include <optional>

#include "editor/view/surface_shape.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/query/world.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

// What a click selected.
struct Selection {
  query::HitKind kind = query::HitKind::kNothing;  // kGround or kModel
  core::BlockCoord block;
  std::uint32_t index = 0;  // of the model within the block
  models::ModelIndex model = 0;
  models::Parameters parameters;  // of the model, or of the ground of its block
  core::WorldPosition at;         // of the model's foot, or of the ground that was hit
  core::Bounds box;               // of a model, from its foot
  double distance_m = 0;
};

// The direction of a pixel (device pixels from the upper left corner), unit length.
glm::dvec3 direction_of(QPointF pixel, core::Extent size, const core::CameraPose& pose,
                        const core::Projection& projection);

// The first thing from the camera in a direction, within 20 km; nothing: the sky.
std::optional<Selection> pick(const scene::Scene& scene, const core::CameraPose& pose,
                              const glm::dvec3& direction);

// Rays against the ground of the worlds that a view shows one after the other. What is known of the
// ground stays while it is the same. Costs some milliseconds for the first ray on other ground.
class GroundRays {
 public:
  // The ground from the camera in a direction, as x and z in metres of the world; nothing: the sky,
  // or more than 20 km away. Models are in nobody's way.
  std::optional<glm::dvec2> at(const scene::Scene& scene, const core::CameraPose& pose,
                               const glm::dvec3& direction);
  // The state has another world.
  void note_world() { world_is_new_ = true; }
  // The state ends.
  void clear() { ground_.reset(); }

 private:
  // Without models, so that only the ground matters.
  struct Ground {
    explicit Ground(const scene::Scene& scene);
    SurfaceShape shape;
    world::World world;
    query::World queries;
  };
  std::unique_ptr<Ground> ground_;
  bool world_is_new_ = false;
};

// The same model, or the same place of the ground, in the present world; nothing if it is gone.
std::optional<Selection> found_again(const Selection& selection, const scene::Scene& scene);

}  // namespace psygen::editor
