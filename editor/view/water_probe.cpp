#include "editor/view/water_probe.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include "engine/core/headroom.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/water.hpp"

namespace psygen::editor {
namespace {

constexpr double kProbeFarM = 4000;

}  // namespace

std::optional<WaterFacts> water_facts(const world::World& world, const core::WorldPosition& at) {
  const core::WorldPosition place = core::normalised(at, world.block_size_m());
  if (!world.contains(place.block)) return std::nullopt;
  const world::WaterPoint water = world::water_at(world, place);
  if (water.is_dry()) return std::nullopt;
  WaterFacts facts;
  facts.surface_m = water.surface_m;
  facts.depth_m = water.depth_m;
  facts.speed_m_s = std::hypot(double{water.flow_m_s.x}, double{water.flow_m_s.y});
  if (water.body == world::kSea) return facts;
  const auto discharge_m3_s = world::river_discharge_m3_s(world, place);
  facts.kind = discharge_m3_s ? WaterKind::kRiver : WaterKind::kLake;
  facts.discharge_m3_s = discharge_m3_s.value_or(0);
  return facts;
}

WaterProbe::~WaterProbe() {
  if (next_.valid()) next_.wait();
}

void WaterProbe::ask(const scene::Scene& scene, const core::CameraPose& pose,
                     const glm::dvec3& direction) {
  answer();
  if (next_.valid()) return;
  if (!world::has_water(scene.world())) {
    asked_ground_ = nullptr;
    answer_ = std::nullopt;
    return;
  }
  const std::shared_ptr<BareGround>& ground = ground_.of(scene.world());
  const core::WorldPosition& eye = pose.position;
  if (asked_ground_ == ground && asked_eye_.block == eye.block && asked_eye_.local == eye.local &&
      asked_direction_ == direction)
    return;
  asked_ground_ = ground;
  asked_eye_ = eye;
  asked_direction_ = direction;
  query::Ray ray;
  ray.origin = pose.position;
  ray.direction = direction;
  ray.longest_m = kProbeFarM;
  ray.models = ray.objects = false;
  ray.water = true;
  using Task = std::packaged_task<std::optional<WaterFacts>()>;
  const auto task = std::make_shared<Task>([ground, ray]() -> std::optional<WaterFacts> {
    const auto hit = ground->queries.cast(ray);
    if (!hit || hit->kind != query::HitKind::kWater) return std::nullopt;
    return water_facts(ground->world, hit->position);
  });
  auto thread = core::start_thread([task] { (*task)(); });
  if (!thread) {
    asked_ground_ = nullptr;  // asks again
    return;
  }
  next_ = task->get_future();
  thread->detach();
}

const std::optional<WaterFacts>& WaterProbe::answer() {
  if (next_.valid() && next_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
    answer_ = next_.get();
  return answer_;
}

}  // namespace psygen::editor
