#include "engine/models/water/surface_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <span>

#include "engine/core/assert.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/water/water_surface.hpp"

namespace psygen::models {
namespace {

// Places across a river, in halves of its width; the outermost ones reach under the banks.
constexpr double kBeyond = 2;  // stands for the edge beyond the width
constexpr std::array kFineAcross{-kBeyond, -1.0, -0.6, 0.0, 0.6, 1.0, kBeyond};
constexpr std::array kCoarseAcross{-kBeyond, 0.0, kBeyond};
std::span<const double> across_of(int node_level) {
  return node_level == 0 ? std::span<const double>(kFineAcross)
                         : std::span<const double>(kCoarseAcross);
}

core::WaterVertex packed(const SurfacePoint& point, const core::Bounds& box) {
  const glm::vec3 centre = box.centre(), half = glm::max(box.half_extent(), glm::vec3(1e-3F));
  const auto snorm = [](double value, double largest) {
    return std::round(std::clamp(value, -1.0, 1.0) * largest);
  };
  const auto unorm8 = [](double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
  };
  core::WaterVertex v;
  for (int i = 0; i < 3; ++i)
    v.position[i] = static_cast<std::int16_t>(
        snorm((point.at_m[i] - double{centre[i]}) / double{half[i]}, 32767));
  v.depth = unorm8(std::sqrt(std::max(point.depth_m, 0.0) / double{core::kWaterVertexDepthM}));
  v.foam = unorm8(point.foam);
  for (int i = 0; i < 2; ++i) {
    v.flow[i] = static_cast<std::int16_t>(
        snorm(point.flow_m_s[i] / double{core::kWaterVertexSpeed}, 32767));
    v.slope[i] = static_cast<std::int8_t>(snorm(point.slope[i], 127));
  }
  return v;
}

}  // namespace

WaterNode::WaterNode(const Parameters& p)
    : at(QuadCoord::of({static_cast<std::int32_t>(p.integer(kWaterX)),
                        static_cast<std::int32_t>(p.integer(kWaterZ))},
                       static_cast<std::uint32_t>(p.integer(kWaterNodeLevel)))),
      block(at.corner()),
      level(static_cast<int>(at.level)),
      block_m(p.real(kWaterBlockM)),
      ground(p.edits() != nullptr ? &p.edits()->ground : nullptr) {}

double WaterNode::side_m() const {
  return std::ldexp(block_m, level);
}

std::uint32_t SurfaceWriter::add(const SurfacePoint& point) {
  tight_.min = glm::min(tight_.min, glm::vec3(point.at_m));
  tight_.max = glm::max(tight_.max, glm::vec3(point.at_m));
  points_.push_back(point);
  return vertices() - 1;
}

std::uint32_t SurfaceWriter::add(const CrossSection& section, int node_level) {
  const std::uint32_t first = vertices();
  const glm::dvec2 aside(-section.direction.y, section.direction.x);
  for (const double across : across_of(node_level)) {
    const bool beyond = std::abs(across) >= kBeyond;
    const double out_m = beyond ? (across > 0 ? 1 : -1) * (section.half_width_m + section.edge_m)
                                : across * section.half_width_m;
    const glm::dvec2 at_m = section.middle_m + aside * out_m;
    const double inner = beyond ? 0 : 1 - across * across;
    add({.at_m = {at_m.x, section.surface_m, at_m.y},
         .depth_m = section.middle_depth_m * inner,
         .foam = section.foam,
         .flow_m_s = section.direction * (section.middle_m_s * std::max(inner, 0.2)),
         .slope = section.direction * -section.fall});
  }
  return first;
}

void SurfaceWriter::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  for (const std::uint32_t vertex : {a, b, c})
    indices_.push_back(static_cast<std::uint16_t>(vertex));
}

void SurfaceWriter::join(std::uint32_t upper, std::uint32_t lower, int node_level) {
  for (std::uint32_t k = 0; k + 1 < across_of(node_level).size(); ++k) {
    add_triangle(upper + k, lower + k, upper + k + 1);
    add_triangle(upper + k + 1, lower + k, lower + k + 1);
  }
}

void SurfaceWriter::write(const MeshView& out) const {
  PSYGEN_CHECK(out.vertices.size() == points_.size() * sizeof(core::WaterVertex) &&
                   out.indices.size() == indices_.size(),
               "the destination has exactly the size of the mesh");
  std::byte* to = out.vertices.data();
  for (const SurfacePoint& point : points_) {
    const core::WaterVertex v = packed(point, tight());
    std::memcpy(to, &v, sizeof v);
    to += sizeof v;
  }
  std::ranges::copy(indices_, out.indices.begin());
}

}  // namespace psygen::models
