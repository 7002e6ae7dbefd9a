// psygen doctor: describes the machine, the device, the folders and the libraries of this program,
// and names what makes it slow, for a bug report.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/cli/commands.hpp"
#include "engine/cli/device_json.hpp"
#include "engine/cli/library_versions.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/processors.hpp"
#include "engine/core/utf8.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/render/device/software_tuning.hpp"
#include "engine/render/renderer.hpp"
#include "engine/synthesis/synthesis_manager.hpp"
#include "engine/telemetry/machine.hpp"
#include "engine/telemetry/units.hpp"

namespace psygen::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMinMemoryBytes = std::uint64_t{1} << 30;  // of a flight with its budget

template <class T>
Json json_of(const telemetry::Measured<T>& measured) {
  return measured.has_value() ? Json(*measured) : Json();
}

// The value after "NAME" and its separator in a file of the system; empty if there is none.
std::string value_in(const fs::path& file, std::string_view name) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(name)) continue;
    line.erase(0, name.size());
    std::erase(line, '"');
    return line;
  }
  return {};
}

Json program() {
  const telemetry::BuildFacts build = telemetry::build_facts();
  return {{"version", build.version},
          {"revision", json_of(build.revision)},
          {"clean", json_of(build.clean)},
          {"compiler", build.compiler},
          {"build", build.type}};
}

Json system_of(const telemetry::MachineFacts& machine) {
  std::string sets;
  for (const std::string_view set : models::simd_targets())
    sets += (sets.empty() ? "" : ", ") + std::string(set);
  return {{"name", value_in("/etc/os-release", "PRETTY_NAME=")},
          {"kernel", json_of(machine.kernel)},
          {"processor", json_of(machine.cpu)},
          {"extensions", json_of(machine.cpu_features)},
          {"instruction_sets", sets},
          {"governor", json_of(machine.governor)}};
}

Json threads_of(const telemetry::MachineFacts& machine, std::size_t raster_threads) {
  return {{"processors", sysconf(_SC_NPROCESSORS_ONLN)},
          {"allowed_by_affinity", machine.cores},
          {"granted_by_quota", json_of(machine.quota_cores)},
          {"usable", core::usable_processors()},
          {"modelers", synthesis::modeler_count_for(0)},
          {"rasteriser_threads_if_software", raster_threads}};
}

// A limit of this process in bytes; null: none.
Json limit_of(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  return limit.rlim_cur;
}

Json memory_of(const telemetry::MachineFacts& machine) {
  const std::uint64_t free_kib =
      std::strtoull(value_in("/proc/meminfo", "MemAvailable:").c_str(), nullptr, 10);
  return {{"total_bytes", json_of(machine.memory_bytes)},
          {"available_bytes", free_kib > 0 ? Json(free_kib << 10) : Json()},
          {"ulimit_v_bytes", limit_of(RLIMIT_AS)},
          {"ulimit_d_bytes", limit_of(RLIMIT_DATA)},
          {"ulimit_s_bytes", limit_of(RLIMIT_STACK)}};
}

// Of the device of a renderer, of which more is known.
Json device_of(const render::DeviceInfo& device) {
  Json found = device_json(device);
  found["largest_allocation_bytes"] = device.max_allocation_bytes;
  found["largest_image_pixels"] = device.max_image_side;
  found["timestamps"] = device.timestamps;
  return found;
}

Json libraries() {
  Json found;
  for (const LibraryVersion& library : library_versions())
    found[library.name] = {{"compiled", library.compiled}, {"loaded", library.loaded}};
  return found;
}

// A folder, and whether it exists and can be written, or whether its parents allow to create it.
Json folder_of(const fs::path& folder) {
  std::error_code error;
  fs::path near = folder;
  while (!near.empty() && !fs::exists(near, error) && near.has_relative_path())
    near = near.parent_path();
  return {{"path", folder.string()},
          {"exists", fs::is_directory(folder, error)},
          {"writable", fs::is_directory(near, error) && access(near.c_str(), W_OK) == 0}};
}

Json folders() {
  Json found = {{"data", Json::array()}};
  for (const fs::path& folder : core::data_folders()) {
    std::error_code error;
    found["data"].push_back({{"path", folder.string()},
                             {"worlds", fs::is_directory(folder / "worlds", error)},
                             {"paths", fs::is_directory(folder / "paths", error)}});
  }
  for (const auto& [name, kind] : {std::pair("user_data", core::UserFolder::kData),
                                   {"user_configuration", core::UserFolder::kConfig},
                                   {"user_state", core::UserFolder::kState}}) {
    const auto folder = core::user_folder_path(kind, "psygen");
    found[name] = folder ? folder_of(*folder) : Json(folder.error().message);
  }
  std::error_code error;
  found["temporary"] = folder_of(fs::temp_directory_path(error));
  found["shared_memory"] = folder_of("/dev/shm");
  return found;
}

Json environment() {
  Json found = Json::object();
  for (const char* name :
       {"DISPLAY", "WAYLAND_DISPLAY", "XDG_SESSION_TYPE", "XDG_RUNTIME_DIR", "HOME", "TMPDIR",
        "PSYGEN_DATA", "LP_NUM_THREADS", "VK_DRIVER_FILES", "VK_ICD_FILENAMES",
        "VK_INSTANCE_LAYERS", "VK_LOADER_DEBUG", "MESA_LOADER_DRIVER_OVERRIDE", "LD_PRELOAD"})
    if (const char* value = std::getenv(name)) found[name] = value;
  return found;
}

// The reasons why this program is slower than it could be.
Json slow_reasons(const Json& found) {
  Json reasons = Json::array();
  const Json &threads = found["threads"], &device = found["device"];
  const auto usable = threads["usable"].get<unsigned>();
  const bool software = device.value("type", "") == "software";
  if (software)
    reasons.push_back(
        "the device draws with the processors: presets above low, large images and "
        "windows are slow; a GPU needs its Vulkan driver");
  if (const std::string build = found["program"]["build"]; build.find("Rel") == build.npos)
    reasons.push_back(fmt::format("the build type is '{}', not Release", build));
  if (threads["granted_by_quota"].is_number() &&
      threads["granted_by_quota"].get<double>() < threads["allowed_by_affinity"].get<double>())
    reasons.push_back(fmt::format("control groups grant the time of {:g} of {} processors",
                                  threads["granted_by_quota"].get<double>(),
                                  threads["allowed_by_affinity"].get<unsigned>()));
  if (threads["allowed_by_affinity"] < threads["processors"])
    reasons.push_back(fmt::format("the affinity allows {} of {} processors",
                                  threads["allowed_by_affinity"].get<unsigned>(),
                                  threads["processors"].get<unsigned>()));
  if (usable == 1) reasons.push_back("one processor is usable: frames and modelers share it");
  if (software && threads["rasteriser_threads_if_software"] < usable && usable > 1)
    reasons.push_back(
        "llvmpipe draws with fewer threads than processors (LP_NUM_THREADS, ulimit "
        "-u, or a container's limit)");
  if (found["memory"]["available_bytes"].is_number() &&
      found["memory"]["available_bytes"].get<std::uint64_t>() < kMinMemoryBytes)
    reasons.push_back("less than 1 GiB of memory is available: a smaller --budget draws coarser");
  if (found["system"]["governor"] == "powersave")
    reasons.push_back("the governor of the processor's frequency is powersave");
  if (const auto load = telemetry::LoadMeter().facts().before;
      load.has_value() && *load > usable / 2.0)
    reasons.push_back(fmt::format("{:g} threads of all programs ran in the last minute", *load));
  return reasons;
}

std::string text_of(const std::string& key, const Json& value) {
  if (value.is_null()) return "none or unknown";
  if (value.is_string()) return core::shown(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (key.ends_with("_bytes")) return telemetry::bytes_text(value.get<double>());
  if (!value.is_object()) return value.dump();
  std::string text;
  for (const auto& [name, part] : value.items())
    if (part != "")
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, text_of(name, part));
  return text;
}

std::string label_of(std::string key) {
  if (key.ends_with("_bytes")) key.erase(key.size() - 6);
  std::ranges::replace(key, '_', ' ');
  return key;
}

// Sections as paragraphs, with a line for each value.
std::string text_of(const Json& found) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const auto& [section, values] : found.items()) {
    if (!values.is_structured()) continue;
    fmt::format_to(out, "{}{}\n", text.empty() ? "" : "\n", section);
    if (values.empty()) fmt::format_to(out, "  nothing\n");
    for (const auto& [key, value] : values.items()) {
      if (values.is_array())
        fmt::format_to(out, "  {}\n", text_of("", value));
      else if (!value.is_array())
        fmt::format_to(out, "  {}: {}\n", label_of(key), text_of(key, value));
      else
        for (const Json& item : value)
          fmt::format_to(out, "  {}: {}\n", label_of(key), text_of(key, item));
    }
  }
  return text;
}

class DoctorCommand final : public Command {
 public:
  explicit DoctorCommand(CLI::App& cli)
      : Command(cli, "doctor", "Describe the machine, the device and this program") {
    command_->add_flag("--json", json_, "Print the description as JSON");
    command_->add_option("--device", device_,
                         "Vulkan device: index, UUID or part of its name (psygen devices)");
  }

  int run() override {
    const telemetry::MachineFacts machine = telemetry::machine_facts();
    const Json set_by_user = environment();  // before fit_software_rendering() sets a variable
    const auto raster_threads = render::fit_software_rendering();
    Json found = {{"schema", "psygen.doctor/1"}, {"program", program()}};
    const core::Result<void> drawn =
        raster_threads ? draw(found) : tl::unexpected(raster_threads.error());
    if (!drawn) found["device"]["error"] = drawn.error().message;
    found["system"] = system_of(machine);
    found["threads"] = threads_of(machine, raster_threads.value_or(0));
    found["memory"] = memory_of(machine);
    found["folders"] = folders();
    found["libraries"] = libraries();
    found["environment"] = set_by_user;
    found["slow"] = slow_reasons(found);
    found["draws"] = drawn.has_value();
    const int printed = print(
        json_ ? found.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : text_of(found));
    return printed != kOk || drawn ? printed : fail_with(drawn.error());
  }

 private:
  // Draws a small picture, and describes the device that did.
  core::Result<void> draw(Json& found) const {
    render::RendererOptions options;
    options.device_name = device_;
    options.size = {64, 64};
    options.geometry_budget_bytes = std::uint64_t{4} << 20;
    const auto renderer = render::Renderer::create(options);
    if (!renderer) return tl::unexpected(renderer.error());
    found["device"] = device_of((*renderer)->device());
    return (*renderer)->show({});
  }

  std::string device_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_doctor_command(CLI::App& cli) {
  return std::make_unique<DoctorCommand>(cli);
}

}  // namespace psygen::cli
