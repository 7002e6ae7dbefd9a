#include "engine/world/far_forms.hpp"

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

constexpr Form kSolids[] = {Form::kSpindleTrunk, Form::kSpindle, Form::kChunkTrunk, Form::kChunk,
                            Form::kSpire};

std::vector<glm::vec3> places_of(Form form, const FormMesh& mesh) {
  std::vector<glm::vec3> places;
  for (std::size_t i = 0; i < size_of(form).vertices; ++i)
    places.push_back(mesh.corners[i].position);
  return places;
}
std::span<const std::uint16_t> indices_of(Form form, const FormMesh& mesh) {
  return std::span(mesh.indices).first(std::size_t{3} * size_of(form).triangles);
}

TEST(FarForms, HaveTheSizesThatAreTold) {
  for (const Form form : kSolids) {
    FormMesh mesh;
    make_form(form, crown(), {}, {0.6F, 0.8F}, mesh);
    std::vector<bool> used(size_of(form).vertices);
    for (const std::uint16_t index : indices_of(form, mesh)) {
      ASSERT_LT(index, used.size());
      used[index] = true;
    }
    EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool b) { return b; }));
  }
}

TEST(FarForms, FaceOutwards) {
  for (const Form form : {Form::kSpindle, Form::kChunk, Form::kSpire}) {
    FormMesh mesh;
    make_form(form, crown(), {}, {-0.8F, 0.6F}, mesh);
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
      FormMesh mesh;
      make_form(form, crown(), {1, 0.9F}, turn, mesh);
      float highest = 0;
      for (const glm::vec3& place : places_of(form, mesh)) {
        highest = std::max(highest, place.y);
        EXPECT_LE(place.x * place.x + place.z * place.z, 4.001F);
      }
      EXPECT_FLOAT_EQ(highest, 6);
    }
  }
}

TEST(FarForms, StretchDownwardsAndSideways) {
  FormMesh mesh;
  make_form(Form::kSpire, crown(), {3, 0.5F}, {1, 0}, mesh);
  EXPECT_FLOAT_EQ(mesh.corners[1].position.y, 4);
  EXPECT_FLOAT_EQ(mesh.corners[1].position.x, 6);
}

TEST(FarForms, SheetsHaveTheAreasOfTheModelsThatTheyStandFor) {
  const Silhouette one{7.2F, 8};
  for (const float models : {1.0F, 3.0F}) {
    const Sheet sheet = sheet_of(crown(), one, models);
    Silhouette sum;
    constexpr int kTurns = 24;
    for (int k = 0; k < kTurns; ++k) {
      const double angle = 0.2617993878 * k;
      FormMesh mesh;
      make_sheet(crown(), sheet,
                 {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))}, {0, 0},
                 mesh);
      const Silhouette area =
          silhouette_of(places_of(Form::kSheet, mesh), indices_of(Form::kSheet, mesh));
      sum.side_m2 += area.side_m2 / kTurns;
      sum.plan_m2 += area.plan_m2 / kTurns;
    }
    EXPECT_NEAR(sum.plan_m2, models * one.plan_m2, 0.05F * models * one.plan_m2);
    EXPECT_NEAR(sum.side_m2, models * one.side_m2, 0.15F * models * one.side_m2);
  }
}

TEST(FarForms, SheetsOfVeryManyKeepTheirAreaFromAboveAndTheirHeight) {
  const Sheet sheet = sheet_of(crown(), {7.2F, 8}, 1000);
  EXPECT_NEAR(sheet.half_length_m * sheet.lean_m, 8000, 1);
  EXPECT_LT(sheet.half_length_m, 4 * sheet.lean_m);
  EXPECT_EQ(sheet.base_m, 0);
  EXPECT_EQ(sheet_of(crown(), {0, 0}, 3).half_length_m, 0);
}

TEST(FarForms, SheetsFollowTheGround) {
  FormMesh mesh;
  make_sheet(crown(), {5, 2, 0}, {1, 0}, {-3, 7}, mesh);
  EXPECT_FLOAT_EQ(mesh.corners[0].position.y, -3);
  EXPECT_FLOAT_EQ(mesh.corners[1].position.y, 7);
  EXPECT_FLOAT_EQ(mesh.corners[2].position.y, 8);
  EXPECT_FLOAT_EQ(mesh.corners[0].position.x, -5);
  EXPECT_FLOAT_EQ(mesh.corners[1].position.x, 5);
}

}  // namespace
}  // namespace psygen::world
