// The water under the pointer. Another thread casts the ray, because the ground of a river network
// takes milliseconds a block. It drops questions while one is in work, so ask again. Main thread.
#pragma once

#include <future>
#include <memory>

#include "editor/view/surface_shape.hpp"
#include "engine/core/camera.hpp"
#include "engine/world/water.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

// One per view; it keeps a copy of the world's ground.
class WaterProbe {
 public:
  WaterProbe() = default;
  WaterProbe(const WaterProbe&) = delete;
  WaterProbe& operator=(const WaterProbe&) = delete;
  ~WaterProbe();

  // Asks for the water that the ray from the camera hits before any ground, within 4 km, if it is
  // the same ray as at the last call. Does nothing while a question is in work, or if it is the
  // last one again. Takes microseconds.
  void ask(const scene::Scene& scene, const core::CameraPose& pose, const glm::dvec3& direction);
  // The newest answer; dry: the ray hits no water. Takes microseconds.
  const world::WaterPoint& answer();
  // To be called after a change of the world.
  void note_world() { ground_.note_world(); }
  // True while another thread works.
  bool is_busy() const { return next_.valid(); }

 private:
  KeptGround ground_{std::size_t{16} << 20};  // the other thread has a share of it
  std::future<world::WaterPoint> next_;
  core::WorldPosition seen_eye_;  // the ray of the last call
  glm::dvec3 seen_direction_{0.0};
  std::shared_ptr<const BareGround> asked_ground_;  // of the last question about this ray
  world::WaterPoint answer_;
};

}  // namespace psygen::editor
