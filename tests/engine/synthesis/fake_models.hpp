// Model types for tests, cheap and deterministic, and some that misbehave; and ranks of requests.
#pragma once

#include <array>
#include <atomic>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "engine/core/hash.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/mesh_key.hpp"
#include "engine/synthesis/rank.hpp"

namespace psygen::synthesis::testing {

// Parameters 0: seed, 1: vertices. Fills its destination with bytes that depend on seed and level.
class FakeModel : public models::ModelType {
 public:
  explicit FakeModel(std::string name = "fake", int levels = 3)
      : name_(std::move(name)), levels_(levels) {}

  std::string_view name() const override { return name_; }
  std::string_view doc() const override { return "bytes for tests"; }
  std::span<const models::ParameterSpec> parameters() const override {
    using models::ParameterType;
    static const std::array<models::ParameterSpec, 2> kSchema{
        {{"seed", ParameterType::kInteger, "", 1, 0, 1e15, 0, 100, "seed"},
         {"vertices", ParameterType::kInteger, "1", 30, 0, 65536, 3, 1000, "size"}}};
    return kSchema;
  }
  int level_count() const override { return levels_; }
  double level_error_m(const models::Parameters&, int level) const override { return level; }
  core::Bounds bounds(const models::Parameters&) const override {
    return {glm::vec3(-1), glm::vec3(1)};
  }
  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    const auto n = static_cast<std::uint32_t>(p.integer(1) >> level);
    return {n, n * 3, 0, core::VertexLayout::kModel};
  }
  double complexity(const models::Parameters& p, int level) const override {
    return static_cast<double>(p.integer(1) >> level);
  }
  double log2_cost(const models::Parameters&) const override { return 10; }
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    const std::uint64_t base =
        core::combine(static_cast<std::uint64_t>(p.integer(0)), static_cast<std::uint64_t>(level));
    for (std::size_t i = 0; i + 8 <= out.vertices.size(); i += 8) {
      const std::uint64_t word = core::mix64(base + i);
      std::memcpy(out.vertices.data() + i, &word, 8);
    }
    for (std::size_t i = 0; i < out.indices.size(); ++i)
      out.indices[i] =
          static_cast<std::uint16_t>(core::mix64(base ^ i) % (out.vertices.size() / 16));
    return {glm::vec3(-0.5F), glm::vec3(0.5F)};
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}

 private:
  std::string name_;
  int levels_;
};

// Size of a mesh of 80 vertices of 16 bytes, with 3 indices of 2 bytes each: a multiple of 16.
inline constexpr std::uint64_t kMeshBytes = 80 * 22;

// Calls a function before it synthesises.
class ScriptedModel : public FakeModel {
 public:
  using Script = std::function<void(const models::Parameters&, int level)>;
  ScriptedModel(std::string name, Script script)
      : FakeModel(std::move(name)), script_(std::move(script)) {}
  bool may_run_on_main_thread() const override { return name() != "wild"; }
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    script_(p, level);
    return FakeModel::synthesise(p, level, out);
  }

 private:
  Script script_;
};

// Returns bounds that are not numbers.
class LyingModel : public FakeModel {
 public:
  LyingModel() : FakeModel("lying") {}
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    FakeModel::synthesise(p, level, out);
    return {glm::vec3(std::numeric_limits<float>::quiet_NaN()), glm::vec3(1)};
  }
};

// Throws in mesh_size() and has an invalid complexity.
class SizelessModel : public FakeModel {
 public:
  SizelessModel() : FakeModel("sizeless") {}
  models::MeshSize mesh_size(const models::Parameters&, int) const override {
    throw std::runtime_error("unknown size");
  }
  double complexity(const models::Parameters&, int) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

// Has more vertices than 16-bit indices can address.
class HugeModel : public FakeModel {
 public:
  HugeModel() : FakeModel("huge") {}
  models::MeshSize mesh_size(const models::Parameters&, int) const override {
    return {UINT32_MAX, UINT32_MAX, 0, core::VertexLayout::kModel};
  }
};

// A gate on which a model hangs until the test opens it.
class Gate {
 public:
  void wait() {
    arrived_.fetch_add(1);
    arrived_.notify_all();
    open_.wait(false);
  }
  void open() {
    open_.store(true);
    open_.notify_all();
  }
  // Blocks until `count` models hang.
  void await(int count) {
    for (int n = arrived_.load(); n < count; n = arrived_.load())
      arrived_.wait(n);
  }

 private:
  std::atomic<bool> open_{false};
  std::atomic<int> arrived_{0};
};

inline models::Parameters parameters_of(std::int64_t seed, std::int64_t vertices) {
  models::Parameters p;
  p.set_integer(0, seed);
  p.set_integer(1, vertices);
  return p;
}

inline MeshKey key_of(std::uint32_t index, const models::Parameters& p,
                      models::ModelIndex model = 0, std::uint16_t level = 0) {
  return {{7, -3}, index, model, level, p.hash()};
}

inline Rank hole(float distance) {
  return Rank::by_layer(RankGroup::kVisibleHole, 0, distance);
}
inline Rank drawn(float distance) {
  return Rank::by_layer(RankGroup::kDrawn, 0, distance);
}
inline Rank prefetch(float distance) {
  return Rank::by_layer(RankGroup::kPrefetch, 0, distance);
}

inline models::Registry registry_of(std::unique_ptr<models::ModelType> type) {
  models::Registry registry;
  (void)registry.add(std::move(type));
  return registry;
}

}  // namespace psygen::synthesis::testing
