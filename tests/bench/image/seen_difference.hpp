// Fraction of visibly different pixels of two images (Yee 2004, "A Perceptual Metric for Production
// Testing", as implemented by OpenImageIO: 100 cd/m², field of view of 45 degrees). For tools only,
// because the engine hides OpenImageIO in a separate library. Any thread; takes seconds.
#pragma once

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <cmath>

#include "engine/image/image.hpp"

namespace psygen::bench {

// Returns linear light of the three colours, without alpha.
inline OIIO::ImageBuf linear_light(const image::Image& image) {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const float v = static_cast<float>(i) / 255;
    linear[i] = v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
  }
  OIIO::ImageBuf buffer(OIIO::ImageSpec(static_cast<int>(image.width),
                                        static_cast<int>(image.height), 3, OIIO::TypeDesc::FLOAT));
  auto* const out = static_cast<float*>(buffer.localpixels());
  for (std::size_t i = 0; i < image.rgba.size() / 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      out[3 * i + c] = linear[image.rgba[4 * i + c]];
  }
  return buffer;
}

// Returns the fraction of the image, 0 to 1. Requires valid images of equal size.
inline double seen_difference(const image::Image& a, const image::Image& b) {
  OIIO::ImageBufAlgo::CompareResults results;
  const int told_apart = OIIO::ImageBufAlgo::compare_Yee(linear_light(a), linear_light(b), results);
  return 4.0 * told_apart / static_cast<double>(a.rgba.size());
}

}  // namespace psygen::bench
