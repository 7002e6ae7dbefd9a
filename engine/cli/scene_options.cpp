#include "engine/cli/scene_options.hpp"

#include "engine/cli/option_checks.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cli/text_values.hpp"
#include "engine/render/preset.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"

namespace psygen::cli {
namespace {

// The names of all debug views, beginning with "normal".
std::vector<std::string_view> view_names() {
  std::vector<std::string_view> names;
  render::View view = render::View::kNormal;
  do {
    names.push_back(render::to_string(view));
    view = render::next_view(view);
  } while (view != render::View::kNormal);
  return names;
}

void add_picture(CLI::App& c, app::SessionOptions& options) {
  add_parsed(c, "--size", options.size, parse_size, "WxH", "Image size in pixels, WIDTHxHEIGHT")
      ->default_str("1280x720");
  add_parsed(c, "--preset", options.preset, render::preset_from, "low|medium|high|ultra",
             "Quality preset: low, medium, high, ultra")
      ->default_str(options.preset ? std::string(to_string(*options.preset)) : "chosen by GPU");
  c.add_option_function<std::string>(
       "--view", [&options](const std::string& text) { options.view = *render::view_from(text); },
       "Debug view")
      ->check(one_of(view_names()))
      ->default_str("normal");
}

void add_detail(CLI::App& c, scene::SceneSettings& scene) {
  c.add_option_function<std::string>(
       "--lod", [&scene](const std::string& text) { scene.levels_of_detail = text == "on"; },
       "Levels of detail: on, or off for full detail everywhere")
      ->check(one_of({"on", "off"}))
      ->default_str("on");
  c.add_option("--view-distance", scene.view_distance_m,
               "View distance in metres; nothing beyond it is drawn")
      ->capture_default_str()
      ->check(number_between(32, 65536));
  c.add_option("--error", scene.max_error_pixels, "Allowed screen-space error in pixels")
      ->capture_default_str()
      ->check(number_between(0.1, 1000));
  c.add_option_function<std::string>(
       "--occlusion", [&scene](const std::string& text) { scene.occlusion = text == "on"; },
       "Horizon culling (skip geometry hidden by ridges): on, off")
      ->check(one_of({"on", "off"}))
      ->default_str("on");
}

void add_machine(CLI::App& c, app::SessionOptions& options) {
  c.add_option("--modelers", options.scene.modelers, "Synthesis threads; 0: number of cores - 1")
      ->transform(integer_between(0, 256));
  c.add_option_function<std::string>(
       "--budget",
       [&options](const std::string& text) { options.scene.budget_bytes = *parse_bytes(text); },
       "Memory budget for all geometry, e.g. 512M")
      ->check(bytes_between(scene::Scene::kMinBudgetBytes, scene::Scene::kMaxBudgetBytes))
      ->default_str("512M");
  c.add_option("--device", options.device_name,
               "Vulkan device: index, UUID or part of its name (psygen devices)");
  add_parsed(c, "--render-path", options.render_path, render::render_path_from, "auto|cpu|gpu",
             "Culling on the cpu or the gpu; auto: chosen by GPU")
      ->default_str("auto");
  c.add_flag_callback(
      "--pass-times", [&options] { options.pass_times = true; },
      "Measure the GPU time of each pass on software devices too, which slows them down");
  c.add_flag("--validation", options.validation,
             "Enable Vulkan validation; any message fails the run");
}

}  // namespace

void add_scene_options(CLI::App& command, app::SessionOptions& options) {
  options.world_file = kDefaultWorld;
  command
      .add_option("--world", options.world_file,
                  "World definition: a TOML file or the name of a shipped one")
      ->default_str(options.world_file.string());
  command
      .add_option_function<double>(
          "--hour", [&options](double hour) { options.start_hour = hour; },
          "Hour of the day, 0 to 24, for worlds with a day (sky.day_length_s)")
      ->check(number_between(0, 24));
  add_picture(command, options);
  add_detail(command, options.scene);
  add_machine(command, options);
}

core::Result<void> find_world(app::SessionOptions& options) {
  return find_file(Shipped::kWorld, options.world_file.string()).map([&](auto file) {
    options.world_file = std::move(file);
  });
}

core::Result<void> find_path(app::FlightOptions& options) {
  if (options.path_file.empty()) return {};
  return find_file(Shipped::kPath, options.path_file.string()).map([&](auto file) {
    options.path_file = std::move(file);
  });
}

}  // namespace psygen::cli
