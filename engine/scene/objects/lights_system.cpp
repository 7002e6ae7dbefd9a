// Chooses the point lights of a frame: the most important in view, at most kMaxLit. Others fade
// out in slots of their own. Allocates nothing once there were as many lights.
#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/objects/scene_draws.hpp"
#include "engine/scene/view/visibility.hpp"

namespace psygen::scene {
namespace {

constexpr std::size_t kMaxLit = 32;
constexpr std::size_t kMaxGoing = render::kMaxPointLights - kMaxLit;
// A lit light stays lit until another is more important by this factor.
constexpr float kSlack = 1.25F;
// Lights whose range covers fewer pixels stay dark.
constexpr float kMinPixels = 3;

struct LightCandidate {
  PointLight* light = nullptr;
  glm::vec3 place{0.0F};
  float importance = 0;
  bool at_once = false;  // it came into view from the side: no fade
};

bool is_valid(const PointLight& light) {
  const auto within = [](float v, float least, float most) { return v >= least && v <= most; };
  return within(light.colour.x, 0, 1000) && within(light.colour.y, 0, 1000) &&
         within(light.colour.z, 0, 1000) && within(light.intensity, 0, 1e6F) &&
         within(light.range_m, 0.1F, 1000);
}

// Brighter lights, and lights that reach more of the frame, are more important.
float importance_of(const PointLight& light, float distance_m) {
  const float bright =
      glm::dot(light.colour, glm::vec3(0.2126F, 0.7152F, 0.0722F)) * light.intensity;
  const float large = std::min(light.range_m / std::max(distance_m, 1e-3F), 1.0F);
  return bright * large * large * (light.state.share > 0 ? kSlack : 1.0F);
}

class LightChoice {
 public:
  LightChoice(const FrameContext& frame, const Camera& camera, double block_size_m,
              const View& view, LightDraws& draws)
      : step_(next_fade_step(frame, draws.last)),
        view_distance_m_(static_cast<float>(frame.settings.view_distance_m)),
        camera_(camera),
        block_size_m_(block_size_m),
        view_(view),
        counts_(draws.counts) {}

  void visit(const Transform& transform, PointLight& light) {
    if (!is_place(transform.position) || !is_valid(light)) {
      light.state.share = 0;
      ++counts_.invalid;
      return;
    }
    LightCandidate found{&light,
                         offset_of(transform.position, camera_.pose.position, block_size_m_)};
    PointLightState& state = light.state;
    const float distance_m = glm::length(found.place);
    if (distance_m - light.range_m > view_distance_m_ ||
        !may_be_visible(core::Bounds::around(found.place, glm::vec3(light.range_m)), view_)) {
      state.share = 0;
      return;
    }
    const bool was_in_view = state.in_view_tick + 1 == step_.tick;
    found.at_once = !step_.continues || (!state.fresh && !was_in_view);
    state.in_view_tick = step_.tick;
    state.fresh = false;
    found.importance = importance_of(light, distance_m);
    const float pixels =
        2 * light.range_m * camera_.pixels_per_radian / std::max(distance_m, 1e-3F);
    if (!light.visible || found.importance <= 0 || pixels < kMinPixels) return go(found);
    propose(found);
  }

  void take(LightDraws& draws) {
    for (const LightCandidate& lit : std::span(best_).first(lit_)) {
      float& share = lit.light->state.share;
      share = lit.at_once ? 1.0F : std::min(share + step_.share, 1.0F);
      add(lit, draws);
    }
    for (const LightCandidate& going : std::span(going_).first(going_count_)) {
      float& share = going.light->state.share;
      share = std::max(share - step_.share, 0.0F);
      if (share > 0) add(going, draws);
    }
    counts_.lit += static_cast<std::uint32_t>(draws.lights.size());
  }

 private:
  static bool matters_more(const LightCandidate& a, const LightCandidate& b) {
    return a.importance > b.importance;
  }

  // Adds to the best so far, which are a heap with the least important on top.
  void propose(const LightCandidate& found) {
    const auto begin = best_.begin();
    if (lit_ == kMaxLit) {
      ++counts_.left_out;
      if (!matters_more(found, best_[0])) return go(found);
      std::pop_heap(begin, best_.end(), matters_more);
      go(best_[--lit_]);
    }
    best_[lit_++] = found;
    std::push_heap(begin, begin + static_cast<std::ptrdiff_t>(lit_), matters_more);
  }

  // Fades a light out that is no longer lit.
  void go(const LightCandidate& found) {
    if (found.light->state.share <= 0) return;
    if (found.at_once || going_count_ == kMaxGoing) {
      found.light->state.share = 0;
      return;
    }
    going_[going_count_++] = found;
  }

  static void add(const LightCandidate& found, LightDraws& draws) {
    const PointLight& light = *found.light;
    draws.lights.push_back(
        {found.place, light.range_m, light.colour * (light.intensity * light.state.share)});
  }

  FadeStep step_;
  float view_distance_m_;
  const Camera& camera_;
  double block_size_m_;
  const View& view_;
  LightCounts& counts_;
  std::array<LightCandidate, kMaxLit> best_;
  std::array<LightCandidate, kMaxGoing> going_;
  std::size_t lit_ = 0, going_count_ = 0;
};

}  // namespace

void lights_system(FrameContext frame, const Camera& camera, const WorldFacts& facts,
                   const View& view, LightQuery entities, LightDraws& draws) {
  draws.lights.clear();
  LightChoice choice(frame, camera, facts.world.block_size_m(), view, draws);
  entities.each<const Transform, PointLight>([&](auto, auto transforms, auto lights) {
    for (std::size_t i = 0; i < lights.size(); ++i)
      choice.visit(transforms[i], lights[i]);
  });
  choice.take(draws);
}

}  // namespace psygen::scene
