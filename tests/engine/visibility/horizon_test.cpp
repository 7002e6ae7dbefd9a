#include "engine/visibility/horizon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/engine/visibility/scenes.hpp"

namespace psygen::visibility {
namespace {

using testing::stream;

constexpr float kNothing = -std::numeric_limits<float>::infinity();

// Triangles over a grid of heights, as terrain meshes are, and a camera above them. Positions are
// relative to the camera.
class Heightfield {
 public:
  static constexpr int kSide = 40;  // vertices
  static constexpr double kCell_m = 10;

  explicit Heightfield(core::RandomStream& random, double camera_above_m)
      : origin_(random.next_real(0.2, 0.8) * (kSide - 1) * kCell_m,
                random.next_real(0.2, 0.8) * (kSide - 1) * kCell_m) {
    // A few waves and some noise.
    const double relief = random.next_real(5, 60);
    double phase[8];
    for (double& p : phase)
      p = random.next_real(0.02, 0.09);
    for (int z = 0; z < kSide; ++z) {
      for (int x = 0; x < kSide; ++x) {
        const double wx = x * kCell_m, wz = z * kCell_m;
        heights_.push_back(relief *
                               (std::sin(wx * phase[0] + wz * phase[1]) +
                                std::sin(wx * phase[2]) * std::sin(wz * phase[3] + phase[4] * 50)) +
                           random.next_real(0, relief / 8));
      }
    }
    camera_y_ = ground(0, 0) + camera_above_m;
  }

  // Height of the surface, relative to the camera.
  double height(double x, double z) const { return ground(x, z) - camera_y_; }

  // Lines of edges along both axes; each node is a part of the grid `side` cells wide.
  std::vector<std::vector<glm::vec3>> lines(int side) const {
    std::vector<std::vector<glm::vec3>> lines;
    for (int begin = 0; begin + 1 < kSide; begin += side) {
      for (int across = 0; across < kSide; across += 3) {
        std::vector<glm::vec3> row, column;
        for (int i = begin; i <= std::min(begin + side, kSide - 1); ++i) {
          row.push_back(vertex(i, across));
          column.push_back(vertex(across, i));
        }
        lines.push_back(row);
        lines.push_back(column);
      }
    }
    return lines;
  }

  // Returns true if the ground does not block the line from the camera to a point. Exact: along the
  // line the ground is straight between the edges of the mesh.
  bool sees(const glm::dvec3& to) const {
    std::vector<double> stops{1};
    const auto edges = [&stops](double from, double by) {
      if (by == 0) return;
      for (int i = -kSide; i <= 2 * kSide; ++i) {
        const double t = (i * kCell_m - from) / by;
        if (t > 0 && t < 1) stops.push_back(t);
      }
    };
    edges(origin_.x, to.x);
    edges(origin_.y, to.z);
    edges(origin_.x + origin_.y, to.x + to.z);  // diagonals
    return std::ranges::none_of(stops, [&](double t) {
      return is_inside(to.x * t, to.z * t) && height(to.x * t, to.z * t) > to.y * t + 1e-9;
    });
  }

  bool is_inside(double x, double z) const {
    const double far = (kSide - 1) * kCell_m, wx = x + origin_.x, wz = z + origin_.y;
    return wx >= 0 && wz >= 0 && wx <= far && wz <= far;
  }

  glm::dvec2 random_place(core::RandomStream& random) const {
    const double far = (kSide - 1) * kCell_m;
    return glm::dvec2{random.next_real(0, far), random.next_real(0, far)} - origin_;
  }

 private:
  glm::vec3 vertex(int x, int z) const {
    return glm::vec3(
        glm::dvec3(x * kCell_m - origin_.x, at(x, z) - camera_y_, z * kCell_m - origin_.y));
  }
  double at(int x, int z) const { return heights_[static_cast<std::size_t>(z * kSide + x)]; }
  // Cells are split along the diagonal on which x + z is constant.
  double ground(double x, double z) const {
    const double cx = (x + origin_.x) / kCell_m, cz = (z + origin_.y) / kCell_m;
    const int ix = std::clamp(static_cast<int>(cx), 0, kSide - 2),
              iz = std::clamp(static_cast<int>(cz), 0, kSide - 2);
    const double fx = cx - ix, fz = cz - iz;
    if (fx + fz <= 1)
      return at(ix, iz) + fx * (at(ix + 1, iz) - at(ix, iz)) + fz * (at(ix, iz + 1) - at(ix, iz));
    const double corner = at(ix + 1, iz + 1);
    return corner + (1 - fx) * (at(ix, iz + 1) - corner) + (1 - fz) * (at(ix + 1, iz) - corner);
  }

  glm::dvec2 origin_;
  double camera_y_ = 0;
  std::vector<double> heights_;
};

// Returns true if any of many points of the box is visible.
bool is_seen(const Heightfield& field, const core::Bounds& box, core::RandomStream& random) {
  for (int i = 0; i < 60; ++i) {
    // The top decides, and its corners and edges more than its middle.
    const auto pick = [&](float low, float high) {
      const double f = std::clamp(random.next_real(-0.3, 1.3), 0.0, 1.0);
      return std::lerp(static_cast<double>(low), static_cast<double>(high), f);
    };
    if (field.sees({pick(box.min.x, box.max.x),
                    static_cast<double>(i % 8 == 0 ? pick(box.min.y, box.max.y) : box.max.y),
                    pick(box.min.z, box.max.z)}))
      return true;
  }
  return false;
}

core::Bounds random_box(const Heightfield& field, core::RandomStream& random) {
  const glm::dvec2 at = field.random_place(random);
  const glm::dvec2 size{random.next_real(0, 40), random.next_real(0, 40)};
  const double low = field.height(at.x, at.y) - 5, high = low + random.next_real(0, 25);
  return {glm::vec3(at.x, low, at.y), glm::vec3(at.x + size.x, high, at.y + size.y)};
}

struct Found {
  int hidden = 0, really_hidden = 0;
};

Found compare(const Heightfield& field, const Horizon& horizon, int boxes,
              core::RandomStream& random) {
  Found found;
  for (int i = 0; i < boxes; ++i) {
    const core::Bounds box = random_box(field, random);
    const bool hidden = horizon.hides(box);
    const bool seen = is_seen(field, box, random);
    found.hidden += hidden ? 1 : 0;
    found.really_hidden += seen ? 0 : 1;
    EXPECT_FALSE(hidden && seen) << box.min.x << ' ' << box.min.z << " to " << box.max.x << ' '
                                 << box.max.y << ' ' << box.max.z;
  }
  return found;
}

TEST(Horizon, HidesNoBoxThatARayReachesAndMostOthers) {
  core::RandomStream random = stream(71, 0);
  Found all;
  for (int i = 0; i < 60; ++i) {
    const Heightfield field(random, i % 3 == 0 ? 80 : random.next_real(0.5, 20));
    Horizon horizon;
    for (const auto& line : field.lines(i % 2 == 0 ? 6 : 39))
      horizon.add(line);
    const Found found = compare(field, horizon, 300, random);
    all.hidden += found.hidden;
    all.really_hidden += found.really_hidden;
  }
  EXPECT_GT(all.really_hidden, 3000);
  EXPECT_GT(all.hidden, all.really_hidden * 6 / 10) << " of " << all.really_hidden;
}

TEST(Horizon, LinesInAnyOrderAndDirectionHideNothingVisible) {
  core::RandomStream random = stream(71, 1);
  for (int i = 0; i < 20; ++i) {
    const Heightfield field(random, random.next_real(0.5, 30));
    std::vector<std::vector<glm::vec3>> lines = field.lines(5);
    Horizon horizon;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      auto& line = lines[static_cast<std::size_t>(
          random.next_integer(0, static_cast<std::int64_t>(lines.size()) - 1))];
      if (random.next_unit() < 0.5) std::ranges::reverse(line);
      horizon.add(line);
    }
    compare(field, horizon, 200, random);
  }
}

// A ridge along x, `height` above the camera's height, at the distance z.
std::vector<glm::vec3> ridge(float z, float height, float from = -500, float to = 500) {
  std::vector<glm::vec3> line;
  for (int i = 0; i <= 20; ++i)
    line.emplace_back(std::lerp(from, to, static_cast<float>(i) / 20), height, z);
  return line;
}

core::Bounds box_at(float x, float z, float top, float side = 20) {
  return {{x - side / 2, top - 30, z - side / 2}, {x + side / 2, top, z + side / 2}};
}

TEST(Horizon, ARidgeHidesOnlyLowerBoxesBehindIt) {
  for (const float sign : {1.0F, -1.0F}) {
    Horizon horizon;
    horizon.add(ridge(sign * 100, 10));
    EXPECT_TRUE(horizon.hides(box_at(0, sign * 200, 18)));
    EXPECT_TRUE(horizon.hides(box_at(-150, sign * 200, 18)));
    EXPECT_FALSE(horizon.hides(box_at(0, sign * 200, 20)));    // higher
    EXPECT_FALSE(horizon.hides(box_at(0, sign * 60, -20)));    // before it
    EXPECT_FALSE(horizon.hides(box_at(0, sign * 100, -20)));   // around it
    EXPECT_FALSE(horizon.hides(box_at(0, -sign * 200, -20)));  // on the other side
    EXPECT_FALSE(horizon.hides(box_at(900, sign * 150, 0)));   // beside it
    EXPECT_FALSE(horizon.hides(box_at(0, 0, -20)));            // below the camera
  }
}

TEST(Horizon, WorksBelowTheCameraToo) {
  Horizon horizon;
  horizon.add(ridge(100, -20));  // −0.2
  EXPECT_TRUE(horizon.hides(box_at(0, 200, -50)));
  EXPECT_TRUE(horizon.hides(box_at(0, 200, -44)));  // its far edge at 210 m: −0.2095
  EXPECT_FALSE(horizon.hides(box_at(0, 200, -41)));
}

TEST(Horizon, ANearRidgeHidesBoxesBeforeAFartherHigherOne) {
  for (const bool far_first : {false, true}) {
    Horizon horizon;
    if (far_first) horizon.add(ridge(800, 200, -4000, 4000));
    horizon.add(ridge(100, 10));
    if (!far_first) horizon.add(ridge(800, 200, -4000, 4000));
    EXPECT_TRUE(horizon.hides(box_at(0, 300, 25)));    // behind the near one, below its line
    EXPECT_FALSE(horizon.hides(box_at(0, 300, 35)));   // above it, before the far one
    EXPECT_FALSE(horizon.hides(box_at(0, 95, -20)));   // before both
    EXPECT_TRUE(horizon.hides(box_at(0, 2000, 300)));  // behind the far one
    EXPECT_FALSE(horizon.hides(box_at(0, 2000, 520)));
  }
}

TEST(Horizon, BoxesBeyondTheLastBandAreComparedWithTheHighestGround) {
  Horizon horizon;
  horizon.add(ridge(20'000, 500, -50'000, 50'000));
  EXPECT_TRUE(horizon.hides(box_at(0, 30'000, 600, 500)));
  EXPECT_FALSE(horizon.hides(box_at(0, 30'000, 800, 500)));
  EXPECT_FALSE(horizon.hides(box_at(0, 19'000, 100, 500)));
}

TEST(Horizon, HasNoGapsWhereTheLinesOfNodesMeet) {
  Horizon horizon;
  for (float x = -500; x < 500; x += 37)
    horizon.add(ridge(100, 10, x, std::min(x + 37, 500.0F)));
  EXPECT_TRUE(horizon.hides({{-300, -10, 200}, {300, 15, 240}}));
  Horizon holed;
  for (float x = -500; x < 500; x += 37)
    if (x != -500 + 37 * 13) holed.add(ridge(100, 10, x, std::min(x + 37, 500.0F)));
  EXPECT_FALSE(holed.hides({{-300, -10, 200}, {300, 15, 240}}));
}

TEST(Horizon, ALineThatCoversPartOfABinRaisesNothing) {
  Horizon horizon;
  const float nearly = 1.0F / 300;
  horizon.add(std::vector<glm::vec3>{{100, 50, 0.01F}, {100, 50, 100 * nearly}});
  EXPECT_EQ(horizon.elevation(100, 0.05F), kNothing);
  horizon.add(std::vector<glm::vec3>{{100, 50, 100 * nearly}, {100, 50, 1}});
  EXPECT_EQ(horizon.elevation(100, 0.05F), kNothing);  // its first hundredth of a metre is open
  horizon.add(std::vector<glm::vec3>{{100, 40, -5}, {100, 40, 0.5F}});
  EXPECT_NEAR(horizon.elevation(100, 0.05F), 0.4F, 1e-3F);  // both parts together
}

// A line in the plane x = 100 m, from and to a number of bins (the first one is 0.39 m wide there).
std::vector<glm::vec3> line_in_bins(double from, double to, float height) {
  const auto z = [](double bins) { return static_cast<float>(100 * bins / (256 - bins)); };
  return {{100, height, z(from)}, {100, height, z(to)}};
}

TEST(Horizon, TwoPartsOfABinThatMeetCoverItUpToTheLowerOne) {
  for (const bool higher_first : {false, true}) {
    Horizon horizon;
    horizon.add(line_in_bins(9.5, 10.6, higher_first ? 50 : 30));
    horizon.add(line_in_bins(10.4, 11.5, higher_first ? 30 : 50));
    EXPECT_NEAR(horizon.elevation(100, 100 * 10.5F / 245.5F), 0.3F, 1e-3F);
    EXPECT_EQ(horizon.elevation(100, 100 * 9.5F / 246.5F), kNothing);
    EXPECT_EQ(horizon.elevation(100, 100 * 11.5F / 244.5F), kNothing);
  }
}

TEST(Horizon, TwoPartsOfABinHideBoxesBehindBoth) {
  for (const bool far_left : {true, false}) {
    std::vector<glm::vec3> left = line_in_bins(9.5, 10.6, 50), right = line_in_bins(10.4, 11.5, 50);
    for (glm::vec3& point : far_left ? left : right)
      point *= 3;  // 300 m away
    Horizon horizon;
    horizon.add(left);
    horizon.add(right);
    EXPECT_FALSE(horizon.hides({{200, -9, 8.3F}, {201, 0, 8.5F}}));
    EXPECT_TRUE(horizon.hides({{400, -9, 16.6F}, {401, 0, 17}}));
  }
}

TEST(Horizon, TwoPartsOfABinWithAGapBetweenThemDoNotCoverIt) {
  Horizon horizon;
  horizon.add(line_in_bins(9.5, 10.4, 50));
  horizon.add(line_in_bins(10.6, 11.5, 50));
  EXPECT_EQ(horizon.elevation(100, 100 * 10.2F / 245.8F), kNothing);
  horizon.add(line_in_bins(9.5, 10.7, 20));  // lower, but it closes the gap
  EXPECT_NEAR(horizon.elevation(100, 100 * 10.2F / 245.8F), 0.2F, 1e-3F);
}

TEST(Horizon, AClosedLineHidesAllAroundAcrossTheSeamOfTheBins) {
  std::vector<glm::vec3> ring;
  for (int i = 0; i <= 100; ++i) {
    const double turn = i * 0.06283185307;
    ring.emplace_back(100 * std::cos(turn), 10, 100 * std::sin(turn));
  }
  for (const bool reversed : {false, true}) {
    if (reversed) std::ranges::reverse(ring);
    Horizon horizon;
    horizon.add(ring);
    for (int i = 0; i < 360; ++i) {
      const auto turn = static_cast<float>(i) * 0.017453F;
      EXPECT_TRUE(horizon.hides(box_at(300 * std::cos(turn), 300 * std::sin(turn), 20))) << i;
    }
    horizon.reset();
    EXPECT_FALSE(horizon.hides(box_at(300, 0, -20)));
  }
}

TEST(Horizon, AcceptsLinesThroughTheCameraAndPointsThatAreNotNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Horizon horizon;
  horizon.add(std::vector<glm::vec3>{{-50, -2, 0}, {0, -2, 0}, {50, -2, 0}, {50, -2, 0}});
  horizon.add(std::vector<glm::vec3>{{-50, 2, 1}, {nan, 2, 1}, {50, nan, 1}, {60, 3, 9}});
  horizon.add({});
  horizon.add(std::vector<glm::vec3>{{5, 5, 5}});
  for (int i = 0; i < 64; ++i) {
    const auto turn = static_cast<float>(i) * 0.1F;
    EXPECT_FALSE(horizon.hides(box_at(300 * std::cos(turn), 300 * std::sin(turn), 20)));
  }
}

}  // namespace
}  // namespace psygen::visibility
