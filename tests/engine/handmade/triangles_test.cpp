#include "engine/handmade/triangles.hpp"

#include <gmock/gmock.h>

#include <glm/geometric.hpp>

#include "engine/gltf/read_file.hpp"
#include "engine/handmade/texture_colours.hpp"
#include "tests/engine/handmade/shapes.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::handmade {
namespace {

using ::testing::HasSubstr;

gltf::Model model_of(const gltf::Sample& sample) {
  const TemporaryFolder folder;
  gltf::write_bytes(folder / "m.glb", sample.glb());
  return gltf::read_file(folder / "m.glb").value();
}

TEST(Triangles, StandOnTheirFootAndAreAsHighAsIsSaid) {
  gltf::Sample sample = ball(16, 24);
  sample.json["nodes"][0]["translation"] = gltf::list(100, 7, -30);
  const Triangles t =
      triangles_of(model_of(sample), {.name = {}, .file = {}, .size_m = 6, .sink_m = 0.5}).value();
  EXPECT_NEAR(t.box.min.y, -0.5, 1e-3);
  EXPECT_NEAR(t.box.max.y, 5.5, 1e-3);
  EXPECT_NEAR(t.box.min.x, -t.box.max.x, 1e-3);
  EXPECT_NEAR(t.box.min.z, -t.box.max.z, 1e-3);
  const Triangles twice =
      triangles_of(model_of(sample), {.name = {}, .file = {}, .scale = 2}).value();
  EXPECT_NEAR(twice.box.max.y, 4, 0.2);
}

TEST(Triangles, HaveTheColoursOfTheirMaterial) {
  const Triangles plain = triangles_of(model_of(ball(8, 8)), {}).value();
  for (const Vertex& v : plain.vertices)
    EXPECT_EQ(v.colour, (std::array<std::uint8_t, 3>{128, 255, 0}));
  // 0.5 · 1 and 0.125 · 51 / 255; MASK is how leaves are made.
  const Triangles masked = triangles_of(model_of(gltf::square()), {}).value();
  for (const Vertex& v : masked.vertices) {
    EXPECT_EQ(v.colour, (std::array<std::uint8_t, 3>{180, 0, 40}));
    EXPECT_EQ(v.leaf, 1);
  }
}

TEST(Triangles, KeepTheirFrontsWhereANodeMirrorsThem) {
  gltf::Sample sample = ball(8, 12);
  sample.json["nodes"][0]["scale"] = gltf::list(-1, 2, 1);
  const Triangles t = triangles_of(model_of(sample), {}).value();
  for (std::size_t i = 0; i < t.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return t.vertices[t.indices[i + k]]; };
    const glm::vec3 across =
        glm::cross(at(1).position - at(0).position, at(2).position - at(0).position);
    if (glm::length(across) > 1e-6F) {
      EXPECT_GT(glm::dot(across, at(0).normal + at(1).normal + at(2).normal), 0);
    }
  }
}

TEST(Triangles, RefuseWhatCannotStandInAWorld) {
  const auto error = [](const gltf::Sample& sample, const world::HandmadeModel& how) {
    const auto made = triangles_of(model_of(sample), how);
    return made ? std::string() : made.error().message;
  };
  EXPECT_THAT(error(ball(8, 8), {.name = {}, .file = {}, .scale = 1000}),
              HasSubstr("m large; 0.01 to 1000 m are allowed"));
  EXPECT_THAT(error(ball(8, 8), {.name = {}, .file = {}, .scale = 1e-4}), HasSubstr("m large"));
  gltf::Sample flat = gltf::square();
  flat.json["nodes"][0]["rotation"] = gltf::list(0.70710678, 0, 0, 0.70710678);
  EXPECT_THAT(error(flat, {.name = {}, .file = {}, .size_m = 3}), HasSubstr("flat"));
  EXPECT_EQ(error(flat, {.name = {}, .file = {}, .scale = 3}), "");
  gltf::Sample many = ball(64, 128);
  many.json["scenes"][0]["nodes"] = nlohmann::json::array();
  for (int i = 0; i < 200; ++i) {
    many.json["scenes"][0]["nodes"].push_back(i);
    if (i > 0) many.add("nodes", gltf::parsed(R"({"mesh": 0})"));
  }
  EXPECT_THAT(error(many, {}), HasSubstr("more than 1048576 vertices"));
}

TEST(TextureColours, AreMeansOfWhatEachVertexShows) {
  core::MeshData quad;
  quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  image::Image half = image::make_image(64, 64, 255, 255, 255, 255);
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 32; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        half.pixel(x, y)[c] = 0;
  }
  const auto colours = texture_colours(quad, half, 0);
  EXPECT_LT(colours[0].x, 0.45F);
  EXPECT_GT(colours[1].x, 0.6F);
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 32; ++x)
      half.pixel(x, y)[3] = 0;
  }
  for (const glm::vec3& c : texture_colours(quad, half, 0.5F))
    EXPECT_NEAR(c.x, 1, 1e-5);
  quad.uvs = {{-1e30F, 1e30F}, {7.5F, -3}, {1e9F, 0}, {0.25F, 0.25F}};
  for (const glm::vec3& c : texture_colours(quad, half, 0))
    EXPECT_TRUE(c.x >= 0 && c.x <= 1);
}

}  // namespace
}  // namespace psygen::handmade
