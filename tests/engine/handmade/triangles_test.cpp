#include "engine/handmade/triangles.hpp"

#include <gmock/gmock.h>

#include <glm/geometric.hpp>

#include "engine/gltf/read_file.hpp"
#include "engine/handmade/alpha_cutout.hpp"
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

TEST(Triangles, StandOnTheirBasePointAndHaveTheirStatedHeight) {
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

double area_of(const core::MeshData& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return mesh.positions[mesh.indices[i + k]]; };
    area += static_cast<double>(glm::length(glm::cross(at(1) - at(0), at(2) - at(0)))) / 2;
  }
  return area;
}
double share_drawn(const image::Image& image) {
  std::size_t drawn = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    drawn += image.rgba[i] >= 128;
  return 4.0 * static_cast<double>(drawn) / static_cast<double>(image.rgba.size());
}
// A card of 1 m².
core::MeshData card() {
  core::MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

TEST(CutOut, KeepsAreaAndFrontOfTheDrawnParts) {
  const image::Image leaves = leaf_picture();
  const core::MeshData cut = alpha_cutout(card(), leaves, 1, 0.5F, kMaxCutDepth);
  EXPECT_NEAR(area_of(cut), share_drawn(leaves), 0.15 * share_drawn(leaves));
  ASSERT_TRUE(core::check(cut));
  double outside = 0;
  for (std::size_t i = 0; i < cut.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return cut.positions[cut.indices[i + k]]; };
    const float twice = glm::cross(at(1) - at(0), at(2) - at(0)).z;
    EXPECT_GE(twice, 0);
    const glm::vec3 middle = (at(0) + at(1) + at(2)) / 3.0F;
    const bool drawn = leaves.pixel(static_cast<std::uint32_t>(64 * middle.x),
                                    static_cast<std::uint32_t>(64 * (1 - middle.y)))[3] > 0;
    outside += drawn ? 0.0 : static_cast<double>(twice) / 2;
  }
  EXPECT_LT(outside, 0.25 * area_of(cut)) << "a leaf is not three steps large";
}

// Needles are finer than the cuts: the card keeps the area that they cover.
TEST(CutOut, KeepsTheAreaOfDetailsFinerThanTheCuts) {
  image::Image needles = image::make_image(256, 256, 0, 90, 0, 0);
  for (std::uint32_t y = 0; y < 256; ++y)
    for (std::uint32_t x = 0; x < 256; ++x)
      if ((x + 3 * y) % 20 < 6 && (x - 128) * (x - 128) + (y - 128) * (y - 128) < 110 * 110)
        needles.pixel(x, y)[3] = 255;
  const double drawn = share_drawn(needles);
  for (int depth = 1; depth <= kMaxCutDepth; ++depth)
    EXPECT_NEAR(area_of(alpha_cutout(card(), needles, 1, 0.5F, depth)), drawn, 0.35 * drawn)
        << depth;
}

TEST(CutOut, OfAUniformImageKeepsAllOrNothing) {
  const core::MeshData whole =
      alpha_cutout(card(), image::make_image(8, 8, 1, 2, 3, 255), 1, 0.5F, kMaxCutDepth);
  EXPECT_EQ(whole.indices.size(), 6U) << "no more triangles than it had";
  EXPECT_EQ(whole.positions.size(), 4U);
  const image::Image half = image::make_image(8, 8, 1, 2, 3, 128);
  EXPECT_TRUE(alpha_cutout(card(), half, 0.5F, 0.5F, kMaxCutDepth).indices.empty())
      << "the material is half as opaque";
  EXPECT_EQ(cut_depth(100), kMaxCutDepth);
  EXPECT_EQ(cut_depth(1 << 20), 0);
}

TEST(Triangles, OfCardsHaveTheColourOfTheirLeavesAlone) {
  const TemporaryFolder folder;
  write_card_tree(folder / "tree.glb");
  const Triangles t = triangles_of(gltf::read_file(folder / "tree.glb").value(), {}).value();
  std::size_t leaves = 0;
  for (const Vertex& v : t.vertices) {
    if (v.leaf == 0) continue;
    ++leaves;
    ASSERT_GT(v.colour[1], v.colour[0]) << "green, not what is left out";
    ASSERT_GT(v.colour[1], v.colour[2]);
  }
  EXPECT_GT(leaves, 160U * 8);
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

TEST(Triangles, RejectModelsThatCannotStandInAWorld) {
  const auto error = [](const gltf::Sample& sample, const world::HandmadeModel& how) {
    const auto made = triangles_of(model_of(sample), how);
    return made ? std::string() : made.error().message;
  };
  EXPECT_THAT(error(ball(8, 8), {.name = {}, .file = {}, .scale = 1000}),
              HasSubstr("m; allowed: 0.01 to 1000 m"));
  EXPECT_THAT(error(ball(8, 8), {.name = {}, .file = {}, .scale = 1e-4}),
              HasSubstr("its size would be"));
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

TEST(TextureColours, AreMeansAroundEachVertex) {
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
