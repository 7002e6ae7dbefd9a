// Compares images with stored ones, which lavapipe of Mesa 22.3 has drawn. To accept new images
// after inspecting them: PSYGEN_GOLDEN_UPDATE=1 ctest --preset release -R 'Golden|Looks'
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/image/compare.hpp"
#include "engine/image/image_io.hpp"
#include "engine/render/device/device_choice.hpp"
#include "engine/render/renderer.hpp"
#include "tests/source_file.hpp"

namespace psygen {

// True if tests draw with the driver of the stored images.
inline bool has_golden_driver() {
  static const bool has = [] {
    const auto devices = render::list_devices();
    const auto chosen = devices ? render::choose_device(*devices, "") : 0;
    return devices && chosen && (*devices)[*chosen].driver.find("Mesa 22.3") != std::string::npos;
  }();
  return has;
}

// Fails if `image` differs from FOLDER/NAME.png of the sources: by more than the golden threshold,
// or on another driver by more than other drivers may. `image` is then written to the test's folder
// for inspection. Prints the difference.
inline void expect_golden(const std::string& folder, const std::string& name,
                          const image::Image& image) {
  const auto stored = std::filesystem::path(source_file(folder)) / (name + ".png");
  if (std::getenv("PSYGEN_GOLDEN_UPDATE") != nullptr) {
    ASSERT_TRUE(image::write_png(stored, image));
  }
  const auto golden = image::read_image(stored);
  ASSERT_TRUE(golden) << golden.error().message;
  const image::ImageDifference difference = image::compare(*golden, image);
  const std::string figures =
      fmt::format("golden {}: mean {:.2f}, worst tile {:.2f}, most {} of 255, {:.2f} % of pixels",
                  name, difference.mean, difference.worst_tile, difference.max_difference,
                  100 * difference.share_over);
  fmt::print("{}\n", figures);
  if (has_golden_driver() ? image::matches_golden(difference)
                          : image::matches_other_driver(difference))
    return;
  const auto found = std::filesystem::path(testing::TempDir()) / (name + ".png");
  ASSERT_TRUE(image::write_png(found, image));
  ADD_FAILURE() << figures << "; see " << found;
}

}  // namespace psygen
