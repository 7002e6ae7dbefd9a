#include "engine/world/river_course.hpp"

#include <algorithm>

#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

// Where a river flows: its curve with its widths.
class Course {
 public:
  Course(const World& world, const River& river)
      : river_(river), curve_(river_curve(world, river)) {
    for (const CurvePoint& point : curve_)
      box_.add(point.at_m);
  }

  // True if a place lies in its water.
  bool covers(glm::dvec2 at_m) const {
    if (!river_.enabled) return false;
    const double widest_m = *std::ranges::max_element(river_.width_m);
    if (!box_.touches(FlatBox::around(at_m, at_m), widest_m)) return false;
    for (std::size_t i = 0; i + 1 < curve_.size(); ++i) {
      const CurvePoint &from = curve_[i], &to = curve_[i + 1];
      const double share = nearest_share(from.at_m, to.at_m, at_m);
      const double width_m =
          value_at(river_.width_m, from) * (1 - share) + value_at(river_.width_m, to) * share;
      if (length_of(at_m - from.at_m - (to.at_m - from.at_m) * share) <= width_m / 2) return true;
    }
    return false;
  }

 private:
  const River& river_;
  std::vector<CurvePoint> curve_;
  FlatBox box_;
};

}  // namespace

std::vector<CurvePoint> river_curve(const World& world, const River& river) {
  const double narrowest_m = *std::ranges::min_element(river.width_m);
  return curve_through(river.points_m,
                       std::max(2 * world.cell_m(), std::clamp(narrowest_m / 2, 3.0, 10.0)));
}

double value_at(const std::vector<double>& list, const CurvePoint& at) {
  if (list.size() == 1) return list.front();
  const double from = list[at.after];
  return at.share > 0 ? from + at.share * (list[at.after + 1] - from) : from;
}

RiverOrder river_order(const World& world, const std::vector<River>& rivers) {
  std::vector<Course> courses;
  courses.reserve(rivers.size());
  for (const River& river : rivers)
    courses.emplace_back(world, river);
  const std::size_t n = rivers.size();
  // after[i][k]: river i is made after river k, because it begins in k, or because it ends in k and
  // k does not begin in it.
  std::vector<std::vector<bool>> after(n, std::vector<bool>(n, false));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      after[i][k] = i != k && courses[k].covers(rivers[i].points_m.front());
  RiverOrder result;
  result.flows_on.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (i == k || !courses[k].covers(rivers[i].points_m.back())) continue;
      result.flows_on[i] = true;
      if (!after[k][i]) after[i][k] = true;
    }
  }
  std::vector<std::size_t>& order = result.order;
  std::vector<bool> done(n, false);
  while (order.size() < n) {
    std::size_t next = n;
    for (std::size_t i = 0; i < n && next == n; ++i) {
      bool ready = !done[i];
      for (std::size_t k = 0; ready && k < n; ++k)
        ready = !after[i][k] || done[k];
      if (ready) next = i;
    }
    if (next == n) return {};
    done[next] = true;
    order.push_back(next);
  }
  return result;
}

}  // namespace psygen::world
