// Options of a short headless flight with validation.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/app/flight.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/telemetry/trace_log.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::app {

inline const std::filesystem::path kWalk = source_file("game/paths/walk27.toml");

inline SessionOptions short_session() {
  SessionOptions options;
  options.world_file = source_file("game/worlds/paper.toml");
  options.headless = true;
  options.validation = true;
  options.size = {320, 180};
  options.scene.virtual_time = true;  // results do not depend on the load of the machine
  options.scene.watchdog_seconds = 1e6;
  options.scene.view_distance_m = 200;
  options.scene.budget_bytes = 128ull << 20;
  return options;
}

inline FlightOptions short_flight() {
  FlightOptions options;
  options.session = short_session();
  options.path_file = kWalk;
  options.frames = 40;
  options.fixed_step_hz = 30;
  options.warmup_seconds = 0.2;
  return options;
}

}  // namespace psygen::app
