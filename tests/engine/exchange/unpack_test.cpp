#include "engine/exchange/unpack.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <new>
#include <stdexcept>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/ground_blends.hpp"
#include "tests/engine/exchange/synthesised.hpp"

namespace psygen::exchange {
namespace {

std::size_t triangles_of(const Object& object) {
  std::size_t count = 0;
  for (const Part& part : object.parts)
    count += part.indices.size() / 3;
  return count;
}

TEST(Unpack, KeepsEveryTriangleOfEveryLevel) {
  for (const char* name : {"rock", "tree"}) {
    const models::ModelType& type = standard_type(name);
    const models::Parameters p = models::default_parameters(type);
    for (int level = 0; level < type.level_count(); ++level)
      EXPECT_EQ(triangles_of(synthesised(name, level)), type.mesh_size(p, level).triangle_count());
  }
}

TEST(Unpack, LeavesTheSkirtsOfTerrainOut) {
  const models::ModelType& type = standard_type("terrain");
  const models::Parameters p = models::default_parameters(type);
  for (int level = 0; level < type.level_count(); ++level)
    EXPECT_EQ(triangles_of(synthesised("terrain", level)),
              models::terrain_surface_triangles(p, level));
  const Object ground = synthesised("terrain", 0);
  ASSERT_EQ(ground.parts.size(), 1u);
  EXPECT_EQ(ground.parts[0].positions.size(), 64u * 64);
  EXPECT_EQ(ground.parts[0].material, kGround);
}

TEST(Unpack, TerrainVerticesLieOnTheGround) {
  const models::ModelType& type = standard_type("terrain");
  const models::Parameters p = models::default_parameters(type);
  const Object ground = synthesised("terrain", 0);
  for (const glm::vec3& v : ground.parts[0].positions) {
    const double height_m =
        models::ground_height_m(p, {0, 0}, static_cast<double>(v.x), static_cast<double>(v.z));
    EXPECT_NEAR(static_cast<double>(v.y), height_m, 1e-3);
  }
}

TEST(Unpack, PartsAreSoundAndFaceOutwards) {
  for (const char* name : {"terrain", "rock", "tree"}) {
    for (const Part& part : synthesised(name, 0).parts) {
      ASSERT_EQ(part.positions.size(), part.normals.size());
      ASSERT_EQ(part.positions.size(), part.colours.size());
      std::size_t agreeing = 0;
      for (std::size_t i = 0; i < part.indices.size(); i += 3) {
        const glm::vec3 &a = part.positions[part.indices[i]],
                        &b = part.positions[part.indices[i + 1]],
                        &c = part.positions[part.indices[i + 2]];
        agreeing += glm::dot(glm::cross(b - a, c - a), part.normals[part.indices[i]]) > 0 ? 1 : 0;
      }
      // Leaves have the normals of their crown, not of their triangles.
      if (part.material != kLeaf) {
        EXPECT_GT(static_cast<double>(agreeing), 0.9 * static_cast<double>(part.indices.size() / 3))
            << name;
      }
      for (const glm::vec3& n : part.normals)
        EXPECT_NEAR(glm::length(n), 1.0F, 1e-3F);
      for (const glm::vec3& c : part.colours)
        EXPECT_TRUE(c.x >= 0 && c.x <= 1 && c.y >= 0 && c.y <= 1 && c.z >= 0 && c.z <= 1);
    }
  }
}

TEST(Unpack, SeparatesBarkFromLeaves) {
  const Object tree = synthesised("tree", 0);
  ASSERT_EQ(tree.parts.size(), 2u);
  EXPECT_NE(tree.parts[0].material, tree.parts[1].material);
}

TEST(Unpack, AnIndexOutOfRangeIsRejected) {
  const models::ModelType& type = standard_type("tree");
  const models::Parameters p = models::default_parameters(type);
  const auto mesh = synthesis::HeapDestination::make(type, p, 0);
  ASSERT_TRUE(synthesis::synthesise_guarded(type, p, 0, mesh->view()).ok);
  mesh->view().indices[4] = 65535;
  const auto object = unpack(type, p, 0, mesh->size(), mesh->view(), world::Palette{});
  ASSERT_FALSE(object);
  EXPECT_NE(object.error().message.find("65535"), std::string::npos);
}

// Throws the given exception when its mesh is unpacked, not earlier.
class LateThrower final : public models::ModelType {
 public:
  explicit LateThrower(std::function<void()> thrower, std::uint32_t shared = 0)
      : thrower_(std::move(thrower)), shared_(shared) {}
  std::string_view name() const override { return "late"; }
  std::string_view doc() const override { return "throws"; }
  std::span<const models::ParameterSpec> parameters() const override { return {}; }
  int level_count() const override { return 1; }
  double level_error_m(const models::Parameters&, int) const override { return 0; }
  core::Bounds bounds(const models::Parameters&) const override {
    if (shared_ == 0) thrower_();
    return {};
  }
  models::MeshSize mesh_size(const models::Parameters&, int) const override {
    return {3, 3, shared_};
  }
  double complexity(const models::Parameters&, int) const override { return 1; }
  double log2_cost(const models::Parameters&) const override { return 0; }
  core::Bounds synthesise(const models::Parameters&, int, const models::MeshView&) const override {
    return {};
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override { thrower_(); }

 private:
  std::function<void()> thrower_;
  std::uint32_t shared_;
};

TEST(Unpack, ATypeThatThrowsIsAFailure) {
  const auto error_of = [](const LateThrower& type) {
    std::vector<std::byte> vertices(3 * sizeof(core::ModelVertex));
    std::vector<std::uint16_t> indices(3);
    const auto object = unpack(type, {}, 0, type.mesh_size({}, 0), {vertices, indices}, {});
    return object ? core::Error{} : object.error();
  };
  for (const std::uint32_t shared : {0u, 9u}) {
    const auto any = error_of(LateThrower([] { throw std::runtime_error("no box"); }, shared));
    EXPECT_EQ(any.code, core::ErrorCode::kSynthesisFailed);
    EXPECT_NE(any.message.find("late level 0"), std::string::npos);
    EXPECT_NE(any.message.find("no box"), std::string::npos);
    EXPECT_EQ(error_of(LateThrower([] { throw 7; }, shared)).code,
              core::ErrorCode::kSynthesisFailed);
    EXPECT_EQ(error_of(LateThrower([] { throw std::bad_alloc(); }, shared)).code,
              core::ErrorCode::kOutOfMemory);
  }
}

}  // namespace

namespace {

const glm::vec3 kFlat{0, 1, 0};
const glm::vec3 kSteep = glm::normalize(glm::vec3(1, 0.5F, 0));

float distance(const glm::vec3& a, const glm::vec3& b) {
  return glm::length(a - b) / glm::length(b);
}

TEST(GroundColour, FollowsHeightAndSlope) {
  world::Palette palette;
  palette.snow_start_m = 200;
  palette.sand_end_m = 0;
  const glm::vec2 at{100, 300};
  EXPECT_LT(distance(ground_albedo(palette, 400, kFlat, at, 7), palette.snow), 0.15F);
  EXPECT_LT(distance(ground_albedo(palette, -50, kFlat, at, 7), palette.sand), 0.15F);
  EXPECT_LT(distance(ground_albedo(palette, 150, kFlat, at, 7), palette.dry), 0.15F);
  EXPECT_LT(distance(ground_albedo(palette, 400, kSteep, at, 7), palette.rock), 0.15F);
}

TEST(GroundColour, IsContinuousAcrossBlocksAndWhereThePatternRepeats) {
  const world::Palette palette;
  const double size_m = 63;
  for (const core::BlockCoord block :
       {core::BlockCoord{0, 0}, core::BlockCoord{-1, 500}, core::BlockCoord{32, 32},
        core::BlockCoord{INT32_MAX - 1, 3}}) {
    const glm::vec2 here = world::pattern_place(block, size_m, {63, 10});
    const glm::vec2 there = world::pattern_place({block.x + 1, block.z}, size_m, {0, 10});
    EXPECT_LT(distance(ground_albedo(palette, 20, kFlat, here, 9),
                       ground_albedo(palette, 20, kFlat, there, 9)),
              1e-3F);
  }
  EXPECT_LT(distance(ground_albedo(palette, 20, kFlat, {2047.999F, 5}, 9),
                     ground_albedo(palette, 20, kFlat, {0, 5}, 9)),
            1e-3F);
}

TEST(GroundColour, NeverLeavesTheRangeOfColours) {
  const world::Palette palette;
  for (int i = 0; i < 2000; ++i) {
    const auto t = static_cast<float>(i);
    const glm::vec3 n = glm::normalize(glm::vec3(0.01F * t - 10, 1, 0.5F));
    const glm::vec3 c =
        ground_albedo(palette, t - 500, n, {t, 2 * t}, static_cast<std::uint16_t>(i));
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(c[k], 0.0F);
      EXPECT_LE(c[k], 1.0F);
    }
  }
}

}  // namespace

}  // namespace psygen::exchange
