#include "engine/handmade/handmade_type.hpp"

#include <gtest/gtest.h>

#include "engine/gltf/read_file.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/query/objects.hpp"
#include "tests/engine/handmade/shapes.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::handmade {
namespace {

std::unique_ptr<models::ModelType> type_of(const world::HandmadeModel& how) {
  const TemporaryFolder folder;
  gltf::write_bytes(folder / "m.glb", ball(24, 40).glb());
  const auto shape = shape_of(*gltf::read_file(folder / "m.glb"), how);
  return make_handmade_type("ball", "a ball", shape.value());
}

models::Parameters parameters(double scale, double turn_deg) {
  models::Parameters p;
  p.set_real(0, scale);
  p.set_real(1, turn_deg);
  return p;
}

struct Made {
  std::vector<std::byte> vertices;
  std::vector<std::uint16_t> indices;
  core::Bounds tight;
};

Made made(const models::ModelType& type, const models::Parameters& p, int level) {
  const models::MeshSize size = type.mesh_size(p, level);
  Made m{std::vector<std::byte>(size.vertex_count * sizeof(core::ModelVertex)),
         std::vector<std::uint16_t>(size.index_count),
         {}};
  m.tight = type.synthesise(p, level, {m.vertices, m.indices});
  return m;
}

TEST(HandmadeType, StaysInItsBoundsAtEveryLevelTurnAndScale) {
  const auto type = type_of({.name = {}, .file = {}, .size_m = 3, .sink_m = 0.25});
  EXPECT_GE(type->level_count(), 3);
  for (const double turn : {0.0, 33.0, 90.0, 271.5, 360.0}) {
    for (const double scale : {0.01, 1.0, 100.0}) {
      const models::Parameters p = parameters(scale, turn);
      ASSERT_TRUE(models::validate(*type, p).has_value());
      const core::Bounds box = type->bounds(p);
      for (int level = 0; level < type->level_count(); ++level) {
        const Made m = made(*type, p, level);
        for (int i = 0; i < 3; ++i) {
          EXPECT_GE(m.tight.min[i], box.min[i]);
          EXPECT_LE(m.tight.max[i], box.max[i]);
          EXPECT_LT(m.tight.min[i], m.tight.max[i]);
        }
        for (const std::uint16_t i : m.indices)
          EXPECT_LT(i, type->mesh_size(p, level).vertex_count);
      }
      EXPECT_NEAR(box.max.y, 2.75 * scale, 1e-3 * scale);
    }
  }
}

TEST(HandmadeType, GivesTheSameBytesEveryTime) {
  const auto a = type_of({}), b = type_of({});
  const models::Parameters p = parameters(1.3, 77);
  EXPECT_EQ(made(*a, p, 0).vertices, made(*b, p, 0).vertices);
  EXPECT_EQ(a->identity(), b->identity());
  EXPECT_NE(a->identity(), type_of({.name = {}, .file = {}, .size_m = 2.5})->identity());
  EXPECT_NE(a->identity(), type_of({.name = {}, .file = {}, .levels = 2})->identity());
  EXPECT_NE(a->identity(), type_of({.name = {}, .file = {}, .collider = "none"})->identity());
}

// From +Z towards +X.
TEST(HandmadeType, TurnsAboutTheVerticalAxis) {
  const auto type = type_of({});
  const core::Bounds box = type->bounds(parameters(1, 0));
  const Made straight = made(*type, parameters(1, 0), 0);
  const Made turned = made(*type, parameters(1, 90), 0);
  const auto before = core::vertices_of<core::ModelVertex>(straight.vertices);
  const auto after = core::vertices_of<core::ModelVertex>(turned.vertices);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const glm::vec3 p = models::unpack_position(before[i], box);
    const glm::vec3 q = models::unpack_position(after[i], box);
    EXPECT_NEAR(q.x, p.z, 1e-3);
    EXPECT_NEAR(q.y, p.y, 1e-3);
    EXPECT_NEAR(q.z, -p.x, 1e-3);
  }
}

TEST(HandmadeType, HasTheColliderOfItsFile) {
  for (const auto kind : world::kHandmadeColliders) {
    const auto type = type_of({.name = {}, .file = {}, .collider = std::string(kind)});
    const models::Parameters p = parameters(2, 30);
    const models::Collider collider = type->collider(p);
    ASSERT_EQ(collider.empty(), kind == "none") << kind;
    if (collider.empty()) continue;
    EXPECT_TRUE(query::Objects::make_shape(collider).has_value()) << kind;
    const core::Bounds box = type->bounds(p), solid = models::bounds_of(collider.shapes[0]);
    for (const int i : {0, 2}) {
      EXPECT_GE(solid.min[i], box.min[i]) << kind;
      EXPECT_LE(solid.max[i], box.max[i]) << kind;
    }
    EXPECT_NEAR(solid.max.y, box.max.y, 0.2) << kind;
  }
}

}  // namespace
}  // namespace psygen::handmade
