// psygen devices: lists the Vulkan devices, what each of them lacks, and the one that is chosen.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/cli/commands.hpp"
#include "engine/cli/device_json.hpp"
#include "engine/render/device/device_choice.hpp"
#include "engine/render/renderer.hpp"

namespace psygen::cli {
namespace {

using Json = nlohmann::ordered_json;

// All devices with their indices. `best`: the one that is chosen by default, if one can be used.
Json list_of(const std::vector<render::DeviceInfo>& devices,
             const core::Result<std::size_t>& best) {
  Json list = Json::array();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    list.push_back({{"index", i}});
    list.back().update(device_json(devices[i]));
    list.back()["chosen"] = best && *best == i;
  }
  return list;
}

std::string table_of(const Json& list) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Json& device : list) {
    const auto word = [&](const char* key) { return device[key].get<std::string>(); };
    const auto words = [&](const char* key) {
      return fmt::format("{}", fmt::join(device[key].get<std::vector<std::string>>(), ", "));
    };
    const auto line = [&](std::string_view name, std::string_view value) {
      if (!value.empty()) fmt::format_to(out, "   {:<14} {}\n", name, value);
    };
    fmt::format_to(out, "{:<2} {}{}\n", device["index"].get<std::size_t>(), word("name"),
                   device["chosen"].get<bool>() ? " (chosen by default)" : "");
    line("UUID", word("uuid"));
    line("type", word("type"));
    line("driver", word("driver") + ", Vulkan " + word("api_version"));
    line("memory", fmt::format("{} MiB", device["memory_bytes"].get<std::uint64_t>() >> 20));
    line("lacks", words("lacks"));
    if (!device["lacks"].empty()) continue;
    line("does without", words("optional_lacks"));
    line("render path", word("render_path"));
    line("preset", word("preset"));
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
    const Json list = list_of(*devices, best);
    const int printed = print(json_ ? list.dump(2) + "\n" : table_of(list));
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
