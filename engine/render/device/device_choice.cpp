#include "engine/render/device/device_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/utf8.hpp"

namespace psygen::render {

namespace {

using core::ErrorCode;

// "0 'llvmpipe', 1 'SwiftShader' (lacks timelineSemaphore)".
std::string list_of(std::span<const DeviceInfo> devices, std::span<const std::size_t> places) {
  std::vector<std::string> entries;
  for (const std::size_t i : places) {
    const std::string lacks = fmt::format("{}", fmt::join(devices[i].missing, ", "));
    entries.push_back(fmt::format("{} '{}'{}", i, devices[i].name,
                                  lacks.empty() ? "" : fmt::format(" (lacks {})", lacks)));
  }
  return fmt::format("{}", fmt::join(entries, ", "));
}

// The places of the devices for which fits(device).
template <class Fits>
std::vector<std::size_t> places_of(std::span<const DeviceInfo> devices, const Fits& fits) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (fits(devices[i])) places.push_back(i);
  return places;
}

// The places of all devices that `wish` may name, by the first rule that fits any.
std::vector<std::size_t> named_places(std::span<const DeviceInfo> devices, std::string_view wish) {
  std::size_t place = 0;
  const char* const end = wish.data() + wish.size();
  const auto number = std::from_chars(wish.data(), end, place);
  if (number.ptr == end) {  // also a number too large for a place
    if (number.ec != std::errc() || place >= devices.size()) return {};
    return {place};
  }
  const std::string wanted = core::lower_ascii(wish);
  const auto is_whole = [&](const DeviceInfo& device) {
    return core::lower_ascii(device.uuid) == wanted || core::lower_ascii(device.name) == wanted;
  };
  const auto is_part = [&](const DeviceInfo& device) {
    return core::lower_ascii(device.name).find(wanted) != std::string::npos;
  };
  const std::vector<std::size_t> whole = places_of(devices, is_whole);
  return whole.empty() ? places_of(devices, is_part) : whole;
}

}  // namespace

RenderPath default_path(const DeviceInfo& device) {
  return device.gpu_path && !device.software() ? RenderPath::kGpu : RenderPath::kCpu;
}

Preset default_preset(const DeviceInfo& device) {
  return device.software() ? Preset::kLow : Preset::kHigh;
}

core::Result<std::size_t> choose_device(std::span<const DeviceInfo> devices,
                                        std::string_view wish) {
  const auto fail = [](std::string message) {
    return core::fail(ErrorCode::kNoDevice, std::move(message));
  };
  const auto usable = [](const DeviceInfo& device) { return device.missing.empty(); };
  const std::vector<std::size_t> all = places_of(devices, [](const DeviceInfo&) { return true; });
  if (all.empty()) return fail("there is no Vulkan device on this machine");
  if (wish.empty()) {
    const std::vector<std::size_t> places = places_of(devices, usable);
    const auto best = std::ranges::max_element(
        places, std::less(), [&](std::size_t i) { return static_cast<int>(devices[i].type); });
    if (best != places.end()) return *best;
    return fail("psygen can use no Vulkan device of this machine: " + list_of(devices, all));
  }
  const std::vector<std::size_t> places = named_places(devices, wish);
  if (places.empty()) {
    return fail(fmt::format("no Vulkan device has the index, UUID or name '{}'; there is {}", wish,
                            list_of(devices, all)));
  }
  if (places.size() > 1) {
    return fail(fmt::format("'{}' fits several Vulkan devices: {}; give an index or a UUID", wish,
                            list_of(devices, places)));
  }
  if (!usable(devices[places[0]])) {
    return fail("psygen cannot use the Vulkan device " + list_of(devices, places));
  }
  return places[0];
}

}  // namespace psygen::render
