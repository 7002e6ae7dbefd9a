// Simplifies a mesh whose vertices have colours and normals. The cheapest edge collapses first; its
// cost is a length that counts the surface, its borders, colours and normals. Uses the quadrics of
// Hoppe, "New Quadric Metric for Simplifying Meshes with Appearance Attributes" (Visualization
// 1999). Pure; a mesh gives the same triangles on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <queue>
#include <span>
#include <vector>

#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {

// Three vertices for each triangle.
using Indices = std::vector<std::uint32_t>;

class Simplifier {
 public:
  // Expects different vertices, and triangles with an area. O(n).
  explicit Simplifier(const std::vector<Vertex>& vertices, Indices indices);

  // Collapses edges until at most this many triangles are left, or no edge can collapse. Vertices
  // stay where they are. Never brings triangles back. O(n log n) for all calls together.
  void reduce_to(std::size_t triangles);
  std::size_t triangle_count() const { return left_; }
  // The triangles that are left, by vertices of the constructor.
  Indices indices() const;
  // Of all collapses, the largest distance of a vertex from the planes around it, in metres.
  double error_m() const { return static_cast<double>(error_m_); }

  // Number of comparisons of edges and triangles up to now.
  std::size_t work() const { return work_; }

  // A point on the surface, and the direction of its front.
  struct Goal {
    glm::vec3 position{0.0F}, facing{0.0F};
  };
  // A point of a triangle that is left.
  struct Match {
    std::uint32_t triangle = 0;
    glm::vec3 weights{0.0F};  // of its corners; their sum is 1
    float distance_m = 0;
    bool is_found = false;  // false if nothing of the same direction is left
  };
  // The point nearest to a goal. Walks over the surface from where the goal's triangle of the
  // constructor was. O(1).
  Match nearest(std::uint32_t triangle, const Goal& goal);
  // The vertices of a triangle that is left.
  const std::uint32_t* corners(std::uint32_t triangle) const {
    return &indices_[3 * std::size_t{triangle}];
  }

  // Of the vertices at the position of a vertex, the one whose normal fits a direction best.
  std::uint32_t fitting(std::uint32_t vertex, const glm::vec3& direction) const;

 private:
  // Relative to a colour and normal, in units of a clearly visible difference. The last two are 0,
  // so that loops over all are vector instructions.
  using Attributes = std::array<float, 8>;

  // A weighted sum of squares of linear functions of a position.
  struct Quadric {
    glm::mat3 square{0.0F};
    glm::vec3 slope{0.0F};
    float value = 0;

    void add(const glm::vec3& gradient, float weight);  // of a function that is 0 at the origin
    void add(const Quadric& other);
    float at(const glm::vec3& p) const;
    void move(const glm::vec3& origin);
  };
  // All vertices of one position; the quadric is relative to it.
  struct Place {
    Quadric surface;
    float weight_m2 = 0;
    std::uint32_t triangles = 0;  // number of triangles that are left
    std::uint32_t parent = 0;     // the place to which it collapsed, or itself
    bool is_queued = false;
  };
  // The difference of a vertex from the looks of the surface that it stands for, times its area.
  // Relative to the vertex's position and attributes.
  struct Looks {
    Quadric sum;
    std::array<Attributes, 3> slopes{};  // of the attributes along x, y, z
    Attributes values{}, low{}, high{};  // low, high: range on the surface, not relative
    float area_m2 = 0;

    // By how much the attributes change on the way to a position, times the area.
    Attributes change(const glm::vec3& p) const;
    // The difference at a position with this sum and change.
    float at(float sum_there, const Attributes& change, const Attributes& a) const;
    void add(const Looks& other);
    void move(const glm::vec3& origin, const Attributes& a);
  };
  struct Collapse {
    float cost_m = 0, error_m = 0;
    std::uint32_t to = 0;
    bool is_possible = false;
  };
  struct Entry {
    float cost_m;
    std::uint32_t place;
    bool operator>(const Entry& o) const {
      return cost_m != o.cost_m ? cost_m > o.cost_m : place > o.place;
    }
  };

  void join_vertices();
  void add_surface();
  void add_edges();
  const Indices& around(std::uint32_t place);
  void enqueue(std::uint32_t place, float cost_m);
  std::uint32_t place_now(std::uint32_t triangle, int corner);
  void look_around(std::uint32_t place, std::span<const std::uint32_t> seen, const Goal& goal,
                   Match& best);
  // The vertices of a place.
  std::span<const std::uint32_t> members(std::uint32_t place) const {
    return std::span(members_).subspan(first_[place], first_[place + 1] - first_[place]);
  }
  std::uint32_t place_at(std::uint32_t triangle, int corner) const {
    return place_of_[indices_[3 * std::size_t{triangle} + static_cast<std::size_t>(corner)]];
  }
  // The vertex of a place that can replace a vertex of another place best.
  struct Successor {
    std::uint32_t vertex;
    float wrong_m2;  // area with wrong looks
  };
  Successor successor(std::uint32_t vertex, std::uint32_t to) const;
  Attributes step(std::uint32_t from, std::uint32_t to) const;
  Collapse cost(std::uint32_t from, std::uint32_t to) const;
  bool flips(std::uint32_t from, std::uint32_t to) const;
  Collapse best(std::uint32_t from);
  void collapse(std::uint32_t from, const Collapse& how);

  std::vector<Vertex> vertices_;
  Indices indices_;
  std::vector<bool> gone_;              // triangles
  Indices place_of_, first_, members_;  // vertices of place i: members_[first_[i] … first_[i+1]-1]
  std::vector<Attributes> attributes_;  // of vertices
  std::vector<Looks> looks_;            // of vertices
  std::vector<Place> places_;
  std::vector<glm::vec3> positions_;  // of places
  std::vector<Indices> around_;       // triangles of places, some of which are gone
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  Indices others_;               // scratch of best()
  std::vector<Collapse> found_;  // scratch of best()
  std::size_t left_ = 0, work_ = 0;
  float error_m_ = 0, slack_m_ = 0;
};

}  // namespace psygen::handmade
