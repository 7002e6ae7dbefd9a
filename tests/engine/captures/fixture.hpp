// Reads small captures in the tests' texts.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "engine/captures/capture.hpp"

namespace psygen::captures {

// The capture in a text, which must be readable.
inline Capture read_text(std::string_view text, const std::string& name = "log.csv") {
  auto capture = parse(text, name);
  EXPECT_TRUE(capture) << capture.error().message;
  return capture ? *capture : Capture{};
}

// The message for a text that must be refused.
inline std::string error_of(std::string_view text, const std::string& name = "log.csv") {
  const auto capture = parse(text, name);
  EXPECT_FALSE(capture) << "read " << (capture ? capture->frame_ms.size() : 0) << " frames";
  return capture ? "" : capture.error().message;
}

inline auto times_are(std::initializer_list<double> times) {
  std::vector<testing::Matcher<double>> matchers;
  for (const double time : times)
    matchers.push_back(testing::DoubleNear(time, 1e-9));
  return testing::Field(&Capture::frame_ms, testing::ElementsAreArray(matchers));
}

inline auto notes_with(std::string_view part) {
  return testing::Field(&Capture::notes, testing::Contains(testing::HasSubstr(std::string(part))));
}

}  // namespace psygen::captures
