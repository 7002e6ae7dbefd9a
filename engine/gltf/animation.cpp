#include "engine/gltf/animation.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace psygen::gltf {
namespace {

glm::quat quaternion(const glm::vec4& v) {
  return {v.w, v.x, v.y, v.z};
}

glm::vec4 unit(const glm::vec4& v) {
  const float length = glm::length(v);
  return length > 1e-6F ? v / length : glm::vec4(0, 0, 0, 1);
}

// Hermite's spline (glTF 2.0, appendix C.5).
glm::vec4 cubic(const glm::vec4* from, const glm::vec4* to, float t, float step_s) {
  const float t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * from[1] + step_s * (t3 - 2 * t2 + t) * from[2] +
         (-2 * t3 + 3 * t2) * to[1] + step_s * (t3 - t2) * to[0];
}

glm::vec4 linear(const Channel& channel, const glm::vec4& from, const glm::vec4& to, float t) {
  if (channel.property != Property::kRotation) return from + (to - from) * t;
  const glm::quat q = glm::slerp(quaternion(from), quaternion(to), t);
  return {q.x, q.y, q.z, q.w};
}

}  // namespace

glm::vec4 value_at(const Channel& channel, float time_s) {
  const std::vector<float>& times = channel.times_s;
  const bool cubics = channel.interpolation == Interpolation::kCubic;
  const std::size_t width = cubics ? 3 : 1, middle = cubics ? 1 : 0;
  const auto after =
      static_cast<std::size_t>(std::ranges::upper_bound(times, time_s) - times.begin());
  glm::vec4 value;
  if (after == 0 || after == times.size() || channel.interpolation == Interpolation::kStep) {
    value = channel.values[(after == 0 ? 0 : after - 1) * width + middle];
  } else {
    const float step_s = times[after] - times[after - 1];
    const float t = (time_s - times[after - 1]) / step_s;
    const glm::vec4* from = &channel.values[(after - 1) * width];
    const glm::vec4* to = from + width;
    value = cubics ? cubic(from, to, t, step_s) : linear(channel, *from, *to, t);
  }
  return channel.property == Property::kRotation ? unit(value) : value;
}

void apply(const Channel& channel, float time_s, Pose& pose) {
  const glm::vec4 value = value_at(channel, time_s);
  switch (channel.property) {
    case Property::kTranslation:
      pose.translation = glm::vec3(value);
      break;
    case Property::kRotation:
      pose.rotation = quaternion(value);
      break;
    case Property::kScale:
      pose.scale = glm::vec3(value);
  }
}

float place_in(const Animation& animation, double passed_s, bool loops) {
  const double duration_s = animation.duration_s;
  if (!(duration_s > 0) || !std::isfinite(passed_s)) return 0;
  if (!loops) return static_cast<float>(std::clamp(passed_s, 0.0, duration_s));
  const double place_s = std::fmod(passed_s, duration_s);
  return static_cast<float>(place_s < 0 ? place_s + duration_s : place_s);
}

}  // namespace psygen::gltf
