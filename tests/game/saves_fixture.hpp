// A land, and a temporary folder for its saves.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include "game/play/saved.hpp"

namespace cairns {

class SavesFixture : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::unique_ptr<Play> begin() { return *Play::create(land_->world, land_->registry); }
  std::filesystem::path file() const { return save_file(folder_, land_->world.seed); }

  std::unique_ptr<Land> land_ = *Land::load(3);
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("psygen_saves_" + std::to_string(::getpid()));
};

}  // namespace cairns
