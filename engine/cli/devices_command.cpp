// psygen devices: lists the Vulkan devices, what each of them lacks, and the one that is chosen.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/cli/commands.hpp"
#include "engine/core/utf8.hpp"
#include "engine/render/device/device_choice.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"

namespace psygen::cli {
namespace {

using render::DeviceInfo;

std::string_view type_name(render::DeviceType type) {
  constexpr std::array<std::string_view, 5> kNames{"other", "software", "virtual GPU",
                                                   "integrated GPU", "discrete GPU"};
  return kNames[static_cast<std::size_t>(type)];
}

// The abilities that a device lacks and that psygen can do without.
std::vector<std::string_view> optional_lacks(const DeviceInfo& device) {
  std::vector<std::string_view> lacks;
  if (!device.multi_draw) lacks.push_back("multi-draw");
  if (!device.gpu_path) lacks.push_back("GPU path");
  if (!device.wireframe) lacks.push_back("wireframes");
  return lacks;
}

std::string json_of(const std::vector<DeviceInfo>& devices, const core::Result<std::size_t>& best) {
  auto list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    list.push_back({{"index", i},
                    {"name", core::shown(device.name)},
                    {"uuid", device.uuid},
                    {"type", type_name(device.type)},
                    {"driver", core::shown(device.driver)},
                    {"api_version", device.api_version},
                    {"memory_bytes", device.memory_bytes},
                    {"lacks", device.missing},
                    {"optional_lacks", optional_lacks(device)},
                    {"render_path", to_string(default_path(device))},
                    {"preset", to_string(default_preset(device))},
                    {"chosen", best && *best == i}});
  }
  return list.dump(2) + "\n";
}

std::string table_of(const std::vector<DeviceInfo>& devices,
                     const core::Result<std::size_t>& best) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    const auto line = [&](std::string_view name, std::string_view value) {
      if (!value.empty()) fmt::format_to(out, "   {:<14} {}\n", name, value);
    };
    fmt::format_to(out, "{:<2} {}{}\n", i, core::shown(device.name),
                   best && *best == i ? " (chosen by default)" : "");
    line("UUID", device.uuid);
    line("type", type_name(device.type));
    line("driver", core::shown(device.driver) + ", Vulkan " + device.api_version);
    line("memory", fmt::format("{} MiB", device.memory_bytes >> 20));
    line("lacks", fmt::format("{}", fmt::join(device.missing, ", ")));
    if (!device.missing.empty()) continue;
    line("does without", fmt::format("{}", fmt::join(optional_lacks(device), ", ")));
    line("render path", to_string(default_path(device)));
    line("preset", to_string(default_preset(device)));
  }
  return text;
}

class DevicesCommand final : public Command {
 public:
  explicit DevicesCommand(CLI::App& cli)
      : Command(cli, "devices", "List the Vulkan devices and what each of them lacks") {
    command_->add_flag("--json", json_, "Print the list as JSON");
  }

  int run() override {
    const auto devices = render::list_devices();
    if (!devices) return fail_with(devices.error());
    const auto best = render::choose_device(*devices, "");
    const int printed = print(json_ ? json_of(*devices, best) : table_of(*devices, best));
    return printed == kOk && !best ? fail_with(best.error()) : printed;
  }

 private:
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_devices_command(CLI::App& cli) {
  return std::make_unique<DevicesCommand>(cli);
}

}  // namespace psygen::cli
