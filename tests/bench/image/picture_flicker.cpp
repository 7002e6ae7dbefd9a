// Measures flicker, pixels that change and change back between consecutive images of a flight:
//   psygen_bench_flicker FOLDER FIRST [MARKS]
// FOLDER holds the images of psygen fly --images 1. Images before number FIRST (counted from 0) are
// skipped. Prints the mean and the 95th percentile of the percentage of flickering pixels, over all
// images with a predecessor and a successor. With MARKS, an existing folder, it writes each image
// there with flicker in red. tools/transitions.sh creates the images.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>

#include "engine/image/image_io.hpp"
#include "tests/bench/image/flicker.hpp"
#include "tests/bench/image/pictures_in.hpp"

namespace {

namespace fs = std::filesystem;
namespace image = psygen::image;

int fail(const std::string& why) {
  fmt::print(stderr, "psygen_bench_flicker: {}\n", why);
  return 1;
}

// Returns the image in dim grey, with marked pixels in red.
image::Image marked(image::Image picture, const std::vector<std::uint8_t>& marks) {
  for (std::size_t i = 0; i < marks.size(); ++i) {
    std::uint8_t* const p = &picture.rgba[4 * i];
    const auto dim = static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2]) / 8);
    p[0] = marks[i] != 0 ? 255 : dim;
    p[1] = p[2] = marks[i] != 0 ? 0 : dim;
  }
  return picture;
}

// Returns the 95th percentile.
double percentile_95(std::vector<double> values) {
  std::ranges::sort(values);
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t first = 0;
  if (argc < 3 || argc > 4 ||
      std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), first).ec != std::errc{})
    return fail("usage: psygen_bench_flicker FOLDER FIRST [MARKS]");
  std::vector<fs::path> files = psygen::bench::pictures_in(argv[1]);
  if (files.size() < first + 3) return fail("three pictures at least, from the first one on");
  files.erase(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(first));
  std::vector<image::Image> last;  // the last three images
  std::vector<double> shares;
  for (std::size_t i = 0; i < files.size(); ++i) {
    auto next = image::read_image(files[i]);
    if (!next) return fail(next.error().message);
    if (!last.empty() && (next->width != last[0].width || next->height != last[0].height))
      return fail(files[i].string() + ": the pictures must have one size");
    last.push_back(*std::move(next));
    if (last.size() < 3) continue;
    const std::vector<std::uint8_t> marks = psygen::bench::flickering(last[0], last[1], last[2]);
    const auto count = std::accumulate(marks.begin(), marks.end(), std::size_t{0});
    shares.push_back(100 * static_cast<double>(count) / static_cast<double>(marks.size()));
    if (argc == 4) {
      const fs::path to = fs::path(argv[3]) / files[i - 1].filename();
      if (const auto written = image::write_png(to, marked(last[1], marks)); !written)
        return fail(written.error().message);
    }
    last.erase(last.begin());
  }
  fmt::print(
      "{:.3f} {:.3f}\n",
      std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size()),
      percentile_95(shares));
  return 0;
}
