#include "engine/handmade/simplifier.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <span>
#include <utility>

namespace psygen::handmade {
namespace {

// Differences of stored colours and of unit normals that are wrong rather than similar.
constexpr float kWrongColour = 0.25F, kWrongNormal = 0.5F;
constexpr std::uint32_t kMaxTriangles = 32;  // around a place that may collapse
constexpr std::uint32_t kMaxMembers = 8;     // compared at a place
constexpr float kBorder = 10, kSeam = 1;     // weights of edges, relative to areas
constexpr float kLooks = 0.5F;               // weight of looks, relative to the surface
constexpr std::size_t kMaxTries = 8;         // edges of a place, cheapest first
constexpr std::size_t kWork = 32;   // comparisons for a triangle; usual meshes take about 10
constexpr float kRise = 1.25F;      // of a cost that changes the order of collapses
constexpr float kSlack = 1e-5F;     // cost relative to the extent, in any order
constexpr float kMaxTurn = 0.1F;    // cosine of the angle by which a triangle may turn
constexpr float kThinnest = 1e-6F;  // double area relative to the square of a side
constexpr int kMaxWalk = 32;        // steps of a walk over the surface

template <class Key>
std::size_t number(const std::vector<Key>& keys, Indices& numbers) {
  numbers.resize(keys.size());
  return meshopt_generateVertexRemap(numbers.data(), nullptr, keys.size(), keys.data(), keys.size(),
                                     sizeof(Key));
}

// The weights of the corners of a triangle at its point nearest to `p` (Ericson, "Real-Time
// Collision Detection", 2005, 5.1.5).
glm::dvec3 nearest_weights(const glm::dvec3& p, const std::array<glm::dvec3, 3>& t) {
  const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  const auto between = [](double from, double to) { return from / (from - to); };
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - between(d1, d3), between(d1, d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - between(d2, d6), 0, between(d2, d6)};
  const double edge = between(d4 - d3, d6 - d5);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return {0, 1 - edge, edge};
  return glm::dvec3(va, vb, vc) / (va + vb + vc);
}

}  // namespace

void Simplifier::Quadric::add(const glm::vec3& gradient, float weight) {
  square += glm::outerProduct(weight * gradient, gradient);
}

void Simplifier::Quadric::add(const Quadric& other) {
  square += other.square, slope += other.slope, value += other.value;
}

float Simplifier::Quadric::at(const glm::vec3& p) const {
  return glm::dot(p, square * p) + 2 * glm::dot(slope, p) + value;
}

void Simplifier::Quadric::move(const glm::vec3& origin) {
  value = at(origin);
  slope += square * origin;
}

Simplifier::Attributes Simplifier::Looks::change(const glm::vec3& p) const {
  Attributes change;
  for (std::size_t i = 0; i < change.size(); ++i)
    change[i] = slopes[0][i] * p.x + slopes[1][i] * p.y + slopes[2][i] * p.z;
  return change;
}

float Simplifier::Looks::at(float sum_there, const Attributes& change, const Attributes& a) const {
  Attributes parts;
  for (std::size_t i = 0; i < a.size(); ++i)
    parts[i] = a[i] * (area_m2 * a[i] - 2 * (change[i] + values[i]));
  return std::accumulate(parts.begin(), parts.end(), sum_there);
}

void Simplifier::Looks::add(const Looks& other) {
  sum.add(other.sum);
  area_m2 += other.area_m2;
  for (std::size_t k = 0; k < slopes.size(); ++k)
    for (std::size_t i = 0; i < values.size(); ++i)
      slopes[k][i] += other.slopes[k][i];
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += other.values[i];
    low[i] = std::min(low[i], other.low[i]), high[i] = std::max(high[i], other.high[i]);
  }
}

void Simplifier::Looks::move(const glm::vec3& origin, const Attributes& a) {
  const Attributes changes = change(origin);
  const float value = at(sum.at(origin), changes, a);
  sum.move(origin);
  sum.value = value;
  for (std::size_t i = 0; i < a.size(); ++i) {
    values[i] += changes[i] - area_m2 * a[i];
    sum.slope -= a[i] * glm::vec3(slopes[0][i], slopes[1][i], slopes[2][i]);
  }
}

Simplifier::Simplifier(const std::vector<Vertex>& vertices, Indices indices)
    : vertices_(vertices), indices_(std::move(indices)) {
  left_ = indices_.size() / 3;
  gone_.resize(left_);
  attributes_.resize(vertices_.size());
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      attributes_[i][k] = static_cast<float>(vertices_[i].colour[k]) / (255 * kWrongColour);
      attributes_[i][k + 3] = vertices_[i].normal[static_cast<int>(k)] / kWrongNormal;
    }
  join_vertices();
  add_surface();
  add_edges();
  for (std::uint32_t i = 0; i < places_.size(); ++i)
    enqueue(i, best(i).cost_m);
}

// Finds the places. Triangles at vertices beyond the first few of a place get a similar one of
// these.
void Simplifier::join_vertices() {
  struct Key {
    glm::vec3 position;
    std::uint32_t leaf;
  };
  std::vector<Key> keys;
  keys.reserve(vertices_.size());
  for (const Vertex& v : vertices_)
    keys.push_back({v.position + 0.0F, v.leaf});  // −0 is 0
  const std::size_t count = number(keys, place_of_);
  Indices used(count);
  first_.resize(count + 1);
  for (const std::uint32_t place : place_of_)
    if (first_[place + 1] < kMaxMembers) ++first_[place + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  members_.resize(first_.back());
  Indices joined(vertices_.size());
  for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t place = place_of_[i];
    joined[i] = i;
    if (used[place] < kMaxMembers)
      members_[first_[place] + used[place]++] = i;
    else
      joined[i] = fitting(i, vertices_[i].normal);
  }
  for (std::uint32_t& i : indices_)
    i = joined[i];
  places_.resize(count);
  positions_.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i)
    positions_.push_back(vertices_[members_[first_[i]]].position);
  around_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i)
    places_[i].parent = i;
}

void Simplifier::add_surface() {
  looks_.resize(vertices_.size());
  for (std::size_t i = 0; i < looks_.size(); ++i)
    looks_[i].low = looks_[i].high = attributes_[i];
  glm::vec3 low(1e30F), high(-1e30F);
  for (std::uint32_t t = 0; t < gone_.size(); ++t) {
    const std::uint32_t* corner = &indices_[3 * std::size_t{t}];
    const glm::vec3 a = vertices_[corner[0]].position;
    const glm::vec3 ab = vertices_[corner[1]].position - a, ac = vertices_[corner[2]].position - a;
    const glm::vec3 across = glm::cross(ab, ac);
    const float length = glm::length(across), share_m2 = length / 6;
    const glm::vec3 normal = across / length;
    const glm::vec3 along_b = glm::cross(ac, normal) / length;
    const glm::vec3 along_c = glm::cross(normal, ab) / length;
    Looks part;
    part.area_m2 = share_m2;
    const Attributes &of_a = attributes_[corner[0]], &of_b = attributes_[corner[1]],
                     &of_c = attributes_[corner[2]];
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      const glm::vec3 gradient = (of_b[i] - of_a[i]) * along_b + (of_c[i] - of_a[i]) * along_c;
      part.sum.add(gradient, share_m2);
      for (int k = 0; k < 3; ++k)
        part.slopes[static_cast<std::size_t>(k)][i] = share_m2 * gradient[k];
      part.low[i] = std::min({of_a[i], of_b[i], of_c[i]});
      part.high[i] = std::max({of_a[i], of_b[i], of_c[i]});
    }
    for (int k = 0; k < 3; ++k) {
      looks_[corner[k]].add(part);
      const std::uint32_t at = place_at(t, k);
      Place& place = places_[at];
      place.surface.add(normal, share_m2);
      place.weight_m2 += share_m2;
      ++place.triangles;
      around_[at].push_back(t);
      low = glm::min(low, positions_[at]), high = glm::max(high, positions_[at]);
    }
  }
  slack_m_ = kSlack * glm::length(high - low);
}

// Adds planes through the edges at which the surface or its looks end. They keep these lines.
void Simplifier::add_edges() {
  std::vector<std::uint64_t> keys;
  keys.reserve(indices_.size());
  const auto end_of = [](std::size_t i) { return i % 3 == 2 ? i - 2 : i + 1; };
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    const auto [a, b] = std::minmax(place_of_[indices_[i]], place_of_[indices_[end_of(i)]]);
    keys.push_back(std::uint64_t{a} << 32 | b);
  }
  Indices edges;
  struct Edge {
    std::uint32_t low = 0, high = 0, triangles = 0;
    bool is_seam = false;
  };
  std::vector<Edge> found(number(keys, edges));
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    std::uint32_t a = indices_[i], b = indices_[end_of(i)];
    if (place_of_[a] > place_of_[b]) std::swap(a, b);
    Edge& edge = found[edges[i]];
    if (edge.triangles++ == 0) edge.low = a, edge.high = b;
    edge.is_seam = edge.is_seam || edge.low != a || edge.high != b;
  }
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    const Edge& edge = found[edges[i]];
    if (edge.triangles == 2 && !edge.is_seam) continue;
    const std::size_t first = i - i % 3;
    const auto at = [&](std::size_t k) { return vertices_[indices_[k]].position; };
    const glm::vec3 along = at(end_of(i)) - at(i);
    const glm::vec3 out =
        glm::cross(along, glm::cross(at(first + 1) - at(first), at(first + 2) - at(first)));
    const float weight_m2 = (edge.triangles == 1 ? kBorder : kSeam) * glm::dot(along, along),
                length = glm::length(out);
    if (!(length > 0)) continue;
    for (const std::size_t k : {i, end_of(i)}) {
      Place& place = places_[place_of_[indices_[k]]];
      place.surface.add(out / length, weight_m2);
      place.weight_m2 += weight_m2;
    }
  }
}

const Indices& Simplifier::around(std::uint32_t place) {
  if (around_[place].size() != places_[place].triangles)
    std::erase_if(around_[place], [&](std::uint32_t t) { return gone_[t]; });
  return around_[place];
}

void Simplifier::enqueue(std::uint32_t place, float cost_m) {
  if (places_[place].triangles == 0 || std::exchange(places_[place].is_queued, true)) return;
  queue_.push({cost_m, place});
}

Simplifier::Attributes Simplifier::step(std::uint32_t from, std::uint32_t to) const {
  Attributes step;
  for (std::size_t i = 0; i < step.size(); ++i)
    step[i] = attributes_[to][i] - attributes_[from][i];
  return step;
}

Simplifier::Successor Simplifier::successor(std::uint32_t vertex, std::uint32_t to) const {
  const glm::vec3 way = positions_[to] - vertices_[vertex].position;
  const float sum = looks_[vertex].sum.at(way);
  const Attributes change = looks_[vertex].change(way);
  Successor best{0, 1e30F};
  for (const std::uint32_t member : members(to)) {
    const float wrong_m2 = looks_[vertex].at(sum, change, step(vertex, member));
    if (wrong_m2 < best.wrong_m2) best = {member, wrong_m2};
  }
  // The area, if the difference is that large, or what the range of the looks allows.
  const Looks &a = looks_[vertex], &b = looks_[best.vertex];
  float range = 0;
  for (std::size_t i = 0; i < a.low.size(); ++i) {
    const float width = std::max(a.high[i], b.high[i]) - std::min(a.low[i], b.low[i]);
    range += width * width;
  }
  best.wrong_m2 = std::clamp(best.wrong_m2 + b.sum.value, 0.0F,
                             std::min(range, 1.0F) * (a.area_m2 + b.area_m2));
  return best;
}

Simplifier::Collapse Simplifier::cost(std::uint32_t from, std::uint32_t to) const {
  const Place &a = places_[from], &b = places_[to];
  const float square = std::max({a.surface.at(positions_[to] - positions_[from]) / a.weight_m2,
                                 b.surface.value / b.weight_m2, 0.0F});
  float wrong_m2 = 0;
  for (const std::uint32_t member : members(from))
    wrong_m2 += successor(member, to).wrong_m2;
  const float cost_m = std::sqrt(square) + kLooks * std::sqrt(wrong_m2);
  return {std::isfinite(cost_m) ? cost_m : 1e30F, std::sqrt(square), to, true};
}

bool Simplifier::flips(std::uint32_t from, std::uint32_t to) const {
  for (const std::uint32_t t : around_[from]) {
    std::array<glm::vec3, 3> before, after;
    bool vanishes = false;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const std::uint32_t place = place_at(t, k);
      vanishes = vanishes || place == to;
      before[i] = positions_[place];
      after[i] = place == from ? positions_[to] : before[i];
    }
    if (vanishes) continue;
    const glm::vec3 old = glm::cross(before[1] - before[0], before[2] - before[0]);
    const glm::vec3 ab = after[1] - after[0], ac = after[2] - after[0], bc = after[2] - after[1];
    const glm::vec3 now = glm::cross(ab, ac);
    const float length = glm::length(now);
    const float side_m2 = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    if (length <= kThinnest * side_m2 || glm::dot(old, now) < kMaxTurn * glm::length(old) * length)
      return true;
  }
  return false;
}

Simplifier::Collapse Simplifier::best(std::uint32_t from) {
  if (places_[from].triangles > kMaxTriangles) return {};
  others_.clear();
  for (const std::uint32_t t : around(from))
    for (int k = 0; k < 3; ++k)
      if (place_at(t, k) != from) others_.push_back(place_at(t, k));
  std::ranges::sort(others_);
  others_.erase(std::unique(others_.begin(), others_.end()), others_.end());
  found_.clear();
  for (const std::uint32_t to : others_)
    found_.push_back(cost(from, to));
  const auto tried = std::span(found_).first(std::min(found_.size(), kMaxTries));
  std::ranges::partial_sort(found_, found_.begin() + std::ssize(tried), {},
                            [](const Collapse& c) { return std::pair(c.cost_m, c.to); });
  const auto fits = [&](const Collapse& c) { return !flips(from, c.to); };
  const auto first = std::ranges::find_if(tried, fits);
  work_ += found_.size() + around_[from].size() * static_cast<std::size_t>(first - tried.begin());
  return first == tried.end() ? Collapse{} : *first;
}

void Simplifier::collapse(std::uint32_t from, const Collapse& how) {
  const glm::vec3 way = positions_[how.to] - positions_[from];
  std::array<std::uint32_t, kMaxMembers> successors{};
  const std::span<const std::uint32_t> own = members(from);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::uint32_t vertex = own[i], to = successor(vertex, how.to).vertex;
    successors[i] = to;
    looks_[vertex].move(way, step(vertex, to));
    looks_[to].add(looks_[vertex]);
  }
  Place &a = places_[from], &b = places_[how.to];
  a.surface.move(way);
  b.surface.add(a.surface);
  b.weight_m2 += a.weight_m2;
  a.parent = how.to;
  for (const std::uint32_t t : std::exchange(around_[from], {})) {
    if (gone_[t]) continue;
    std::uint32_t* const corners = &indices_[3 * std::size_t{t}];
    const bool vanishes =
        std::ranges::count(std::array{0, 1, 2}, how.to, [&](int k) { return place_at(t, k); }) > 0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t place = place_at(t, k);
      if (vanishes) --places_[place].triangles;
      if (place != from) {
        enqueue(place, how.cost_m);
      } else if (!vanishes) {
        const auto member = std::ranges::find(own, corners[k]);
        corners[k] = successors[static_cast<std::size_t>(member - own.begin())];
      }
    }
    if (vanishes) {
      gone_[t] = true, --left_;
    } else {
      around_[how.to].push_back(t);
      ++b.triangles;
    }
  }
  a.triangles = 0;
  enqueue(how.to, how.cost_m);
  error_m_ = std::max(error_m_, how.error_m);
}

void Simplifier::reduce_to(std::size_t triangles) {
  while (left_ > triangles && !queue_.empty() && work_ < kWork * gone_.size()) {
    const Entry entry = queue_.top();
    queue_.pop();
    places_[entry.place].is_queued = false;
    if (places_[entry.place].triangles == 0) continue;
    const Collapse found = best(entry.place);
    if (!found.is_possible) continue;  // until a neighbour collapses
    if (found.cost_m > kRise * entry.cost_m + slack_m_)
      enqueue(entry.place, found.cost_m);
    else
      collapse(entry.place, found);
  }
}

Indices Simplifier::indices() const {
  Indices left;
  for (std::size_t t = 0; t < gone_.size(); ++t)
    if (!gone_[t]) left.insert(left.end(), &indices_[3 * t], &indices_[3 * t] + 3);
  return left;
}

std::uint32_t Simplifier::place_now(std::uint32_t triangle, int corner) {
  std::uint32_t place = place_at(triangle, corner);
  while (places_[place].parent != place)
    place = places_[place].parent = places_[places_[place].parent].parent;
  return place;
}

// Compares the goal with a place's triangles. Those at seen places were compared there.
void Simplifier::look_around(std::uint32_t place, std::span<const std::uint32_t> seen,
                             const Goal& goal, Match& best) {
  const std::size_t count = std::min(around(place).size(), std::size_t{kMaxTriangles});
  const auto is_seen = [&](std::uint32_t at) {
    return places_[at].triangles <= kMaxTriangles && std::ranges::find(seen, at) != seen.end();
  };
  for (const std::uint32_t t : std::span(around_[place]).first(count)) {
    const std::array at{place_at(t, 0), place_at(t, 1), place_at(t, 2)};
    if (std::ranges::any_of(at, is_seen)) continue;
    const std::array<glm::dvec3, 3> corners{positions_[at[0]], positions_[at[1]],
                                            positions_[at[2]]};
    const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (glm::dot(across, glm::dvec3(goal.facing)) <= 0) continue;
    const double off = glm::dot(across, glm::dvec3(goal.position) - corners[0]);
    const auto known_m = static_cast<double>(best.distance_m);
    if (off * off > known_m * known_m * glm::dot(across, across)) continue;  // its plane is farther
    const glm::dvec3 w = nearest_weights(goal.position, corners);
    const auto distance_m = static_cast<float>(glm::length(
        w.x * corners[0] + w.y * corners[1] + w.z * corners[2] - glm::dvec3(goal.position)));
    if (distance_m < best.distance_m) best = {t, w, distance_m, true};
  }
}

Simplifier::Match Simplifier::nearest(std::uint32_t triangle, const Goal& goal) {
  Match best{triangle, glm::vec3(0.0F), 1e30F, false};
  std::array<std::uint32_t, kMaxWalk> seen{};
  auto end = seen.begin();
  for (std::uint32_t around = triangle;; around = best.triangle) {
    const auto before = end;
    for (int k = 0; k < 3 && end != seen.end(); ++k) {
      const std::uint32_t place = place_now(around, k);
      if (std::find(seen.begin(), end, place) != end) continue;
      look_around(place, {seen.begin(), end}, goal, best);
      *end++ = place;
    }
    if (end == before) return best;
  }
}

std::uint32_t Simplifier::fitting(std::uint32_t vertex, const glm::vec3& direction) const {
  const auto fit = [&](std::uint32_t v) { return glm::dot(vertices_[v].normal, direction); };
  return *std::ranges::max_element(
      members(place_of_[vertex]),
      [&](std::uint32_t a, std::uint32_t b) { return fit(a) < fit(b); });
}

}  // namespace psygen::handmade
