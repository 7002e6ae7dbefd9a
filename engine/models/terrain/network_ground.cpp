// The ground of a world with a river network: the land follows the rivers. The noise of the terrain
// is detail on the land, which fades at channels and lakes, as erosion does; beds are cut last.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "engine/models/kit/scratch.hpp"
#include "engine/models/network/network.hpp"
#include "engine/models/terrain/shape.hpp"

namespace psygen::models {
namespace {

// Octaves of the noise that are narrower than the network's own nodes become detail; this is their
// strength on steep land, in parts of the relief that the noise alone would have.
constexpr double kDetailStrength = 0.16;
// Land less steep has less detail, in proportion to its slope.
constexpr float kFullDetailSlope = 0.35F;

// The slow ground that erosion follows.
class NetworkGuide final : public ErosionGuide {
 public:
  NetworkGuide(const RiverNetwork& network, float unit_m) : network_(network), unit_m_(unit_m) {}
  void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
               double narrowest_cells, std::span<float> values, std::size_t stride) const override {
    GroundDetail detail;
    while (detail.level < 24 && detail.spacing_cells() < narrowest_cells)
      ++detail.level;
    network_.base({columns, rows}, detail.level > 1 ? detail : GroundDetail{},
                  {.height_m = values.data(), .stride = stride});
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        values[r * stride + c] /= unit_m_;
    }
  }

 private:
  const RiverNetwork& network_;
  float unit_m_;
};

}  // namespace

void TerrainShape::evaluate_network(std::span<const std::int64_t> columns,
                                    std::span<const std::int64_t> rows, std::span<float> values,
                                    std::size_t stride, GroundDetail detail) const {
  const RiverNetwork& network = *stack->network;
  const std::size_t width = columns.size(), count = width * rows.size();
  const ScratchMemory memory(6 * count * sizeof(float));
  const std::span all(static_cast<float*>(memory.get()), 6 * count);
  const auto plane = [&](std::size_t i) { return all.subspan(i * count, count); };
  const std::span<float> base = plane(0), clear = plane(1), slope_x = plane(2), slope_z = plane(3);
  const std::span<float> fine = plane(4), wide = plane(5);
  network.base({columns, rows}, detail,
               {.height_m = base.data(),
                .slope_x = slope_x.data(),
                .slope_z = slope_z.data(),
                .clear = clear.data(),
                .stride = width});
  const double node_cells =
      std::ldexp(network.settings().root_spacing_m, -network.settings().halvings) /
      network.frame().cell_m;
  const int octaves_here = octaves(detail);
  const int wide_octaves = std::min(octaves_here, noise.octaves_wider_than(node_cells));
  noise.evaluate(columns, rows, fine, width, octaves_here);
  noise.evaluate(columns, rows, wide, width, wide_octaves);
  const auto strength = static_cast<float>(kDetailStrength) * metres;
  for (std::size_t i = 0; i < count; ++i) {
    const float steep =
        std::min((std::abs(slope_x[i]) + std::abs(slope_z[i])) * (1 / kFullDetailSlope), 1.0F);
    fine[i] =
        std::clamp(base[i] + (fine[i] - wide[i]) * strength * steep * clear[i], 0.0F, relief_m) /
        metres;
  }
  if (const std::optional<ErosionFilter> erosion = filter(detail)) {
    std::copy(fine.begin(), fine.end(), wide.begin());
    erosion->apply(NetworkGuide(network, metres), columns, rows, wide, width);
    for (std::size_t i = 0; i < count; ++i)
      fine[i] += (wide[i] - fine[i]) * clear[i];
  }
  for (float& value : fine)
    value *= metres;
  network.carve(
      {columns, rows}, detail,
      {.base_m = base.data(), .base_stride = width, .height_m = fine.data(), .stride = width});
  const float highest = 65535.0F / quantum;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < width; ++c)
      values[r * stride + c] = std::clamp(fine[r * width + c] / metres, 0.0F, highest);
  }
}

}  // namespace psygen::models
