#include "engine/app/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ecs/ecs.hpp"
#include "engine/app/gui.hpp"
#include "engine/app/loading.hpp"
#include "engine/app/plugin_call.hpp"
#include "engine/app/plugin_systems.hpp"
#include "engine/app/virtual_frame.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/cancellation.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/rounding.hpp"
#include "engine/handmade/files.hpp"
#include "engine/image/image_io.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/device/software_tuning.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"
#include "engine/scene/systems.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/trace_log.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::app {
namespace {

constexpr double kHomeHeightM = 25.0;  // height of the camera before it moves
constexpr double kWindowHz = 60;       // default target in windows
constexpr double kMaxTargetHz = 1e6;
constexpr double kMaxFrameS = 1e6;  // and of set_now(): a double still counts microseconds
constexpr double kMaxClockS = 1e9;
constexpr double kMinimisedWaitSeconds = 0.1;  // polling interval of a minimised window

tl::unexpected<core::Error> closed_early() {
  return core::fail(core::ErrorCode::kInterrupted, "the window was closed before the first frame");
}

core::Result<void> set_hour(const SessionOptions& options, world::World& world) {
  if (!options.start_hour) return {};
  if (!(*options.start_hour >= 0 && *options.start_hour <= 24))
    return core::invalid_argument("the hour of the day must be between 0 and 24");
  if (!(world.sky.day_length_s > 0)) {
    return core::invalid_argument(
        fmt::format("{}: this world has no day: sky.day_length_s is 0, so the sun "
                    "does not move",
                    options.world_file.string()));
  }
  world.sky.start_hour = *options.start_hour;
  return {};
}

}  // namespace

Session::Session(SessionOptions options)
    : options_(std::move(options)), plugin_systems_(std::make_unique<PluginSystems>()) {}

Session::~Session() = default;

core::Result<std::unique_ptr<Session>> Session::create(SessionOptions options) {
  const core::RoundToNearest rounding;
  std::unique_ptr<Session> session(new Session(std::move(options)));
  const auto opened =
      core::catch_out_of_memory("starting the session", [&session] { return session->open(); });
  if (!opened) return tl::unexpected(opened.error());
  return session;
}

core::Result<void> Session::open() {
  const core::CancelScope scope(options_.stop);
  if (auto fits = render::fit_software_rendering(); !fits) return tl::unexpected(fits.error());
  if (auto ok = scene::Scene::check(options_.scene); !ok) return ok;
  auto registry = make_registry(options_.plugins);
  if (!registry) return tl::unexpected(registry.error());
  auto world = read_world_with_progress(*registry);
  if (!world) return tl::unexpected(world.error());
  auto ground = read_ground_pictures(*world, options_.world_file);
  if (!ground) return tl::unexpected(ground.error());
  const std::string title = "psygen: " + world->name;
  if (auto ok = open_window(title); !ok) return ok;
  Loading loading(world->name, window_.get(), options_.stop);
  if (auto ok = open_renderer(std::move(*ground), loading); !ok)
    return loading.closed() ? closed_early() : ok;
  return open_scene(std::move(*world), std::move(*registry), loading);
}

// Shows progress on the terminal alone: the window's title needs the world's name. The bar goes
// before the warnings about the files.
core::Result<world::World> Session::read_world_with_progress(models::Registry& registry) const {
  Loading loading(options_.world_file.filename().string(), nullptr, options_.stop);
  const core::ProgressScope progress([&loading](double fraction) {
    if (fraction < 1)
      loading.update("reading models", fraction, nullptr);
    else
      loading.finish();
  });
  return read_world(options_.world_text, registry, options_.files.get());
}

core::Result<world::World> Session::read_world(std::optional<std::string_view> text,
                                               models::Registry& registry,
                                               const world::ResourceLoader* files) const {
  if (files == nullptr) files = &handmade::files();
  auto world = text ? world::parse_world(*text, options_.world_file.string(), registry, files)
                    : world::load_world(options_.world_file, registry, files);
  if (!world) return world;
  world::log_warnings(*world, options_.world_file.string());
  if (auto ok = set_hour(options_, *world); !ok) return tl::unexpected(ok.error());
  return world;
}

core::Result<void> Session::set_world(std::string_view text) {
  auto prepared = prepare_world(std::string(text))();
  if (!prepared) return tl::unexpected(prepared.error());
  return show_world(std::move(*prepared));
}

std::function<core::Result<scene::PreparedWorld>()> Session::prepare_world(
    std::string text, std::shared_ptr<const std::atomic<bool>> cancelled) const {
  return [this, text = std::move(text), cancelled = std::move(cancelled), files = options_.files,
          snapshot = scene_->snapshot()] {
    const core::RoundToNearest rounding;
    const core::CancelScope scope(cancelled.get());
    return make_registry(options_.plugins).and_then([&](models::Registry registry) {
      return read_world(text, registry, files.get()).and_then([&](world::World world) {
        return scene::prepare_world(std::move(world), std::move(registry), snapshot);
      });
    });
  };
}

core::Result<void> Session::show_world(scene::PreparedWorld prepared) {
  const core::RoundToNearest rounding;
  if (prepared.facts.world.palette.images != scene_->world().palette.images) {
    return core::invalid_argument("changed ground textures take effect when the world is reopened");
  }
  return scene_->set_world(std::move(prepared));
}

core::Result<void> Session::open_window(const std::string& title) {
  if (options_.headless || options_.surface != nullptr) return {};
  auto window = platform::Window::create({title, options_.size, true});
  if (!window) {
    return core::fail(window.error().code,
                      window.error().message + " (a headless flight needs no display)");
  }
  window_ = std::move(*window);
  if (options_.fullscreen) {
    if (auto ok = window_->set_fullscreen(true); !ok) core::log_warning(ok.error().message);
  }
  return {};
}

core::Result<void> Session::open_renderer(GroundPictures ground, Loading& loading) {
  render::RendererOptions render_options;
  render_options.ground = std::move(ground);
  render_options.device_name = options_.device_name;
  render_options.validation = options_.validation;
  render_options.size = options_.size;
  render_options.geometry_budget_bytes = options_.scene.budget_bytes;
  render_options.surface = window_ ? window_.get() : options_.surface;
  render_options.vsync = options_.vsync;
  render_options.path = options_.render_path;
  render_options.preset = options_.preset;
  render_options.pass_times = options_.pass_times;
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

core::Result<void> Session::open_scene(world::World world, models::Registry registry,
                                       Loading& loading) {
  const double target_hz = options_.target_hz.value_or(options_.headless ? 0 : kWindowHz);
  if (!(target_hz >= 0 && target_hz <= kMaxTargetHz))
    return core::invalid_argument(fmt::format(
        "the target must be 0 to {:.0f} frames per second, not {:g}", kMaxTargetHz, target_hz));
  options_.scene.target_frame_ms = target_hz > 0 ? 1000 / target_hz : 0;
  if (options_.trace) trace_ = std::make_unique<telemetry::TraceLog>();
  auto scene = scene::Scene::create(
      std::move(world), std::move(registry), options_.scene, renderer_.get(), trace_.get(),
      [&](std::string_view label, double fraction) {
        return loading.update(label, fraction, renderer_.get());
      },
      options_.remote);
  loading.finish();
  if (!scene) return tl::unexpected(scene.error());
  if (loading.closed()) return closed_early();
  scene_ = std::move(*scene);
  if (auto ok = add_systems(); !ok) return ok;
  scene_->input().size = picture_size();  // affects LODs
  if (const synthesis::CalibrationReport& costs = scene_->calibration(); costs.measurements > 0) {
    core::log_info(fmt::format("cost model calibrated in {:.2f} s, median error {:.0f} %",
                               costs.seconds, costs.fit_error_percent_p50));
  }
  scene_->input().view = options_.view;
  return {};
}

core::CameraPose Session::home() const {
  const world::World& world = scene_->world();
  core::CameraPose pose;
  pose.position.block = {static_cast<std::int32_t>(world.blocks_x / 2),
                         static_cast<std::int32_t>(world.blocks_z / 2)};
  const double middle_m = world.block_size_m() / 2;
  pose.position.local = {middle_m, 0.0, middle_m};
  pose.position.local.y =
      models::ground_height_m(world.terrain, pose.position.block, middle_m, middle_m) +
      kHomeHeightM;
  pose.pitch = -0.12;
  return pose;
}

core::Result<void> Session::prepare(const core::CameraPose& first) {
  if (!core::is_valid(first)) return core::invalid_argument("the first pose is not finite");
  Loading loading(scene_->world().name, window_.get(), options_.stop);
  const auto progress = [&](std::string_view label, double fraction) {
    return loading.update(label, fraction, renderer_.get());
  };
  const double start_s = core::monotonic_seconds();
  std::uint64_t meshes = 0;
  scene_->input().size = picture_size();  // a window may have changed its size
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

// The renderer receives a window's size with the first frame.
core::Extent Session::picture_size() const {
  if (window_) return window_->framebuffer_size();
  return options_.surface != nullptr ? options_.surface->framebuffer_size() : renderer_->size();
}

double Session::now_s() const {
  return scene_->clock().now_s;
}

void Session::set_now(double now_s) {
  if (std::abs(now_s) <= kMaxClockS) scene_->set_now(now_s);
}

bool Session::has_hung_modelers() const {
  return !scene_->meshes().hung().empty();
}

bool Session::poll() {
  if (!window_) {
    follow_surface();
    return !over();
  }
  take_events();
  while (picture_size() == core::Extent{} && !over()) {
    window_->wait_events(kMinimisedWaitSeconds);
    take_events();
  }
  return !over();
}

void Session::resize(core::Extent size) {
  if (auto ok = renderer_->resize(size); !ok) {
    core::log_error(ok.error().message);
    closed_ = true;
  }
}

void Session::follow_surface() {
  if (options_.surface == nullptr) return;
  const core::Extent size = options_.surface->framebuffer_size();
  if (std::exchange(surface_size_, size) != size) resize(size);
}

void Session::keep_open() {
  closed_ = false;
  if (window_) window_->cancel_close();
}

void Session::take_events() {
  all_input_ = window_->poll();
  input_ = filter_.apply(all_input_, {.keyboard = gui_ && gui_->takes_keyboard(),
                                      .mouse = gui_ && gui_->takes_mouse()});
  actions_.feed(input_);
  if (input_.resized) resize(window_->framebuffer_size());
  if (window_->should_close()) closed_ = true;
}

core::Result<void> Session::add_systems() {
  const auto simulates = [](const Plugin& plugin) {
    return plugin.add_systems != nullptr || plugin.on_step != nullptr;
  };
  if (std::ranges::any_of(options_.plugins, simulates)) {
    const scene::Systems systems = scene_->systems();
    systems.frame.provide(actions_);
    systems.step.provide(actions_);
    systems.step.add("actions", [this](input::Actions& actions) { step_actions(actions); });
  }
  return plugin_systems_->add(options_.plugins, *this);
}

void Session::step_actions(input::Actions& actions) {
  if (!replay_) return actions.step();
  if (replay_->step(actions)) return;
  replay_.reset();
  actions.clear();
}

core::Result<void> Session::start() {
  if (std::exchange(started_, true)) return {};
  return call_plugins(options_.plugins, &Plugin::on_start, "on_start", *this);
}

render::HudDrawing& Session::hud() {
  return scene_->input().hud;
}

Gui& Session::gui() {
  if (!gui_) gui_ = std::make_unique<Gui>(renderer_->font_atlas(), window_.get());
  return *gui_;
}

core::Result<void> Session::draw_gui(double dt_s) {
  const auto draws = [](const Plugin& plugin) { return plugin.on_gui != nullptr; };
  if (std::ranges::none_of(options_.plugins, draws)) return {};
  const core::Extent size = picture_size();
  gui().begin(all_input_, size, text_scale(window_ ? window_->content_scale() : 1.0F, size), dt_s);
  for (const Plugin& plugin : options_.plugins) {
    if (!draws(plugin)) continue;
    const auto drawn = call_plugin(plugin, "on_gui", [&] {
      return gui_->draw([&] { plugin.on_gui(*this); }).map_error([](core::Error error) {
        return core::Error{error.code, "on_gui: " + error.message};
      });
    });
    if (!drawn) return drawn;
  }
  scene_->input().gui = gui_->end();
  return {};
}

// Passes frame times to the governor. The GPU time counts if it is longer; waiting for the GPU or a
// display does not count. A software device's time is that of this machine. Images captured by
// plugins do not count.
void Session::tell_governor(double tick_ms, bool took_pictures) {
  scene::Scene& scene = *scene_;
  const render::FrameResult& drawn = scene.drawn();
  if (has_virtual_frames(options_)) {
    tick_ms = virtual_frame_ms(scene.record().triangles, scene.record().draws, scene.input().size,
                               scene.record().resolution);
  } else if (took_pictures) {
    tick_ms = 0;  // unknown
  } else if (renderer_->device().software()) {
    tick_ms -= drawn.acquire.ms;
  } else {
    tick_ms = std::max(tick_ms - drawn.wait_ms(), drawn.gpu ? drawn.gpu->ms : 0.0);
  }
  scene.input().frame_ms = tick_ms;
  // A hardware GPU reports the time of an earlier frame.
  scene.input().frame_triangles = static_cast<double>(drawn.triangles);
}

core::Result<void> Session::tick(const core::CameraPose& pose, double dt_s) {
  if (failure_) return tl::unexpected(*failure_);
  if (!(dt_s >= 0 && dt_s <= kMaxFrameS)) {
    return core::invalid_argument(
        fmt::format("{} is not a valid frame time: 0 to {:.0f} seconds", dt_s, kMaxFrameS));
  }
  if (!(now_s() + dt_s <= kMaxClockS)) {
    return core::invalid_argument(
        fmt::format("the clock cannot pass {:.0f} seconds; set_now() sets it back", kMaxClockS));
  }
  auto drawn = core::catch_out_of_memory("the frame", [&] { return draw_frame(pose, dt_s); });
  if (!drawn) failure_ = drawn.error();
  return drawn;
}

core::Result<void> Session::draw_frame(const core::CameraPose& pose, double dt_s) {
  const double start_s = core::monotonic_seconds();
  const std::size_t pictures = saved_.size();
  if (auto ok = start(); !ok) return ok;
  scene::Scene& scene = *scene_;
  scene.input().pose = pose;
  scene.input().size = picture_size();
  if (auto ok = draw_gui(dt_s); !ok) return ok;
  if (paused_) dt_s = 0;
  const auto ticked = scene.tick();
  scene.input().gui = nullptr;
  scene.set_now(scene.clock().now_s + dt_s);
  if (!ticked) return tl::unexpected(plugin_systems_->with_plugin(ticked.error(), scene));
  if (auto ok = call_plugins(options_.plugins, &Plugin::on_frame, "on_frame", *this, dt_s); !ok)
    return ok;
  tell_governor((core::monotonic_seconds() - start_s) * 1000.0, saved_.size() > pictures);
  return {};
}

core::Result<image::Image> Session::picture() {
  auto picture = renderer_->capture();
  if (!picture) return tl::unexpected(picture.error());
  return image::Image{picture->width, picture->height, std::move(picture->rgba)};
}

core::Result<void> Session::write_picture(const std::filesystem::path& file,
                                          const image::Image& image) {
  const double start_s = core::monotonic_seconds();
  auto written = image::write_png(file, image);
  scene_->trace_span("write a picture", start_s, core::monotonic_seconds());
  return written;
}

core::Result<void> Session::save_picture(const std::filesystem::path& file) {
  if (file.extension() != ".png")
    return core::invalid_argument(
        fmt::format("{}: the name of an image must end in .png", file.string()));
  const auto image = picture();
  if (!image) return tl::unexpected(image.error());
  if (auto ok = write_picture(file, *image); !ok) return ok;
  saved_.push_back(file);
  return {};
}

core::Result<void> Session::set_preset(render::Preset preset) {
  auto changed = renderer_->set_preset(preset, [this](double) {
    if (!window_) return !stopped();
    window_->keep_alive();
    return !window_->should_close() && !stopped();
  });
  if (changed) scene_->on_preset_changed();
  return changed;
}

}  // namespace psygen::app
