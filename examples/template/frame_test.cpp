// The frame-time test: flies the path of walk.toml through the game and compares what was measured
// with budgets.
//   my_game_frame_test FRAME_MS MISSING_PERCENT
// FRAME_MS is for the 99th percentile of frame times, MISSING_PERCENT for the largest part of a
// picture that was not there yet. Exit codes: 0 within the budgets, 1 failed, 2 usage, 3 a budget
// is missed, 77 no device.
#include <cstdio>
#include <cstdlib>

#include "engine/app/flight.hpp"
#include "engine/core/data_file.hpp"
#include "game.hpp"

using namespace psygen;

namespace {

// Prints a figure beside its budget. A figure that was not measured is a miss.
bool holds(const char* name, const telemetry::Figure& figure, double budget) {
  if (!figure.has_value()) {
    std::printf("%-16s not measured: %s\n", name, figure.reason.c_str());
    return false;
  }
  std::printf("%-16s %8.2f of %8.2f%s\n", name, *figure, budget,
              *figure > budget ? "  MISSED" : "");
  return *figure <= budget;
}

core::Result<telemetry::Summary> fly() {
  Game game;
  auto session = game.options();
  const auto path = core::data_file("walk.toml");
  if (!session) return tl::unexpected(session.error());
  if (!path) return tl::unexpected(path.error());
  app::FlightOptions options;
  options.session = std::move(*session);
  options.session.headless = true;
  options.path_file = *path;
  options.fixed_step_hz = 60;  // the same frames on every machine, however long they take
  auto flight = app::Flight::create(std::move(options));
  if (!flight) return tl::unexpected(flight.error());
  if (auto ok = game.start((*flight)->session()); !ok) return tl::unexpected(ok.error());
  auto report = (*flight)->run();
  if (!report) return tl::unexpected(report.error());
  return std::move(report->summary);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: my_game_frame_test FRAME_MS MISSING_PERCENT\n");
    return 2;
  }
  const auto summary = fly();
  if (!summary) {
    std::fprintf(stderr, "%s\n", summary.error().message.c_str());
    return summary.error().code == core::ErrorCode::kNoDevice ? 77 : 1;
  }
  const bool fast = holds("frame_ms.p99", summary->frame_ms.p99, std::atof(argv[1]));
  const bool whole =
      holds("missing_percent", summary->missing.pixels_max_percent, std::atof(argv[2]));
  return fast && whole ? 0 : 3;
}
