// Options of a short headless flight with validation, and a folder of its own for each test.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/app/flight.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/telemetry/trace_log.hpp"

namespace psygen::app {

inline std::filesystem::path fresh_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      (std::string("psygen_") + test->test_suite_name() + "_" + test->name());
  std::filesystem::remove_all(folder);
  return folder;
}

inline const std::filesystem::path kWalk = PSYGEN_SOURCE_DIR "/game/paths/walk27.toml";

inline SessionOptions short_session() {
  SessionOptions options;
  options.world_file = PSYGEN_SOURCE_DIR "/game/worlds/paper.toml";
  options.headless = true;
  options.validation = true;
  options.size = {320, 180};
  options.scene.virtual_time = true;  // tests do not depend on what the machine has left over
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
