// psygen picture: renders one still image of a world, with all its meshes complete.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "engine/app/session.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/scene_options.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cli/text_values.hpp"
#include "engine/core/log.hpp"
#include "engine/image/image_io.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/camera_path.hpp"
#include "engine/world/world.hpp"

namespace psygen::cli {
namespace {

// A still image has time for full detail.
constexpr double kStillErrorPixels = 1;
constexpr render::Preset kStillPreset = render::Preset::kHigh;

core::Result<std::string> png_name(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".png") return file;
  return core::invalid_argument(fmt::format("{}: the name must end in .png", file));
}

// An incomplete image would depend on the order of requests: coarser levels replace meshes without
// memory.
core::Result<void> check_complete(const scene::Scene& scene) {
  if (scene.quality().coarsening > 1 || scene.statistics().meshes.refused > 0) {
    constexpr double kMiB = 1 << 20;
    return core::fail(
        core::ErrorCode::kOverBudget,
        fmt::format("the budget of {:.0f} MiB is too small for this image with an error of {:g} "
                    "pixels; raise --budget or --error",
                    static_cast<double>(scene.meshes().stats().budget_bytes) / kMiB,
                    scene.settings().max_error_pixels));
  }
  if (scene.statistics().failed_in_all > 0 || scene.statistics().drawn.holes > 0)
    return core::fail(core::ErrorCode::kSynthesisFailed,
                      "some visible meshes could not be synthesised");
  return {};
}

class PictureCommand final : public Command {
 public:
  explicit PictureCommand(CLI::App& cli)
      : Command(cli, "picture", "Render one still image of a world as PNG") {
    using world::CameraPath;
    CLI::App& c = *command_;
    options_.scene.max_error_pixels = kStillErrorPixels;
    options_.preset = kStillPreset;
    c.add_option("--out", out_, "Output file: .png")->required()->check(valid_if(png_name, "FILE"));
    add_parsed(c, "--at", at_, parse_place, "X,Z",
               "Camera position X,Z in metres of the world; default: the centre");
    c.add_option("--height", height_m_, "Height above ground or water, in metres")
        ->capture_default_str()
        ->check(number_between(CameraPath::kMinHeightM, CameraPath::kMaxHeightM));
    c.add_option("--yaw", yaw_deg_, "Direction of view in degrees: 0 north, 90 east")
        ->capture_default_str()
        ->check(number_between(-36'000, 36'000));
    c.add_option("--pitch", pitch_deg_, "Pitch in degrees; -90 is straight down")
        ->capture_default_str()
        ->check(number_between(-90, 90));
    add_scene_options(c, options_);
  }

  int run() override {
    if (auto ok = find_world(options_); !ok) return fail_with(ok.error());
    options_.headless = true;
    options_.stop = &stop_at_interrupt();
    auto session =
        telemetry::check_output_file(out_).and_then(image::load_picture_libraries).and_then([this] {
          return app::Session::create(options_);
        });
    const auto taken = session.and_then([this](const auto& made) { return take(*made); });
    if (taken) {
      core::log_info(fmt::format("wrote {}", out_));
    } else {
      core::log_error(taken.error().message);
    }
    const int code = taken ? kOk : exit_code_of(taken.error());
    // The hung modeler still uses the session's memory, so the destructors must not run.
    if (session && (*session)->has_hung_modelers()) std::_Exit(code);
    return code;
  }

 private:
  core::Result<void> take(app::Session& session) const {
    const world::World& world = session.scene().world();
    core::CameraPose pose = session.home();
    if (at_) {
      const auto at = position_at(world, *at_);
      if (!at) return tl::unexpected(at.error());
      pose.position = *at;
    }
    pose.position.local.y = world::surface_height_m(world, pose.position) + height_m_;
    pose.yaw = glm::radians(yaw_deg_);
    pose.pitch = glm::radians(pitch_deg_);
    if (auto ok = session.prepare(pose); !ok) return ok;
    if (options_.stop->load()) return core::fail(core::ErrorCode::kInterrupted, "interrupted");
    if (auto ok = session.tick(pose, 0); !ok) return ok;
    if (auto ok = check_complete(session.scene()); !ok) return ok;
    if (auto ok = session.save_picture(out_); !ok) return ok;
    const auto messages = session.renderer().validation_messages();
    if (messages.empty()) return {};
    return core::fail(core::ErrorCode::kInternal, fmt::format("{}", fmt::join(messages, "\n")));
  }

  app::SessionOptions options_;
  std::string out_;
  std::optional<glm::dvec2> at_;  // metres; none: the centre of the world
  double height_m_ = 1.7, yaw_deg_ = 0, pitch_deg_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_picture_command(CLI::App& cli) {
  return std::make_unique<PictureCommand>(cli);
}

}  // namespace psygen::cli
