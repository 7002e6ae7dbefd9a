// Compares images with stored ones. To accept new images after inspecting them:
// PSYGEN_GOLDEN_UPDATE=1 ctest --preset release -R Golden
#pragma once

#include <cstdlib>
#include <string>

#include "engine/image/compare.hpp"
#include "engine/image/image_io.hpp"
#include "tests/engine/app/fixture.hpp"
#include "tests/source_file.hpp"

namespace psygen::app {

// Fails if `image` differs from the stored NAME.png of tests/engine/app/golden; `image` is then
// written to the test's folder for inspection.
inline void expect_golden(const std::string& name, const image::Image& image) {
  const auto stored =
      std::filesystem::path(source_file("tests/engine/app/golden")) / (name + ".png");
  if (std::getenv("PSYGEN_GOLDEN_UPDATE") != nullptr) {
    ASSERT_TRUE(image::write_png(stored, image));
  }
  const auto golden = image::read_image(stored);
  ASSERT_TRUE(golden) << golden.error().message;
  const image::ImageDifference difference = image::compare(*golden, image);
  if (image::matches_golden(difference)) return;
  const auto found = std::filesystem::path(testing::TempDir()) / (name + ".png");
  ASSERT_TRUE(image::write_png(found, image));
  ADD_FAILURE() << "fraction of differing pixels " << difference.share_over << "; see " << found;
}

inline image::Image captured(Session& session) {
  auto picture = session.renderer().capture();
  if (!picture) {
    ADD_FAILURE() << picture.error().message;
    return {};
  }
  return {picture->width, picture->height, std::move(picture->rgba)};
}

}  // namespace psygen::app
