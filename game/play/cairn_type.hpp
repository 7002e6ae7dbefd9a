// Model type of a cairn: a stack of flat stones, each smaller than the one below. Hidden cairns and
// the player's cairns are both edits of the world, so they are drawn, solid and saved like all
// models. A pure function of its parameters.
#pragma once

#include "engine/models/model_type.hpp"

namespace cairns {

using namespace psygen;

// Parameter indices, in the order of the schema.
enum CairnParameter : std::size_t { kCairnSeed, kCairnStones, kCairnWidthM };

class CairnType final : public models::ModelType {
 public:
  std::string_view name() const override { return "cairn"; }
  std::string_view doc() const override { return "A stack of stones that marks a place"; }
  std::span<const models::ParameterSpec> parameters() const override;
  int level_count() const override { return 3; }
  double level_error_m(const models::Parameters& p, int level) const override;
  core::Bounds bounds(const models::Parameters& p) const override;
  models::MeshSize mesh_size(const models::Parameters& p, int level) const override;
  double complexity(const models::Parameters& p, int level) const override;
  double log2_cost(const models::Parameters& p) const override;
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override;
  core::SurfaceKind surface() const override { return core::SurfaceKind::kStone; }
  models::Collider collider(const models::Parameters& p) const override;
  bool may_run_on_main_thread() const override { return true; }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}
};

}  // namespace cairns
