#include "engine/cli/device_json.hpp"

#include <array>

#include "engine/core/utf8.hpp"
#include "engine/render/device/device_choice.hpp"
#include "engine/render/preset.hpp"

namespace psygen::cli {
namespace {

std::string_view type_name(render::DeviceType type) {
  constexpr std::array<std::string_view, 5> kNames{"other", "software", "virtual GPU",
                                                   "integrated GPU", "discrete GPU"};
  return kNames[static_cast<std::size_t>(type)];
}

// The abilities that a device lacks and that psygen can do without.
std::vector<std::string_view> optional_lacks(const render::DeviceInfo& device) {
  std::vector<std::string_view> lacks;
  if (!device.multi_draw) lacks.push_back("multi-draw");
  if (!device.gpu_path) lacks.push_back("GPU path");
  if (!device.wireframe) lacks.push_back("wireframes");
  return lacks;
}

}  // namespace

nlohmann::ordered_json device_json(const render::DeviceInfo& device) {
  return {{"name", core::shown(device.name)},
          {"uuid", device.uuid},
          {"type", type_name(device.type)},
          {"driver", core::shown(device.driver)},
          {"api_version", device.api_version},
          {"memory_bytes", device.memory_bytes},
          {"lacks", device.missing},
          {"optional_lacks", optional_lacks(device)},
          {"render_path", to_string(default_path(device))},
          {"preset", to_string(default_preset(device))}};
}

}  // namespace psygen::cli
