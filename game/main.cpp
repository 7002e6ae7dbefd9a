// psygen-game: Cairns in a window, or played by the autopilot. Exit codes: 0 success, 1 failure,
// 2 usage error, 4 no usable device or display.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "engine/app/session.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/program/command_line.hpp"
#include "engine/program/program.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/cost_model.hpp"
#include "game/game.hpp"

namespace cairns {
namespace {

constexpr double kWarmUpS = 3;  // frames of this part of an autoplay are excluded from statistics

struct Arguments {
  GameOptions game;
  double seconds = 0;  // 0: until the player quits
  std::string picture, preset, device;
  bool validation = false;
};

std::optional<int> read(int argc, char** argv, Arguments& a) {
  CLI::App cli("Cairns: find twelve cairns in an endless land", "psygen-game");
  cli.add_option("--seed", a.game.seed, "Start or continue in this land (any word or number)");
  cli.add_option("--autoplay", a.seconds, "Run the autopilot for this many seconds")
      ->check(CLI::Range(0.1, 1e6));
  cli.add_flag("--headless", a.game.headless, "Run without a window, as fast as possible")
      ->needs("--autoplay");
  cli.add_flag("--virtual-time", a.game.virtual_time,
               "Use a virtual clock: identical images on every machine")
      ->needs("--headless");
  cli.add_option("--folder", a.game.folder, "Folder for saves and settings (default: the user's)");
  cli.add_option("--record", a.game.record, "Record the input of a new game to this file")
      ->needs("--seed");
  cli.add_option("--replay", a.game.replay,
                 "Replay a recorded input file in a new game of its land")
      ->excludes("--record")
      ->needs("--seed");
  cli.add_option("--width", a.game.size.width, "Width of the window or image in pixels");
  cli.add_option("--height", a.game.size.height, "Height of the window or image in pixels");
  cli.add_option("--preset", a.preset,
                 "Quality: low, medium, high or ultra (default: from the settings)");
  cli.add_option("--device", a.device, "Vulkan device: index, UUID or part of its name");
  cli.add_option("--modelers", a.game.modelers,
                 "Number of modelers (worker threads); 0: automatic");
  cli.add_option("--picture", a.picture, "Save the last frame to this PNG file");
  cli.add_flag("!--no-sound", a.game.sound, "Disable sound");
  cli.add_flag("--validation", a.validation, "Enable Vulkan validation layers");
  if (const auto code = program::read_command_line(cli, argc, argv)) return code;
  if (!a.preset.empty()) {
    const auto preset = render::preset_from(a.preset);
    if (!preset) {
      core::log_error("--preset: " + preset.error().message);
      return program::kUsage;
    }
    a.game.preset = *preset;
  }
  a.game.autoplay = a.seconds > 0;
  return std::nullopt;
}

// The median and the 99th percentile of frame times in milliseconds.
std::string frame_times(std::vector<double> frame_ms) {
  if (frame_ms.empty()) return {};
  return fmt::format("{} frames: median {:.1f} ms, 99th percentile {:.1f} ms\n", frame_ms.size(),
                     synthesis::quantile(frame_ms, 0.5), synthesis::quantile(frame_ms, 0.99));
}

std::string progress_of(const Play* play) {
  if (play == nullptr) return {};
  const Progress& p = play->progress();
  return fmt::format(
      "{} of {} cairns, {:.0f} s, walked {:.0f} m, {} edits, at block {}, {}: {:.3f}, {:.3f}, "
      "{:.3f}\n",
      p.found.count(), kCairns, p.time_s, play->walker().walked_m(),
      static_cast<std::size_t>(play->edits().counts().removed + play->edits().counts().placed),
      p.feet.block.x, p.feet.block.z, p.feet.local.x, p.feet.local.y, p.feet.local.z);
}

// Checks before the game that its outputs can be written.
core::Result<void> check_outputs(const Arguments& a) {
  if (!a.picture.empty() && std::filesystem::path(a.picture).extension() != ".png")
    return core::invalid_argument(a.picture + ": the name of an image must end in .png");
  for (const std::filesystem::path& file : {std::filesystem::path(a.picture), a.game.record}) {
    if (file.empty()) continue;
    if (auto ok = core::check_replaceable(file); !ok) return ok;
  }
  return {};
}

core::Result<void> run(Arguments a) {
  if (auto ok = check_outputs(a); !ok) return ok;
  const bool headless = a.game.headless;
  Game game(std::move(a.game));
  auto options = game.session_options();
  if (!options) return tl::unexpected(options.error());
  options->device_name = a.device;
  options->validation = a.validation;
  options->stop = &program::stop_at_interrupt();
  auto made = app::Session::create(std::move(*options));
  if (!made) return tl::unexpected(made.error());
  app::Session& session = **made;
  if (auto ok = game.start(session); !ok) return ok;
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  double dt_s = 1.0 / 60, played_s = 0;
  std::vector<double> frame_ms;
  core::Result<void> ended;
  while (a.seconds == 0 || played_s < a.seconds) {
    if (!session.poll() && game.may_end(session)) break;
    ended = session.tick(game.frame(session, dt_s), dt_s);
    if (!ended) break;
    played_s += dt_s;
    const Clock::time_point now = Clock::now();
    const double took_s = std::chrono::duration<double>(now - std::exchange(last, now)).count();
    if (!headless) dt_s = std::min(took_s, 0.25);
    if (a.seconds > 0 && played_s > kWarmUpS) frame_ms.push_back(1000 * took_s);
    if (a.seconds > 0 && game.play() != nullptr && game.play()->is_finished()) break;
  }
  if (ended && !a.picture.empty()) ended = session.save_picture(a.picture);
  const std::string told = frame_times(std::move(frame_ms)) + progress_of(game.play());
  const auto kept = game.end();  // also after a failed frame
  if (program::print(told) != program::kOk && ended)
    ended = core::fail(core::ErrorCode::kIo, "the results were not printed");
  if (!ended || !kept) return ended ? kept : ended;
  const std::vector<std::string> messages = session.renderer().validation_messages();
  for (const std::string& message : messages)
    core::log_error(message);
  if (messages.empty()) return {};
  return core::fail(core::ErrorCode::kInternal,
                    fmt::format("the validation layers sent {} messages", messages.size()));
}

}  // namespace
}  // namespace cairns

int main(int argc, char** argv) {
  using namespace cairns;
  return program::run("psygen-game", [&] {
    Arguments arguments;
    if (const auto code = read(argc, argv, arguments)) return *code;
    return program::exit_code(run(std::move(arguments)));
  });
}
