#include "engine/models/water/water_surface.hpp"

#include <array>
#include <limits>
#include <optional>

#include "engine/core/rounding.hpp"
#include "engine/models/water/surface_writer.hpp"

namespace psygen::models {
namespace {

constexpr std::int32_t kLastNode = std::numeric_limits<std::int32_t>::max();
constexpr std::array kSchema{
    placed(integer_parameter("x", "nodes", 0, {-2147483648.0, kLastNode}, {0, 511},
                             "index of the node along x, in nodes of its level")),
    placed(integer_parameter("z", "nodes", 0, {-2147483648.0, kLastNode}, {0, 511},
                             "index of the node along z, in nodes of its level")),
    placed(integer_parameter("node_level", "1", 0, {0, 30}, {0, 13},
                             "the node has 2^this blocks along each side")),
    placed(real_parameter("block_m", "m", 63, {1, 1e6}, {16, 512}, "side of a block")),
};

SurfaceWriter made(const Parameters& p) {
  const core::RoundToNearest rounding;
  const WaterNode node(p);
  SurfaceWriter surface;
  if (node.ground == nullptr) return surface;
  add_pieces(node, surface);
  if (node.ground->network != nullptr) add_network(node, *node.ground->network, surface);
  return surface;
}

// The surface of these parameters. Callers ask for presence, bounds, size, cost and the mesh in
// turn, so each thread keeps its last answer, usually some 100 KiB. Equal parameters have equal
// surfaces: they have the hash of the edits that their mesh shows.
const SurfaceWriter& surface_of(const Parameters& p) {
  struct Kept {
    Parameters parameters;
    SurfaceWriter surface;
  };
  static thread_local std::optional<Kept> last;
  if (!last || last->parameters != p) {
    last.reset();
    last = Kept{p, made(p)};
  }
  return last->surface;
}

// The type. A node's mesh has one level; coarser nodes have coarser meshes.
class WaterType final : public ModelType {
 public:
  std::string_view name() const override { return "water_surface"; }
  std::string_view doc() const override { return "surface of the rivers and lakes of a node"; }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return 1; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const Parameters&, int) const override { return 0; }
  core::SurfaceKind surface() const override { return core::SurfaceKind::kWater; }
  core::Bounds bounds(const Parameters& p) const override { return surface_of(p).tight(); }
  MeshSize mesh_size(const Parameters& p, int) const override {
    const SurfaceWriter& surface = surface_of(p);
    return {surface.vertices(), surface.indices(), 0, core::VertexLayout::kModel};
  }
  double complexity(const Parameters& p, int) const override { return surface_of(p).vertices(); }
  double steps(const Parameters& p, int) const override { return surface_of(p).vertices(); }
  double step_seconds() const override { return 60e-9; }
  double log2_cost(const Parameters&) const override { return 16; }
  core::Bounds synthesise(const Parameters& p, int, const MeshView& out) const override {
    const core::RoundToNearest rounding;
    const SurfaceWriter& surface = surface_of(p);
    surface.write(out);
    return surface.tight();
  }
};

}  // namespace

Parameters water_surface_parameters(core::BlockCoord node, int node_level, double block_m) {
  Parameters p;
  p.set_integer(kWaterX, node.x);
  p.set_integer(kWaterZ, node.z);
  p.set_integer(kWaterNodeLevel, node_level);
  p.set_real(kWaterBlockM, block_m);
  return p;
}

bool has_water_surface(const Parameters& p) {
  return surface_of(p).indices() > 0;
}

std::unique_ptr<ModelType> make_water_type() {
  return std::make_unique<WaterType>();
}

}  // namespace psygen::models
