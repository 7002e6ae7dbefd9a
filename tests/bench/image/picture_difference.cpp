// Perceptual difference of the images of two flights: 1 - SSIM, and the percentage of visibly
// different pixels (seen_difference.hpp), for each pair and as means.
//   psygen_bench_pictures FOLDER REFERENCE
// Both folders hold the same number of images from psygen fly --images, of the same places in order
// of name. tools/picture_difference.sh creates them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "engine/image/image_io.hpp"
#include "tests/bench/image/pictures_in.hpp"
#include "tests/bench/image/seen_difference.hpp"
#include "tests/bench/image/structural_similarity.hpp"

namespace {

namespace fs = std::filesystem;
namespace image = psygen::image;

int fail(const std::string& why) {
  fmt::print(stderr, "psygen_bench_pictures: {}\n", why);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return fail("usage: psygen_bench_pictures FOLDER REFERENCE");
  const std::vector<fs::path> seen = psygen::bench::pictures_in(argv[1]),
                              reference = psygen::bench::pictures_in(argv[2]);
  if (seen.empty() || seen.size() != reference.size())
    return fail(fmt::format("{} and {} pictures: there must be as many of both, one at least",
                            seen.size(), reference.size()));
  double sum = 0, sum_apart = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto a = image::read_image(seen[i]), b = image::read_image(reference[i]);
    if (!a || !b) return fail(!a ? a.error().message : b.error().message);
    if (a->width != b->width || a->height != b->height ||
        std::min(a->width, a->height) < psygen::bench::kSimilarityWindow)
      return fail(seen[i].string() + ": the two pictures must have one size, 8 pixels at least");
    const double difference = 1 - psygen::bench::structural_similarity(*a, *b);
    const double apart = 100 * psygen::bench::seen_difference(*a, *b);
    fmt::print("{}  {:.4f}  {:.1f} %\n", seen[i].filename().string(), difference, apart);
    sum += difference;
    sum_apart += apart;
  }
  const auto count = static_cast<double>(seen.size());
  fmt::print("mean of {}  {:.4f}  {:.1f} %\n", seen.size(), sum / count, sum_apart / count);
  return 0;
}
