// A model type that throws until a test disables it, and a small world in which each block has two
// instances of it before all other models.
#pragma once

#include <atomic>
#include <memory>
#include <stdexcept>

#include "engine/models/registry.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::amplify {

// One degenerate triangle.
class ThrowingType final : public models::ModelType {
 public:
  explicit ThrowingType(const std::atomic<bool>& throws) : throws_(throws) {}
  std::string_view name() const override { return "faulty"; }
  std::string_view doc() const override { return "throws"; }
  std::span<const models::ParameterSpec> parameters() const override { return {}; }
  int level_count() const override { return 1; }
  double level_error_m(const models::Parameters&, int) const override { return 0; }
  core::Bounds bounds(const models::Parameters&) const override { return {}; }
  models::MeshSize mesh_size(const models::Parameters&, int) const override { return {3, 3}; }
  double complexity(const models::Parameters&, int) const override { return 1; }
  double log2_cost(const models::Parameters&) const override { return 0; }
  core::Bounds synthesise(const models::Parameters&, int,
                          const models::MeshView& out) const override {
    if (throws_) throw std::runtime_error("no geometry today");
    std::fill(out.vertices.begin(), out.vertices.end(), std::byte{0});
    std::fill(out.indices.begin(), out.indices.end(), std::uint16_t{0});
    return {};
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}

 private:
  const std::atomic<bool>& throws_;
};

struct ThrowingWorld {
  std::atomic<bool> throws{true};
  models::Registry registry = models::make_standard_registry();
  world::World world = world::testing::parsed(world::testing::kSmallWorld);
  ThrowingWorld() {
    world::Scatter faulty;
    faulty.model = *registry.add(std::make_unique<ThrowingType>(throws));
    faulty.count = 2;
    world.scatter.insert(world.scatter.begin(), faulty);
  }
};

}  // namespace psygen::amplify
