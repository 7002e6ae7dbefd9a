// The cheapest possible model type, so that benchmarks measure the cost around synthesis.
#pragma once

#include <memory>

#include "engine/core/geometry_memory.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/mesh_key.hpp"

namespace psygen::synthesis::bench {

// Writes nothing. Parameter 0: vertices.
class TrivialModel final : public models::ModelType {
 public:
  std::string_view name() const override { return "trivial"; }
  std::string_view doc() const override { return "writes nothing"; }
  std::span<const models::ParameterSpec> parameters() const override { return {}; }
  int level_count() const override { return 1; }
  double level_error_m(const models::Parameters&, int) const override { return 0; }
  core::Bounds bounds(const models::Parameters&) const override { return {}; }
  models::MeshSize mesh_size(const models::Parameters& p, int) const override {
    return {static_cast<std::uint32_t>(p.integer(0)), 0, 0, core::VertexLayout::kModel};
  }
  double complexity(const models::Parameters&, int) const override { return 1; }
  double log2_cost(const models::Parameters&) const override { return 0; }
  core::Bounds synthesise(const models::Parameters&, int, const models::MeshView&) const override {
    return {};
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}
};

inline models::Registry trivial_registry() {
  models::Registry registry;
  (void)registry.add(std::make_unique<TrivialModel>());
  return registry;
}

inline models::Parameters vertices_of(std::int64_t vertices) {
  models::Parameters p;
  p.set_integer(0, vertices);
  return p;
}

inline MeshKey key_of(std::uint32_t index) {
  return {{0, 0}, index, 0, 0, 1};
}

// Geometry memory that allocates nothing and only counts.
class CountingMemory final : public core::GeometryMemory {
 public:
  core::Result<core::GeometryReservation> reserve(core::VertexLayout layout, std::uint32_t vertices,
                                                  std::uint32_t indices) override {
    core::GeometryReservation r;
    r.range.id = 0;
    r.range.bytes = charged_bytes(layout, vertices, indices);
    used_ += r.range.bytes;
    return r;
  }
  void commit(const core::GeometryRange&) override {}
  void release(const core::GeometryRange& range) override { used_ -= range.bytes; }
  std::uint32_t charged_bytes(core::VertexLayout, std::uint32_t vertices,
                              std::uint32_t indices) const override {
    return vertices * 16 + indices * 2;
  }
  std::uint64_t used_bytes() const override { return used_; }
  std::uint64_t capacity_bytes() const override { return UINT64_MAX; }
  bool zero_copy() const override { return true; }
  std::span<const std::byte> vertex_bytes(const core::GeometryRange&) const override { return {}; }
  std::span<const std::uint16_t> indices(const core::GeometryRange&) const override { return {}; }

 private:
  std::uint64_t used_ = 0;
};

}  // namespace psygen::synthesis::bench
