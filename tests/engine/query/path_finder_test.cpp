// Paths over the ground: walkable, around obstacles, the same each time.
#include "engine/query/path_finder.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/engine/query/worlds.hpp"

namespace psygen::query {
namespace {

using testing::Loaded;

class Ways : public ::testing::Test {
 protected:
  Loaded loaded_ = Loaded::shipped("lakes");
  World query_{loaded_.world, loaded_.registry};
  double block_m_ = loaded_.world.block_size_m();

  core::WorldPosition dry(double x, double z) {
    for (int i = 0; i < 2000; ++i) {
      core::WorldPosition at = core::normalised({{40, 40}, {x + 3.0 * i, 0, z}}, block_m_);
      const auto ground = query_.ground(at);
      if (!ground || ground->water_depth_m > 0 || ground->normal.y < 0.95) continue;
      at.local.y = ground->height_m;
      return at;
    }
    ADD_FAILURE();
    return {};
  }
  glm::dvec3 way(const core::WorldPosition& a, const core::WorldPosition& b) const {
    return core::offset_m(b.block, a, block_m_) + b.local;
  }
};

TEST_F(Ways, LeadToTheDestinationOnWalkableGround) {
  PathFinder finder(query_);
  const core::WorldPosition from = dry(0, 0), to = dry(160, 90);
  const auto points = finder.find(from, to);
  ASSERT_GT(points.size(), 20U);
  EXPECT_EQ(way(points.front(), from), glm::dvec3(0.0));
  EXPECT_LT(glm::length(way(points.back(), to)), 1e-9);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const glm::dvec3 step = way(points[i - 1], points[i]);
    const double run = std::hypot(step.x, step.z);
    EXPECT_LE(run, 3 * PathFinder::kCellM);
    const auto a = query_.ground(points[i - 1]), b = query_.ground(points[i]);
    ASSERT_TRUE(a && b);
    if (i > 1 && i + 1 < points.size() && a->water_depth_m == 0 && b->water_depth_m == 0) {
      EXPECT_LE(b->height_m - a->height_m, 0.8 * run + 1e-6);
      EXPECT_GE(b->height_m - a->height_m, -2.2 * run - 1e-6);
    }
  }
  EXPECT_TRUE(finder.reaches(from, to));
}

TEST_F(Ways, AreTheSameEachTimeAndFromAnyFinder) {
  const core::WorldPosition from = dry(0, 0), to = dry(120, -60);
  PathFinder first(query_);
  World other_query(loaded_.world, loaded_.registry);
  PathFinder second(other_query);
  const auto a = first.find(from, to), again = first.find(from, to), b = second.find(from, to);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.size(), again.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].local, b[i].local);
    EXPECT_EQ(a[i].local, again[i].local);
  }
}

TEST_F(Ways, AreTheSameInOneSearchAndInSteps) {
  const core::WorldPosition from = dry(0, 0), to = dry(120, -60);
  PathFinder finder(query_);
  const auto whole = finder.find(from, to);
  EXPECT_FALSE(finder.is_searching());
  EXPECT_FALSE(finder.advance(100));
  finder.begin(to, from);
  EXPECT_FALSE(finder.advance(10));
  finder.begin(from, to);  // replaces the other search
  std::optional<std::vector<core::WorldPosition>> found;
  int pieces = 0;
  for (; !found && pieces < 100'000; ++pieces) {
    EXPECT_TRUE(finder.is_searching());
    found = finder.advance(50);
  }
  ASSERT_TRUE(found);
  EXPECT_GT(pieces, 2);
  EXPECT_FALSE(finder.is_searching());
  ASSERT_EQ(found->size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_EQ((*found)[i].local, whole[i].local);
}

TEST_F(Ways, AvoidGivenCircles) {
  PathFinder finder(query_);
  const core::WorldPosition from = dry(0, 0), to = dry(60, 30);
  const auto before = finder.find(from, to);
  ASSERT_GT(before.size(), 8U);
  const core::WorldPosition middle = before[before.size() / 2];
  finder.avoid(middle);
  for (const core::WorldPosition& at : finder.find(from, to))
    EXPECT_GT(glm::length(way(middle, at)), PathFinder::kCellM);
}

TEST_F(Ways, EndAtTheNearestReachablePoint) {
  const core::WorldPosition from = dry(0, 0), to = dry(300, 0);
  PathFinder finder(query_, {.max_cells = 200});
  const auto points = finder.find(from, to);
  ASSERT_GE(points.size(), 2U);
  EXPECT_LT(glm::length(way(points.back(), to)), glm::length(way(from, to)));
  EXPECT_FALSE(finder.reaches(from, to));
  PathFinder none(query_, {.max_cells = 0});
  EXPECT_EQ(none.find(from, to).size(), 1U);
}

TEST_F(Ways, EndSoonFarFromTheOriginAndBeyondAllPositions) {
  Loaded endless = Loaded::shipped("endless");
  World query(endless.world, endless.registry);
  PathFinder finder(query, {.max_cells = 500});
  const double block_m = endless.world.block_size_m();
  const auto cells =
      static_cast<std::int64_t>((std::int64_t{1} << 31) * PathFinder::kCellM / block_m);
  for (const std::int64_t east : {cells, std::int64_t{INT32_MAX}, std::int64_t{INT32_MIN}}) {
    const core::WorldPosition from{core::moved({}, east, -east), {0, 0, 0}};
    const core::WorldPosition to{from.block, {20, 0, 20}};
    EXPECT_LE(finder.find(from, to).size(), 500U);
    EXPECT_LE(finder.find({}, to).size(), 500U);
    finder.avoid(to);
  }
  for (const double wrong : {1e300, -2e9, std::nan("")}) {
    const core::WorldPosition beyond{{0, 0}, {0, 0, wrong}};
    EXPECT_EQ(finder.find({}, beyond).size(), 1U);
    EXPECT_FALSE(finder.reaches(beyond, beyond));
    finder.avoid(beyond);
  }
}

TEST_F(Ways, GoAroundWaterIfSwimmingCostsMuch) {
  double swum[2] = {0, 0};
  int which = 0;
  for (const double cost : {1.0, 40.0}) {
    PathFinder finder(query_, {.swim_cost = cost});
    for (int k = 0; k < 6; ++k) {
      const auto points = finder.find(dry(70.0 * k, 0), dry(70.0 * k + 60, 200));
      for (const core::WorldPosition& at : points) {
        const auto ground = query_.ground(at);
        ASSERT_TRUE(ground);
        if (ground->water_depth_m > 0.9) swum[which] += PathFinder::kCellM;
      }
    }
    ++which;
  }
  EXPECT_GT(swum[0], 0);
  EXPECT_LT(swum[1], 0.5 * swum[0]);
}

TEST(WaysAtTheSeam, StopBeforeItAndAreFoundBesideIt) {
  const Loaded loaded = Loaded::shipped("endless");
  World query(loaded.world, loaded.registry);
  PathFinder finder(query, {.steepest_up = 100, .steepest_down = 100, .max_cells = 4000});
  const double size = loaded.world.block_size_m();
  const core::WorldPosition from{{INT32_MAX, 5}, {size - 40, 0, 20}};
  const core::WorldPosition across{{INT32_MIN, 5}, {20, 0, 20}};
  EXPECT_FALSE(finder.reaches(from, across));
  for (const core::WorldPosition& point : finder.find(from, across))
    EXPECT_GT(point.block.x, 0);
  const core::WorldPosition beside{{INT32_MAX, 5}, {size - 1, 0, 30}};
  const auto points = finder.find(from, beside);
  EXPECT_EQ(points.back().block, beside.block);
  EXPECT_EQ(points.back().local, beside.local);
  EXPECT_GT(points.size(), 18U);
}

}  // namespace
}  // namespace psygen::query
