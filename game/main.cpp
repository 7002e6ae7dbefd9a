// psygen-game: Cairns in its window, or played by itself. Exit codes: 0 ok, 1 failed, 2 usage, 4 no
// usable device or display.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <utility>
#include <vector>

#include "engine/app/session.hpp"
#include "engine/render/preset.hpp"
#include "engine/scene/scene.hpp"
#include "game/game.hpp"

namespace cairns {
namespace {

std::atomic<bool> stop{false};
constexpr double kWarmUpS = 3;  // of autoplay, whose frames are left out of its figures

struct Arguments {
  GameOptions game;
  double seconds = 0;  // 0: until it is closed
  std::string picture, preset, device;
  bool validation = false;
};

std::optional<int> read(int argc, char** argv, Arguments& a) {
  CLI::App cli("Cairns: find twelve cairns in an endless land", "psygen-game");
  cli.add_option("--seed", a.game.seed, "begin, or go on, in the land of this word or number");
  cli.add_option("--autoplay", a.seconds, "play by itself for so many seconds")
      ->check(CLI::Range(0.1, 1e6));
  cli.add_flag("--headless", a.game.headless, "without a window; as fast as it goes")
      ->needs("--autoplay");
  cli.add_flag("--virtual-time", a.game.virtual_time, "the same pictures on every machine")
      ->needs("--headless");
  cli.add_option("--folder", a.game.folder, "of saves and settings, in place of the user's");
  cli.add_option("--record", a.game.record, "write the input of a new game to a file")
      ->needs("--seed");
  cli.add_option("--replay", a.game.replay, "play the input of a file, in a new game of its land")
      ->excludes("--record")
      ->needs("--seed");
  cli.add_option("--width", a.game.size.width, "of the window or picture, in pixels");
  cli.add_option("--height", a.game.size.height, "the same");
  cli.add_option("--preset", a.preset, "low, medium, high or ultra, in place of the settings'");
  cli.add_option("--device", a.device, "part of the name of the Vulkan device");
  cli.add_option("--modelers", a.game.modelers, "threads that make the land; 0: as suits");
  cli.add_option("--picture", a.picture, "PNG of the last frame");
  cli.add_flag("!--no-sound", a.game.sound, "silent");
  cli.add_flag("--validation", a.validation, "Vulkan validation");
  try {
    cli.parse(argc, argv);
    if (!a.preset.empty()) {
      const auto preset = render::preset_from(a.preset);
      if (!preset) throw CLI::ValidationError("--preset", preset.error().message);
      a.game.preset = *preset;
    }
  } catch (const CLI::ParseError& error) {
    return cli.exit(error) == 0 ? 0 : 2;
  }
  a.game.autoplay = a.seconds > 0;
  return std::nullopt;
}

// Of what the frames took, in milliseconds.
void tell(std::vector<double> frame_ms) {
  if (frame_ms.empty()) return;
  std::ranges::sort(frame_ms);
  const auto at = [&](double share) {
    return frame_ms[static_cast<std::size_t>(share * static_cast<double>(frame_ms.size() - 1))];
  };
  std::printf("%zu frames: %.1f ms half of them, %.1f ms 99 of 100\n", frame_ms.size(), at(0.5),
              at(0.99));
}

void tell(const Play* play) {
  if (play == nullptr) return;
  const Progress& p = play->progress();
  std::printf(
      "%zu of %zu cairns, %.0f s, walked %.0f m, %zu edits, at block %d, %d: %.3f, %.3f, %.3f\n",
      p.found.count(), kCairns, p.time_s, play->walker().walked_m(),
      static_cast<std::size_t>(play->edits().counts().removed + play->edits().counts().placed),
      p.feet.block.x, p.feet.block.z, p.feet.local.x, p.feet.local.y, p.feet.local.z);
}

core::Result<void> run(Arguments a) {
  const bool headless = a.game.headless;
  Game game(std::move(a.game));
  auto options = game.session_options();
  if (!options) return tl::unexpected(options.error());
  options->device_name = a.device;
  options->validation = a.validation;
  options->stop = &stop;
  auto made = app::Session::create(std::move(*options));
  if (!made) return tl::unexpected(made.error());
  app::Session& session = **made;
  if (auto ok = game.start(session); !ok) return ok;
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  double dt_s = 1.0 / 60, played_s = 0;
  std::vector<double> frame_ms;
  core::Result<void> ended;
  while (session.poll() && (a.seconds == 0 || played_s < a.seconds)) {
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
  tell(std::move(frame_ms));
  tell(game.play());
  const auto kept = game.end();  // whatever came before
  return ended ? kept : ended;
}

}  // namespace
}  // namespace cairns

int main(int argc, char** argv) {
  using namespace cairns;
  Arguments arguments;
  if (const auto code = read(argc, argv, arguments)) return *code;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int) { stop = true; });
  const auto ran = run(std::move(arguments));
  if (ran || ran.error().code == core::ErrorCode::kInterrupted) return 0;
  std::fprintf(stderr, "psygen-game: %s\n", ran.error().message.c_str());
  return ran.error().code == core::ErrorCode::kNoDevice ? 4 : 1;
}
