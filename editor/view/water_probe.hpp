// The water under the pointer: body, surface, depth, speed and discharge. Another thread casts the
// ray, because the ground of a river network takes milliseconds a block. It drops questions while
// one is in work, so ask again. Main thread, except for water_facts().
#pragma once

#include <future>
#include <memory>
#include <optional>

#include "editor/view/surface_shape.hpp"
#include "engine/core/camera.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

// A body of water.
enum class WaterKind : std::uint8_t { kSea, kLake, kRiver };

// The water at a place.
struct WaterFacts {
  WaterKind kind = WaterKind::kSea;
  double surface_m = 0, depth_m = 0;
  double speed_m_s = 0;       // of the surface at the place
  double discharge_m3_s = 0;  // of a river
};

// The water at a position, whose height is ignored; nullopt: dry, or outside the world. Takes
// microseconds, and 30 with a river network and erosion. Any thread.
std::optional<WaterFacts> water_facts(const world::World& world, const core::WorldPosition& at);

// One per view; it keeps a copy of the world's ground.
class WaterProbe {
 public:
  WaterProbe() = default;
  WaterProbe(const WaterProbe&) = delete;
  WaterProbe& operator=(const WaterProbe&) = delete;
  ~WaterProbe();

  // Asks for the water that the ray from the camera hits before any ground, within 4 km. Does
  // nothing while a question is in work, or if it is the last one again. Takes microseconds.
  void ask(const scene::Scene& scene, const core::CameraPose& pose, const glm::dvec3& direction);
  // The newest answer; nullopt: no water. Takes microseconds.
  const std::optional<WaterFacts>& answer();
  // To be called after a change of the world.
  void note_world() { ground_.note_world(); }
  // True while another thread works.
  bool is_busy() const { return next_.valid(); }

 private:
  KeptGround ground_{std::size_t{16} << 20};  // the other thread has a share of it
  std::future<std::optional<WaterFacts>> next_;
  // Of the last question:
  std::shared_ptr<const BareGround> asked_ground_;
  core::WorldPosition asked_eye_;
  glm::dvec3 asked_direction_{0.0};
  std::optional<WaterFacts> answer_;
};

}  // namespace psygen::editor
