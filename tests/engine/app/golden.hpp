// Golden images of sessions (tests/golden_image.hpp).
#pragma once

#include <string>

#include "tests/engine/app/fixture.hpp"
#include "tests/golden_image.hpp"

namespace psygen::app {

// Compares with the stored NAME.png of tests/engine/app/golden.
inline void expect_golden(const std::string& name, const image::Image& image) {
  psygen::expect_golden("tests/engine/app/golden", name, image);
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
