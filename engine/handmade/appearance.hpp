// Measures how much a simplified mesh differs from the original, as a length: the distance of the
// surfaces, and the size of the largest region with a wrong mean colour or normal. A viewer to whom
// such a region is smaller than a pixel sees no difference. Pure; any thread.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/handmade/simplifier.hpp"

namespace psygen::handmade {

class Appearance {
 public:
  // Takes some thousand points of the surface. O(triangles).
  Appearance(const std::vector<Vertex>& vertices, const Indices& indices);

  // The difference of the triangles that a simplifier of this mesh has left, in metres. `vertices`
  // are those of the mesh. They get colours fitted to the original if that lowers the error
  // clearly.
  double fit(std::vector<Vertex>& vertices, Simplifier& simplifier) const;

 private:
  struct Point {
    Simplifier::Goal goal;
    glm::vec3 normal{0.0F}, colour{0.0F};  // colour: 0 … 1, stored as in Vertex
    std::uint64_t side = 0;                // of its surface
    std::uint32_t triangle = 0;
    float area_m2 = 0;
  };
  // A point of the level for a point of the surface.
  struct Match {
    std::array<std::uint32_t, 3> corners{};
    glm::vec3 weights{0.0F};
    bool is_found = false;
  };
  // Sums over a region.
  struct Difference {
    glm::vec3 colour{0.0F}, normal{0.0F};
    float area_m2 = 0;

    void add(const Difference& other);
    bool has_wrong_normal() const;
    bool is_wrong() const;
  };
  class Regions;
  std::vector<Difference> differences(const std::vector<Vertex>& vertices,
                                      const std::vector<Match>& matches) const;
  glm::vec3 missing_colour(const std::vector<glm::vec3>& colours, const std::vector<Match>& matches,
                           std::size_t point) const;
  std::vector<Vertex> with_fitted_colours(const std::vector<Vertex>& vertices,
                                          const std::vector<Match>& matches) const;
  // Side of the smallest squares whose mean differences are all invisible; 0 if no point differs
  // visibly.
  struct WrongSize {
    float any_m = 0;      // of colours and normals
    float normals_m = 0;  // of normals alone, no more than any_m
  };
  WrongSize wrong_size(const std::vector<Difference>& differences) const;

  std::vector<Point> points_;
  glm::vec3 darkest_{1.0F}, brightest_{0.0F};  // range of colours
  float extent_m_ = 0, spacing_m_ = 0;         // of all points; between neighbouring ones
};

}  // namespace psygen::handmade
