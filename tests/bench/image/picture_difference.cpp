// How far the pictures of two flights differ to the eye, 1 - SSIM of each pair and their mean:
//   psygen_bench_pictures FOLDER REFERENCE
// Both folders have the pictures of psygen fly --images. tools/picture_difference.sh makes them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "engine/image/image_io.hpp"
#include "engine/image/similarity.hpp"

namespace {

namespace fs = std::filesystem;
namespace image = psygen::image;

int fail(const std::string& why) {
  fmt::print(stderr, "psygen_bench_pictures: {}\n", why);
  return 1;
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".png") names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return fail("usage: psygen_bench_pictures FOLDER REFERENCE");
  const fs::path seen = argv[1], reference = argv[2];
  const std::vector<fs::path> names = pictures_in(seen);
  if (names.empty() || names != pictures_in(reference))
    return fail("both folders must have pictures of the same frames");
  double sum = 0;
  for (const fs::path& name : names) {
    const auto a = image::read_image(seen / name), b = image::read_image(reference / name);
    if (!a || !b) return fail(!a ? a.error().message : b.error().message);
    if (a->width != b->width || a->height != b->height ||
        std::min(a->width, a->height) < image::kSimilarityWindow)
      return fail(name.string() + ": the two pictures must have one size, 8 pixels at least");
    const double difference = 1 - image::structural_similarity(*a, *b);
    fmt::print("{}  {:.4f}\n", name.string(), difference);
    sum += difference;
  }
  fmt::print("mean of {}  {:.4f}\n", names.size(), sum / static_cast<double>(names.size()));
  return 0;
}
