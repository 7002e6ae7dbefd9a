#include "engine/app/app.hpp"

#include <fmt/format.h>

#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/image/image_io.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/render/render_path.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::app {
namespace {

constexpr double kEyeHeightM = 25.0;
constexpr double kWindowHz = 60;  // held in windows unless the options say otherwise

tl::unexpected<core::Error> closed_early() {
  return core::fail(core::ErrorCode::kInterrupted, "the window was closed before the first frame");
}

core::Result<void> set_hour(const Options& options, world::World& world) {
  if (!options.start_hour) return {};
  if (!(*options.start_hour >= 0 && *options.start_hour <= 24))
    return core::fail(core::ErrorCode::kInvalidArgument, "an hour of the day is between 0 and 24");
  if (!(world.sky.day_length_s > 0)) {
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{}: this world has no hours: sky.day_length_s is 0, and the sun "
                                  "stands still",
                                  options.world_file.string()));
  }
  world.sky.start_hour = *options.start_hour;
  return {};
}

core::Result<models::Registry> make_registry(const std::vector<Plugin>& plugins) {
  models::Registry registry = models::make_standard_registry();
  for (const Plugin& plugin : plugins) {
    if (!plugin.register_models) continue;
    if (auto ok = plugin.register_models(registry); !ok) {
      return core::fail(ok.error().code,
                        fmt::format("plugin {}: {}", plugin.name, ok.error().message));
    }
  }
  return registry;
}

}  // namespace

App::App(Options options) : options_(std::move(options)) {}

App::~App() {
  scene_.reset();  // its cache gives ranges back to the renderer
  renderer_.reset();
  window_.reset();
}

core::Result<std::unique_ptr<App>> App::create(Options options) {
  std::unique_ptr<App> app(new App(std::move(options)));
  const auto opened = core::within_memory("starting the flight", [&app] { return app->open(); });
  if (!opened) return tl::unexpected(opened.error());
  return app;
}

core::Result<void> App::open() {
  if (!options_.out_folder.empty()) {
    if (auto ok = telemetry::create_output_folder(options_.out_folder); !ok) return ok;
  }
  if (auto ok = scene::Scene::check(options_.scene); !ok) return ok;
  auto registry = make_registry(options_.plugins);
  if (!registry) return tl::unexpected(registry.error());
  auto world = world::load_world(options_.world_file, *registry);
  if (!world) return tl::unexpected(world.error());
  if (auto ok = set_hour(options_, *world); !ok) return ok;
  if (!options_.path_file.empty()) {
    auto path = world::load_camera_path(options_.path_file);
    if (!path) return tl::unexpected(path.error());
    path_ = std::move(*path);
  }
  const std::string title = "psygen: " + world->name;
  if (auto ok = open_window(title); !ok) return ok;
  Loading loading(title, window_.get(), options_.stop);
  if (auto ok = open_renderer(loading); !ok) return loading.closed() ? closed_early() : ok;
  return open_scene(std::move(*world), std::move(*registry), loading);
}

core::Result<void> App::open_window(const std::string& title) {
  if (options_.headless) return {};
  auto window = platform::Window::create({title, options_.size, true});
  if (!window) {
    return core::fail(window.error().code,
                      window.error().message + " (a headless flight needs no display)");
  }
  window_ = std::move(*window);
  return {};
}

core::Result<void> App::open_renderer(Loading& loading) {
  render::RendererOptions render_options;
  render_options.device_name = options_.device_name;
  render_options.validation = options_.validation;
  render_options.size = options_.size;
  render_options.geometry_budget_bytes = options_.scene.budget_bytes;
  render_options.surface = window_.get();
  render_options.vsync = options_.vsync;
  render_options.path = options_.render_path;
  render_options.preset = options_.preset;
  if (window_) {
    render_options.progress = [&loading](render::Renderer& renderer, double fraction) {
      loading.update("preparing the renderer", fraction, &renderer);
      return !loading.closed();
    };
  }
  auto renderer = render::Renderer::create(render_options);
  if (!renderer) return tl::unexpected(renderer.error());
  renderer_ = std::move(*renderer);
  core::log_info(fmt::format("drawing with {} on the {} path", renderer_->device().name,
                             render::to_string(renderer_->path())));
  return {};
}

core::Result<void> App::open_scene(world::World world, models::Registry registry,
                                   Loading& loading) {
  const double target_hz = options_.target_hz.value_or(options_.headless ? 0 : kWindowHz);
  options_.scene.target_frame_ms = target_hz > 0 ? 1000 / target_hz : 0;
  trace_ = std::make_unique<telemetry::TraceLog>();
  auto scene =
      scene::Scene::create(std::move(world), std::move(registry), options_.scene, renderer_.get(),
                           trace_.get(), [&](std::string_view label, double fraction) {
                             return loading.update(label, fraction, renderer_.get());
                           });
  loading.finish();
  if (!scene) return tl::unexpected(scene.error());
  if (loading.closed()) return closed_early();
  scene_ = std::move(*scene);
  scene_->state().input.size = picture_size();  // levels of detail depend on it
  if (const synthesis::CalibrationReport& costs = scene_->calibration(); costs.measurements > 0) {
    core::log_info(fmt::format("cost model calibrated in {:.2f} s, median error {:.0f} %",
                               costs.seconds, costs.fit_error_percent_p50));
  }
  scene_->state().input.view = options_.view;
  pose_ = home();

  std::vector<std::string> systems;
  for (const ecs::SystemInfo& system : scene_->state().tick.systems())
    systems.push_back(system.name);
  log_ = std::make_unique<telemetry::FrameLog>(std::move(systems));
  return {};
}

core::CameraPose App::home() const {
  const world::World& world = scene_->state().facts.world;
  core::CameraPose pose;
  pose.position.block = {static_cast<std::int32_t>(world.blocks_x / 2),
                         static_cast<std::int32_t>(world.blocks_z / 2)};
  const double middle_m = world.block_size_m() / 2;
  pose.position.local = {middle_m, 0.0, middle_m};
  pose.position.local.y =
      models::ground_height_m(world.terrain, pose.position.block, middle_m, middle_m) + kEyeHeightM;
  pose.pitch = -0.12;
  return pose;
}

core::Result<void> App::prepare(const core::CameraPose& first) {
  Loading loading("psygen: " + scene_->state().facts.world.name, window_.get(), options_.stop);
  const auto progress = [&](std::string_view label, double fraction) {
    return loading.update(label, fraction, renderer_.get());
  };
  const double start_s = core::monotonic_seconds();
  std::uint64_t meshes = 0;
  scene_->state().input.size = picture_size();  // a window may have changed
  if (options_.scene.paradigm == scene::Paradigm::kDataAmplification) {
    auto amplified = scene_->amplify(first, progress);
    if (!amplified) return tl::unexpected(amplified.error());
    meshes = *amplified;
  } else if (options_.prefill &&
             options_.scene.paradigm == scene::Paradigm::kParallelLazyAmplification) {
    meshes = scene_->settle(first, progress);
  }
  loading.finish();
  if (loading.closed() || (window_ && window_->should_close())) return closed_early();
  if (meshes > 0) {
    core::log_info(fmt::format("{} meshes synthesised before the first frame in {:.2f} s", meshes,
                               core::monotonic_seconds() - start_s));
  }
  return {};
}

// The renderer knows a window's size only from the first frame on.
core::Extent App::picture_size() const {
  return window_ ? window_->framebuffer_size() : renderer_->size();
}

bool App::has_hung_modelers() const {
  return !scene_->state().meshes.hung().empty();
}

core::Result<void> App::frame(const core::CameraPose& pose, double dt_s) {
  scene::State& state = scene_->state();
  state.input.pose = pose;
  state.input.size = picture_size();
  scene::tick(state);
  state.clock.now_s += dt_s;
  if (state.output.error) return tl::unexpected(*state.output.error);
  for (const Plugin& plugin : options_.plugins) {
    if (plugin.on_frame) plugin.on_frame(*this, dt_s);
  }
  return {};
}

core::Result<image::Image> App::last_picture() {
  auto picture = renderer_->capture();
  if (!picture) return tl::unexpected(picture.error());
  return image::Image{picture->width, picture->height, std::move(picture->rgba)};
}

core::Result<void> App::write_picture(const std::filesystem::path& file,
                                      const image::Image& image) {
  const double start_s = core::monotonic_seconds();
  auto written = image::write_png(file, image);
  trace_->add_span(scene_->state().trace.main, trace_->intern("write a picture"), start_s,
                   core::monotonic_seconds());
  return written;
}

core::Result<void> App::save_picture(const std::filesystem::path& file) {
  pictured_ = true;
  const auto image = last_picture();
  if (!image) return tl::unexpected(image.error());
  if (auto ok = write_picture(file, *image); !ok) return ok;
  files_.push_back(file);
  return {};
}

}  // namespace psygen::app
