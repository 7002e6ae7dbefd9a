// Animations of nodes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

constexpr float kMaxSeconds = 1e6F, kMaxValue = 1e6F;

core::Result<std::vector<float>> read_times(Reading& reading, int accessor,
                                            const std::string& what) {
  const auto elements = elements_of(reading, accessor, what);
  if (!elements) return tl::unexpected(elements.error());
  if (elements->width != 1 || elements->count == 0) return wrong(what + " has no times");
  if (auto ok = add_within_limit(reading.keys, elements->count, reading.limits.keys, "keys"); !ok)
    return tl::unexpected(ok.error());
  std::vector<float> times(elements->count);
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = elements->real(i, 0);
    const float before = i == 0 ? 0.0F : times[i - 1];
    const bool grows = i == 0 ? times[i] >= 0 : times[i] > before;
    if (!grows || !(times[i] <= kMaxSeconds))
      return wrong(fmt::format("{}: time {} is {} s after {} s; times must ascend from 0 to {} s",
                               what, i, times[i], before, kMaxSeconds));
  }
  return times;
}

core::Result<std::vector<glm::vec4>> read_values(Reading& reading, int accessor, std::size_t count,
                                                 int width, const std::string& what) {
  const auto elements = elements_of(reading, accessor, what);
  if (!elements) return tl::unexpected(elements.error());
  if (elements->width != width || elements->count != count)
    return wrong(fmt::format("{} has {} values of {} numbers; {} of {} are needed", what,
                             elements->count, elements->width, count, width));
  if (auto ok = add_within_limit(reading.keys, count, reading.limits.keys, "keys"); !ok)
    return tl::unexpected(ok.error());
  std::vector<glm::vec4> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = vector_of<glm::vec4>(*elements, i);
    for (int c = 0; c < width; ++c) {
      if (!(std::abs(values[i][c]) <= kMaxValue))
        return wrong(fmt::format("{}: value {} has {}; at most {} is allowed", what, i,
                                 values[i][c], kMaxValue));
    }
  }
  return values;
}

std::optional<Property> property_of(const std::string& path) {
  if (path == "translation") return Property::kTranslation;
  if (path == "rotation") return Property::kRotation;
  if (path == "scale") return Property::kScale;
  return {};
}

// Reads one channel. Returns nothing if it moves no node of the scene.
core::Result<std::optional<Channel>> read_channel(Reading& reading, const AnimationJson& animation,
                                                  std::size_t index, const std::string& name) {
  const ChannelJson& described = animation.channels[index];
  const std::string what = fmt::format("{}.channels[{}]", name, index);
  if (described.is_pointer || described.node == kAbsent) {
    reading.note(
        described.is_pointer
            ? "has animations by the extension \"KHR_animation_pointer\", which are left out"
            : "has animation channels without a node, which are left out");
    return std::optional<Channel>{};
  }
  const auto node = index_in(described.node, reading.node_numbers.size(), what + ".node");
  if (!node) return tl::unexpected(node.error());
  if (described.path == "weights") {
    reading.note("has morph targets, which are not supported; it keeps its base shape");
    return std::optional<Channel>{};
  }
  const auto property = property_of(described.path);
  if (!property) return wrong(what + ".path must be translation, rotation, scale or weights");
  if (reading.node_numbers[*node] == kNone) return std::optional<Channel>{};

  const auto sampler_number =
      index_in(described.sampler, animation.samplers.size(), what + ".sampler");
  if (!sampler_number) return tl::unexpected(sampler_number.error());
  const SamplerJson& sampler = animation.samplers[*sampler_number];
  const std::string source = fmt::format("{}.samplers[{}]", name, *sampler_number);
  Channel channel;
  channel.node = reading.node_numbers[*node];
  channel.property = *property;
  if (sampler.interpolation == "STEP") {
    channel.interpolation = Interpolation::kStep;
  } else if (sampler.interpolation == "CUBICSPLINE") {
    channel.interpolation = Interpolation::kCubic;
  } else if (sampler.interpolation != "LINEAR") {
    return wrong(source + ".interpolation must be STEP, LINEAR or CUBICSPLINE");
  }
  auto times = read_times(reading, sampler.input, source + ".input");
  if (!times) return tl::unexpected(times.error());
  const std::size_t each = channel.interpolation == Interpolation::kCubic ? 3 : 1;
  const int width = channel.property == Property::kRotation ? 4 : 3;
  auto values =
      read_values(reading, sampler.output, each * times->size(), width, source + ".output");
  if (!values) return tl::unexpected(values.error());
  channel.times_s = std::move(*times);
  channel.values = std::move(*values);
  return channel;
}

}  // namespace

core::Result<void> read_animations(Reading& reading) {
  for (std::size_t i = 0; i < reading.file.animations.size(); ++i) {
    const AnimationJson& described = reading.file.animations[i];
    const std::string name = fmt::format("animations[{}]", i);
    Animation animation;
    animation.name = described.name.empty() ? fmt::format("animation_{}", i) : described.name;
    for (std::size_t c = 0; c < described.channels.size(); ++c) {
      auto channel = read_channel(reading, described, c, name);
      if (!channel) return tl::unexpected(channel.error());
      if (!*channel) continue;
      animation.duration_s = std::max(animation.duration_s, (*channel)->times_s.back());
      animation.channels.push_back(std::move(**channel));
    }
    if (!animation.channels.empty()) reading.out.animations.push_back(std::move(animation));
  }
  return {};
}

}  // namespace psygen::gltf
