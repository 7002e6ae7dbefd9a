// The sources of objects' meshes by name, and the model types over them.
#include "engine/scene/objects/object_type.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace psygen::scene {
namespace {

ObjectSource triangle() {
  ObjectLevel level;
  level.mesh.vertices.resize(3);
  level.mesh.indices = {0, 1, 2};
  ObjectSource source;
  source.copied.push_back(level);
  source.box = {glm::vec3(-1.0F), glm::vec3(1.0F)};
  return source;
}

TEST(ObjectSources, NamesAreNotUsedTwiceThoughSlotsAre) {
  ObjectSources sources;
  const auto first = sources.add(triangle()), second = sources.add(triangle());
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, 0u);
  EXPECT_EQ(*second, 1u);
  const auto held = sources.find(*first);
  sources.remove(*first);
  sources.remove(*first);
  EXPECT_EQ(sources.find(*first), nullptr);
  EXPECT_EQ(held->copied.size(), 1u) << "lives on while it is used";
  const auto third = sources.add(triangle());
  ASSERT_TRUE(third);
  EXPECT_EQ(*third % ObjectSources::kMax, 0u);
  EXPECT_NE(*third, *first);
  sources.remove(*first);
  EXPECT_NE(sources.find(*third), nullptr) << "an old name removes nothing";
  EXPECT_NE(sources.find(*second), nullptr);
  EXPECT_EQ(sources.find(77), nullptr);
  EXPECT_EQ(sources.find(UINT32_MAX), nullptr);
}

TEST(ObjectSources, HaveAMaximum) {
  ObjectSources sources;
  for (std::uint32_t i = 0; i < ObjectSources::kMax; ++i)
    ASSERT_EQ(sources.add({}), i);
  EXPECT_FALSE(sources.add({}));
  sources.remove(4711);
  EXPECT_TRUE(sources.add({}));
  EXPECT_FALSE(sources.add({}));
}

// Otherwise one of its names would mean "none", or repeat.
TEST(ObjectSources, ASlotIsNotUsedAfterItsLastName) {
  ObjectSources sources;
  std::uint32_t last = 0;
  for (std::uint32_t i = 0; i < 2 * ObjectSources::kMax; ++i) {
    const auto name = sources.add({});
    ASSERT_TRUE(name);
    ASSERT_NE(*name, UINT32_MAX);
    if (*name % ObjectSources::kMax == last % ObjectSources::kMax) {
      ASSERT_TRUE(i == 0 || *name > last);
    } else {
      ASSERT_EQ(*name, last % ObjectSources::kMax + 1) << "the next slot";
    }
    last = *name;
    sources.remove(*name);
  }
  EXPECT_EQ(last % ObjectSources::kMax, 2u);
}

// It was requested, and its memory is reserved.
TEST(ObjectType, AMeshRemovedBeforeSynthesisIsEmpty) {
  const auto sources = std::make_shared<ObjectSources>();
  const auto type = make_object_type(sources, true);
  const auto name = sources->add(triangle());
  ASSERT_TRUE(name);
  const models::Parameters parameters = object_parameters(*name);
  ASSERT_EQ(type->mesh_size(parameters, 0).vertex_count, 3u);
  std::vector<core::ObjectVertex> vertices(3);
  std::vector<std::uint16_t> indices(3, 7);
  const models::MeshView out{std::as_writable_bytes(std::span(vertices)), indices};
  EXPECT_EQ(type->synthesise(parameters, 0, out), triangle().box);
  EXPECT_EQ(indices, (std::vector<std::uint16_t>{0, 1, 2}));
  sources->remove(*name);
  EXPECT_EQ(type->mesh_size(parameters, 0).vertex_count, 0u);
  EXPECT_EQ(type->synthesise(parameters, 0, out), core::Bounds{});
  EXPECT_EQ(indices, (std::vector<std::uint16_t>{0, 0, 0}));
}

// For the thread sanitizer.
TEST(ObjectType, MeshesAreAddedAndRemovedWhileModelersMakeThem) {
  const auto sources = std::make_shared<ObjectSources>();
  const auto type = make_object_type(sources, true);
  std::atomic<std::uint32_t> newest = 0;
  std::atomic<bool> ended = false;
  std::atomic<int> began = 0;
  std::vector<std::thread> modelers;
  for (int i = 0; i < 2; ++i) {
    modelers.emplace_back([&] {
      std::vector<core::ObjectVertex> vertices(3);
      std::vector<std::uint16_t> indices(3);
      while (!ended) {
        const models::Parameters parameters = object_parameters(newest);
        const core::Bounds box =
            type->synthesise(parameters, 0, {std::as_writable_bytes(std::span(vertices)), indices});
        EXPECT_TRUE(box == triangle().box || box == core::Bounds{});
        ++began;
      }
    });
  }
  for (int i = 0; i < 2'000 || began < 100; ++i) {
    const auto name = sources->add(triangle());
    ASSERT_TRUE(name);
    newest = *name;
    if (i % 3 == 0) std::this_thread::yield();
    sources->remove(*name);
  }
  ended = true;
  for (std::thread& modeler : modelers)
    modeler.join();
}

}  // namespace
}  // namespace psygen::scene
