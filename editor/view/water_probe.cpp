#include "editor/view/water_probe.hpp"

#include <utility>

#include "engine/core/task.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::editor {
namespace {

constexpr double kProbeFarM = 4000;

}  // namespace

WaterProbe::~WaterProbe() {
  if (next_.valid()) next_.wait();
}

void WaterProbe::ask(const scene::Scene& scene, const core::CameraPose& pose,
                     const glm::dvec3& direction) {
  answer();
  if (next_.valid()) return;
  const core::WorldPosition& eye = pose.position;
  const bool rests =
      seen_eye_.block == eye.block && seen_eye_.local == eye.local && seen_direction_ == direction;
  seen_eye_ = eye;
  seen_direction_ = direction;
  if (!rests || !world::has_water(scene.world())) {
    asked_ground_ = nullptr;
    answer_ = {};
    return;
  }
  const std::shared_ptr<BareGround>& ground = ground_.of(scene.world());
  if (asked_ground_ == ground) return;
  asked_ground_ = ground;
  query::Ray ray;
  ray.origin = pose.position;
  ray.direction = direction;
  ray.longest_m = kProbeFarM;
  ray.models = ray.objects = false;
  ray.water = true;
  next_ = core::start_task(
      [ground, ray] {
        const auto hit = ground->queries.cast(ray);
        if (!hit || hit->kind != query::HitKind::kWater) return world::WaterPoint();
        return ground->queries.water(hit->position).value_or(world::WaterPoint());
      },
      core::TaskPriority::kLowest);
}

const world::WaterPoint& WaterProbe::answer() {
  if (core::is_ready(next_)) answer_ = next_.get();
  return answer_;
}

}  // namespace psygen::editor
