#include "engine/models/ground/water.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace psygen::models {
namespace {

// A river along +x, 8 m wide, 2 m deep, that falls by 1 m over 100 m.
RiverPiece straight() {
  RiverPiece river;
  river.body = 7;
  for (int i = 0; i <= 4; ++i) {
    RiverPoint p;
    p.at_m = {25.0 * i, 0};
    p.half_width_m = 4;
    p.surface_m = 30 - 0.25 * i;
    p.bed_m = p.surface_m - 2;
    p.bank_m = 6;
    p.speed_m_s = 1.2;
    p.fall = 0.01;
    river.points.push_back(p);
  }
  seal(river);
  return river;
}

// A square lake from 0 to 40 m, in one tile.
LakePiece square_lake() {
  LakePiece lake;
  lake.body = 5;
  lake.level_m = 20;
  lake.depth_m = 3;
  lake.shore_m = 6;
  lake.low_m = {-16, -16};
  lake.high_m = {56, 56};
  const glm::dvec2 corners[] = {{0, 0}, {40, 0}, {40, 40}, {0, 40}};
  const glm::dvec2 out[] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  for (int i = 0; i < 4; ++i)
    lake.segments.push_back(
        {corners[i], corners[(i + 1) % 4], out[(i + 3) % 4] + out[i], out[i] + out[(i + 1) % 4]});
  seal(lake);
  return lake;
}

TEST(RiverPiece, HasAParabolicBedAndBanksThatMeetTheGround) {
  const RiverPiece river = straight();
  EXPECT_EQ(shaped_by(river, 40, {50, 0}), 27.5);
  EXPECT_EQ(shaped_by(river, 40, {50, 2}), 29.5 - 2 * 0.75);
  EXPECT_NEAR(shaped_by(river, 40, {50, -4}), 29.5, 1e-12);
  double before_m = 0;
  for (double across = 0; across <= 12; across += 0.25) {
    const double height_m = shaped_by(river, 40, {50, across});
    EXPECT_GE(height_m, before_m);
    EXPECT_LT(height_m - (before_m == 0 ? height_m : before_m), 0.7);
    before_m = height_m;
  }
  EXPECT_EQ(shaped_by(river, 40, {50, 10}), 40);
  EXPECT_EQ(shaped_by(river, 40, {50, 300}), 40);
}

TEST(RiverPiece, OnlyDigs) {
  const RiverPiece river = straight();
  for (double across = -12; across <= 12; across += 0.5) {
    for (const double ground_m : {0.0, 25.0, 28.0, 29.6, 33.0})
      EXPECT_LE(shaped_by(river, ground_m, {50, across}), ground_m);
  }
}

TEST(RiverPiece, FlowsFastestInTheMiddleAndDownItsSlope) {
  const RiverPiece river = straight();
  const auto middle = surface_of(river, {30, 0}), border = surface_of(river, {30, 4});
  ASSERT_TRUE(middle && border);
  EXPECT_NEAR(middle->flow_m_s.x, 1.5, 1e-12);
  EXPECT_EQ(middle->flow_m_s.y, 0);
  EXPECT_NEAR(border->flow_m_s.x, 0, 1e-12);
  EXPECT_NEAR(middle->surface_m, 29.7, 1e-12);
  EXPECT_EQ(middle->slope, glm::dvec2(-0.01, 0));
  EXPECT_EQ(middle->body, 7U);
  EXPECT_TRUE(middle->is_river());
  EXPECT_EQ(middle->widths, 0);
  EXPECT_EQ(border->widths, 0.5);
  EXPECT_TRUE(surface_of(river, {30, 5.9}));
  EXPECT_FALSE(surface_of(river, {30, 6.1}));
}

TEST(RiverPiece, LeavesPlacesToNearerSegmentsOfOtherPieces) {
  RiverPiece river = straight();
  river.near.push_back({{0, 6}, {100, 6}, false});
  seal(river);
  EXPECT_TRUE(surface_of(river, {50, 2.9}));
  EXPECT_TRUE(surface_of(river, {50, 3})) << "equally near, but this piece is upstream";
  EXPECT_FALSE(surface_of(river, {50, 3.1}));
  EXPECT_EQ(shaped_by(river, 40, {50, 3.1}), 40);
  river.near[0].is_earlier = true;
  EXPECT_FALSE(surface_of(river, {50, 3}));
}

TEST(LakePiece, HasALevelABedAndAShore) {
  const LakePiece lake = square_lake();
  for (const glm::dvec2 at : {glm::dvec2(20, 20), glm::dvec2(7, 20), glm::dvec2(33, 33)})
    EXPECT_EQ(shaped_by(lake, 50, at), 17) << at.x;
  EXPECT_NEAR(shaped_by(lake, 50, {20, 0}), 20, 1e-12);
  EXPECT_NEAR(shaped_by(lake, 50, {20, 3}), 20 - 3 * 0.75, 1e-12);
  EXPECT_GT(shaped_by(lake, 50, {20, -3}), 25);
  EXPECT_EQ(shaped_by(lake, 50, {20, -6}), 50);
  EXPECT_EQ(shaped_by(lake, 10, {20, 20}), 10) << "deeper ground stays";
  EXPECT_NEAR(shaped_by(lake, 10, {20, -1e-6}), 20, 1e-4) << "a dam holds the water";
  EXPECT_TRUE(is_in_bed(lake, {1, 1}));
  EXPECT_FALSE(is_in_bed(lake, {-1, -1})) << "at a corner";
}

TEST(LakePiece, OwnsItsTileWithoutTheUpperSides) {
  LakePiece lake = square_lake();
  lake.segments.clear();
  lake.inside = true;
  lake.low_m = {0, 0}, lake.high_m = {8, 8};
  EXPECT_EQ(shaped_by(lake, 50, {0, 0}), 17);
  EXPECT_EQ(shaped_by(lake, 50, {8, 0}), 50);
  EXPECT_EQ(shaped_by(lake, 50, {0, 8}), 50);
  EXPECT_EQ(shaped_by(lake, 50, {-1e-9, 0}), 50);
}

TEST(BodySurface, TheNearerThenTheLowerThenTheSmallerNameOwnsAPlace) {
  const BodySurface a{.surface_m = 5, .body = 3, .widths = 0.2};
  EXPECT_TRUE(a.owns_before({.surface_m = 1, .body = 1, .widths = 0.3}));
  EXPECT_TRUE(a.owns_before({.surface_m = 6, .body = 1, .widths = 0.2}));
  EXPECT_TRUE(a.owns_before({.surface_m = 5, .body = 4, .widths = 0.2}));
  EXPECT_FALSE(a.owns_before({.surface_m = 5, .body = 2, .widths = 0.2}));
}

TEST(WaterContent, DependsOnEveryNumber) {
  const std::uint64_t river = content_of(straight()), lake = content_of(square_lake());
  const auto changed_river = [&](const auto& change) {
    RiverPiece other = straight();
    change(other);
    return content_of(other) != river;
  };
  EXPECT_TRUE(changed_river([](RiverPiece& r) { r.body = 8; }));
  EXPECT_TRUE(changed_river([](RiverPiece& r) { r.origin.local.x = 1; }));
  EXPECT_TRUE(changed_river([](RiverPiece& r) { r.edge_m = 1; }));
  EXPECT_TRUE(changed_river([](RiverPiece& r) { r.near.push_back({}); }));
  for (const auto member :
       {&RiverPoint::half_width_m, &RiverPoint::surface_m, &RiverPoint::bed_m, &RiverPoint::bank_m,
        &RiverPoint::speed_m_s, &RiverPoint::fall, &RiverPoint::foam})
    EXPECT_TRUE(changed_river([&](RiverPiece& r) { r.points[2].*member += 0.5; }));
  const auto changed_lake = [&](const auto& change) {
    LakePiece other = square_lake();
    change(other);
    return content_of(other) != lake;
  };
  for (const auto member :
       {&LakePiece::level_m, &LakePiece::depth_m, &LakePiece::shore_m, &LakePiece::edge_m})
    EXPECT_TRUE(changed_lake([&](LakePiece& l) { l.*member += 0.5; }));
  EXPECT_TRUE(changed_lake([](LakePiece& l) { l.inside = true; }));
  EXPECT_TRUE(changed_lake([](LakePiece& l) { l.segments.pop_back(); }));
}

}  // namespace
}  // namespace psygen::models
