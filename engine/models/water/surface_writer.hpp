// Vertices and triangles of the surface of water in one node, from rows across rivers and from
// squares of lakes. Internal to the type of these meshes (water_surface.hpp): one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

// The node of a mesh.
struct WaterNode {
  QuadCoord at;
  core::BlockCoord block;  // at its corner
  int level;
  double block_m;
  const GroundStack* ground;  // null: no water

  // Of the parameters of make_water_type().
  explicit WaterNode(const Parameters& p);
  double side_m() const;
  double cell_m() const { return side_m() / 64; }
  // True if a river of this width is no thinner than a pixel where the node is drawn.
  bool shows(double width_m) const { return width_m >= 0.06 * cell_m(); }
};

// A point of a surface, in metres from the node's corner.
struct SurfacePoint {
  glm::dvec3 at_m{0.0};
  double depth_m = 0, foam = 0;  // of the water under it; 0 … 1
  glm::dvec2 flow_m_s{0.0}, slope{0.0};
};

// The surface across a river.
struct CrossSection {
  glm::dvec2 middle_m{0.0};                   // from the node's corner
  glm::dvec2 direction{1, 0};                 // downstream, unit length
  double half_width_m = 0;                    // of the water
  double edge_m = 0;                          // the surface reaches so far under the banks
  double surface_m = 0;                       // height
  double middle_depth_m = 0, middle_m_s = 0;  // of the water, and its speed
  double fall = 0, foam = 0;                  // slope of the surface downstream; 0 … 1
};

class SurfaceWriter {
 public:
  // Return the index of the first new vertex. A row has more places at node level 0.
  std::uint32_t add(const SurfacePoint& point);
  std::uint32_t add(const CrossSection& section, int node_level);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  // Adds the surface between two rows, each by its first vertex.
  void join(std::uint32_t upper, std::uint32_t lower, int node_level);

  // Adds the part of a ring of four places, in turn, where `beyond` is at most 0: it is below 0 in
  // the water, and 0 at its border. add_point(i, j, share): a vertex between places i and j.
  template <class AddPoint>
  void add_ring(const std::array<double, 4>& beyond, const AddPoint& add_point) {
    std::array<std::uint32_t, 8> ring;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      const double a = beyond[i], b = beyond[j];
      if (a <= 0) ring[count++] = add_point(i, i, 0.0);
      if ((a <= 0) != (b <= 0)) ring[count++] = add_point(i, j, a / (a - b));
    }
    for (std::size_t i = 1; i + 1 < count; ++i)
      add_triangle(ring[0], ring[i], ring[i + 1]);
  }
  // Columns and rows of the places of a ring in a grid.
  static constexpr std::array<std::array<std::size_t, 2>, 4> kCorners{
      {{0, 0}, {0, 1}, {1, 1}, {1, 0}}};

  std::uint32_t vertices() const { return static_cast<std::uint32_t>(points_.size()); }
  std::uint32_t indices() const { return static_cast<std::uint32_t>(indices_.size()); }
  // True if the mesh takes no further rivers and tiles of lakes: indices have 16 bits.
  bool is_full() const { return vertices() > 60'000; }
  // Bounds of all vertices; a point at the corner without any.
  core::Bounds tight() const { return points_.empty() ? core::Bounds{} : tight_; }
  // Writes the mesh, as core::WaterVertex in its tight bounds. The destination has its exact size.
  void write(const MeshView& out) const;

 private:
  std::vector<SurfacePoint> points_;
  std::vector<std::uint16_t> indices_;
  core::Bounds tight_{glm::vec3(1e30F), glm::vec3(-1e30F)};
};

// Add the water of a node: the pieces made by hand, and that of a river network.
void add_pieces(const WaterNode& node, SurfaceWriter& to);
void add_network(const WaterNode& node, const RiverNetwork& network, SurfaceWriter& to);

}  // namespace psygen::models
