#include "engine/world/far/proxy_shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace psygen::world {
namespace {

// A crown of 4 m between 2 and 6 m height, 2 m wide to all sides.
Outline crown() {
  Outline o;
  o.leafy = true;
  o.top.position = {0, 6, 0};
  o.bottom.position = {0, 2, 0};
  o.bottom.normal = {0, -1, 0};
  const glm::vec3 sides[4] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
  for (std::size_t i = 0; i < 4; ++i) {
    o.ring[i].position = 2.0F * sides[i] + glm::vec3(0, 4, 0);
    o.ring[i].normal = sides[i];
  }
  o.foot.position = {0, -0.3F, 0};
  o.trunk_radius = 0.2F;
  return o;
}

constexpr Form kSolids[] = {Form::kSpindleTrunk, Form::kSpindle, Form::kChunk};
constexpr Form kBillboards[] = {Form::kKiteTrunk, Form::kKite, Form::kTent};

// As a viewer who looks in this unit direction sees it.
std::vector<glm::vec3> places_of(Form form, const ProxyMesh& mesh, glm::vec2 ahead = {0, -1}) {
  std::vector<glm::vec3> places;
  const glm::vec2 right{-ahead.y, ahead.x};
  for (std::size_t i = 0; i < size_of(form).vertices; ++i) {
    glm::vec3 place = mesh.corners[i].position;
    if (i >= size_of(form).solid_vertices) {
      const glm::vec2 aside = mesh.aside[i].x * right + mesh.aside[i].y * ahead;
      place += glm::vec3(aside.x, 0, aside.y);
    }
    places.push_back(place);
  }
  return places;
}
std::span<const std::uint16_t> indices_of(Form form, const ProxyMesh& mesh) {
  return std::span(mesh.indices).first(std::size_t{3} * size_of(form).triangles);
}

ProxyMesh form_of_crown(Form form) {
  ProxyMesh mesh;
  if (is_billboard(form)) {
    make_billboard(form, crown(), billboard_of(form, crown(), {7.2F, 8}, 1), mesh);
  } else {
    make_proxy(form, crown(), 1, {0.6F, 0.8F}, mesh);
  }
  return mesh;
}

TEST(FarForms, HaveTheirStatedSizes) {
  for (const Form form : {Form::kSpindleTrunk, Form::kSpindle, Form::kChunk, Form::kKiteTrunk,
                          Form::kKite, Form::kTent}) {
    const ProxyMesh mesh = form_of_crown(form);
    std::vector<bool> used(size_of(form).vertices);
    for (const std::uint16_t index : indices_of(form, mesh)) {
      ASSERT_LT(index, used.size());
      used[index] = true;
    }
    EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool b) { return b; }));
  }
}

TEST(FarForms, FaceOutwards) {
  for (const Form form : {Form::kSpindle, Form::kChunk}) {
    ProxyMesh mesh;
    make_proxy(form, crown(), 1, {-0.8F, 0.6F}, mesh);
    const auto indices = indices_of(form, mesh);
    const std::vector<glm::vec3> places = places_of(form, mesh);
    glm::vec3 middle(0.0F);
    for (const glm::vec3& place : places)
      middle += place / static_cast<float>(places.size());
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const glm::vec3 a = places[indices[i]], b = places[indices[i + 1]],
                      c = places[indices[i + 2]];
      EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c - 3.0F * middle), 0);
    }
  }
}

TEST(FarForms, EndAtTheTopAndTurnAboutTheAxis) {
  for (const Form form : kSolids) {
    for (const glm::vec2 turn : {glm::vec2(1, 0), {0, 1}, {-0.6F, 0.8F}}) {
      ProxyMesh mesh;
      make_proxy(form, crown(), 1, turn, mesh);
      float highest = 0;
      for (const glm::vec3& place : places_of(form, mesh)) {
        highest = std::max(highest, place.y);
        EXPECT_LE(place.x * place.x + place.z * place.z, 4.001F);
      }
      EXPECT_FLOAT_EQ(highest, 6);
    }
  }
}

TEST(FarForms, HaveTheRequestedWidth) {
  ProxyMesh mesh;
  make_proxy(Form::kChunk, crown(), 3, {1, 0}, mesh);
  EXPECT_FLOAT_EQ(mesh.corners[2].position.y, 2);
  EXPECT_FLOAT_EQ(mesh.corners[0].position.x, 6);
  make_proxy(Form::kSpindle, crown(), 0.5F, {1, 0}, mesh);
  EXPECT_FLOAT_EQ(mesh.corners[0].position.y, 6);
  EXPECT_FLOAT_EQ(mesh.corners[1].position.x, 1);
}

float area_of(std::span<const glm::vec3> places, const glm::vec3& from) {
  const glm::vec3 twice = glm::cross(places[1] - places[0], places[2] - places[0]);
  return 0.5F * std::abs(glm::dot(twice, from));
}

// The full area from every side, and half of it from above.
TEST(FarForms, BillboardsHaveTheAreasOfTheirModels) {
  const Silhouette one{7.2F, 8};
  for (const float models : {1.0F, 3.0F}) {
    const Billboard billboard = billboard_of(Form::kTent, crown(), one, models);
    ProxyMesh mesh;
    make_billboard(Form::kTent, crown(), billboard, mesh);
    for (const glm::vec2 ahead : {glm::vec2(0, -1), {1, 0}, {-0.6F, 0.8F}}) {
      const std::vector<glm::vec3> places = places_of(Form::kTent, mesh, ahead);
      EXPECT_NEAR(area_of(places, {ahead.x, 0, ahead.y}), models * one.side_m2, 1e-3F);
      EXPECT_NEAR(area_of(places, {0, 1, 0}), 0.5F * models * one.plan_m2, 1e-3F);
      // Its upper corner is behind the axis, so that it is visible from above too.
      EXPECT_GT(glm::dot(glm::vec2(places[2].x, places[2].z), ahead), 0);
    }
  }
}

TEST(FarForms, KitesAreAsWideAndHighAsTheCrownsWhereTheirAreaAllowsIt) {
  const Silhouette full{8, 12};  // the crown's, which is a double cone
  const Billboard billboard = billboard_of(Form::kKite, crown(), full, 1);
  EXPECT_FLOAT_EQ(billboard.half_width_m, 2);
  EXPECT_FLOAT_EQ(billboard.base_m, 2);
  ProxyMesh mesh;
  make_billboard(Form::kKite, crown(), billboard, mesh);
  EXPECT_FLOAT_EQ(mesh.corners[0].position.y, 4);
  EXPECT_FLOAT_EQ(mesh.corners[2].position.y, 6);
  EXPECT_FLOAT_EQ(mesh.corners[3].position.y, 2);
}

// Unlike flat forms, crowns have parts that face away from the light or are shaded by others.
TEST(FarForms, BillboardsOfLeavesAreDarkerThanTheirCorners) {
  Outline leafy = crown(), stone = crown();
  for (Outline* o : {&leafy, &stone}) {
    for (Corner* c : {&o->top, &o->bottom, &o->ring[0], &o->ring[1], &o->ring[2], &o->ring[3]})
      c->material = o == &leafy ? kLeaf : 0;
  }
  ProxyMesh mesh;
  make_billboard(Form::kTent, leafy, billboard_of(Form::kTent, leafy, {7, 8}, 1), mesh);
  EXPECT_LT(mesh.corners[2].ambient, 0.99F);
  make_billboard(Form::kTent, stone, billboard_of(Form::kTent, stone, {7, 8}, 1), mesh);
  EXPECT_FLOAT_EQ(mesh.corners[2].ambient, 1);
}

TEST(FarForms, TrunksReachFromTheGroundIntoTheCrown) {
  for (const Form form : {Form::kSpindleTrunk, Form::kKiteTrunk}) {
    const ProxyMesh mesh = form_of_crown(form);
    const std::vector<glm::vec3> places = places_of(form, mesh);
    const std::size_t foot = places.size() - 3;
    EXPECT_FLOAT_EQ(places[foot].y, -0.3F);
    EXPECT_FLOAT_EQ(glm::distance(places[foot], places[foot + 1]), 0.4F);
    EXPECT_FLOAT_EQ(places[foot + 2].y, 4);
  }
}

TEST(FarForms, BillboardsOfVeryManyModelsAreNotLongWalls) {
  const Billboard billboard = billboard_of(Form::kTent, crown(), {7.2F, 8}, 1000);
  EXPECT_NEAR(billboard.half_width_m * billboard.lean_m, 4000, 1);
  EXPECT_LE(billboard.half_width_m, 8.01F * billboard.lean_m);
  EXPECT_EQ(billboard.base_m, 0);
  EXPECT_EQ(billboard_of(Form::kTent, crown(), {0, 0}, 3).half_width_m, 0);
}

// Bare branches extend far and cover little: a narrow billboard from the base up, not in the air.
TEST(FarForms, BillboardsOfSparseThingsStandOnTheGround) {
  Outline bare = crown();
  bare.bottom.position.y = 0;
  bare.leafy = false;
  const Billboard billboard = billboard_of(Form::kTent, bare, {1.8F, 3}, 1);
  EXPECT_FLOAT_EQ(billboard.base_m, 0);
  EXPECT_FLOAT_EQ(billboard.half_width_m, 0.3F);
  // A wall, which covers no ground, is still visible.
  EXPECT_FLOAT_EQ(billboard_of(Form::kTent, bare, {6, 0}, 1).half_width_m, 1);
}

TEST(FarForms, KitesOmitTheAreaThatTrunksCover) {
  const Billboard alone = billboard_of(Form::kKite, crown(), {8, 12}, 1);
  const Billboard with = billboard_of(Form::kKiteTrunk, crown(), {8, 12}, 1);
  const auto area = [](const Billboard& b) { return b.half_width_m * (6 - b.base_m); };
  // Half of the triangle's height is in the crown, so three quarters of it are visible.
  EXPECT_NEAR(area(alone) - area(with), 0.75F * 0.2F * 4, 1e-3F);
}

TEST(FarForms, CrownsOfBillboardsStayAboveTheGround) {
  for (const float models : {1.0F, 4.0F, 40.0F, 400.0F}) {
    ProxyMesh mesh;
    for (const Form form : kBillboards) {
      make_billboard(form, crown(), billboard_of(form, crown(), {12, 8}, models), mesh);
      for (std::size_t i = 0; i < std::min<std::size_t>(size_of(form).vertices, 4); ++i) {
        EXPECT_GE(mesh.corners[i].position.y, 0);
        EXPECT_LE(mesh.corners[i].position.y, 6);
      }
    }
  }
}

}  // namespace
}  // namespace psygen::world
