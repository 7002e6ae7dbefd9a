#include "engine/visibility/horizon.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace psygen::visibility {
namespace {

constexpr double kBinCount = Horizon::kBins;
constexpr double kTolerance = 1e-3;  // of a bin, for touching ends and for sides of boxes
constexpr double kSlack = 1e-5;  // more than all rounding errors; a hundredth of a pixel or less
constexpr double kNoDistance = 1e-3;  // nearer points have no direction
constexpr float kNothing = -std::numeric_limits<float>::infinity();

// Directions in bins, ascending from +X over +Z. |x| + |z| = 1 is divided evenly, which is
// monotonic in the angle and needs one division.
double bins_of(double x, double z) {
  const double quarter = kBinCount / 4 / (std::abs(x) + std::abs(z));
  if (z >= 0) return x >= 0 ? z * quarter : kBinCount / 4 - x * quarter;
  if (x < 0) return kBinCount / 2 - z * quarter;
  const double bins = kBinCount * 3 / 4 + x * quarter;
  return bins < kBinCount ? bins : 0;
}

std::size_t wrapped(std::int64_t bin) {
  return static_cast<std::size_t>(bin) % Horizon::kBins;  // a power of two: works for negative bins
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

struct Horizon::Point {
  glm::dvec2 ground;  // x, z
  double height, distance, tangent, bins;

  explicit Point(const glm::vec3& p)
      : ground(p.x, p.z),
        height(static_cast<double>(p.y)),
        distance(glm::length(ground)),
        tangent(height / distance),
        bins(has_direction() ? bins_of(ground.x, ground.y) : 0) {}
  bool has_direction() const { return distance > kNoDistance; }  // false for NaN
};

// The part of a followed line that lies in one bin.
struct Horizon::Piece {
  std::int64_t bin = 0;
  double end = 0;                    // where the line came from, in the bin: 0 … 1
  double tangent = 0, distance = 0;  // smallest and largest so far

  explicit Piece(const Point& start)
      : bin(static_cast<std::int64_t>(start.bins)),
        end(start.bins - static_cast<double>(bin)),
        tangent(start.tangent),
        distance(start.distance) {}
  void start(std::int64_t at_bin, double at, double t, double d) {
    bin = at_bin;
    end = at;
    tangent = t;
    distance = d;
  }
  void include(double t, double d) {
    tangent = std::min(tangent, t);
    distance = std::max(distance, d);
  }
};

Horizon::Horizon() {
  for (std::size_t i = 0; i < kBins; ++i) {
    const double f = static_cast<double>(i % (kBins / 4)) / (kBinCount / 4);
    const glm::dvec2 first(1 - f, f);  // in the first quarter
    const std::size_t quarter = i / (kBins / 4);
    const glm::dvec2 turned = quarter % 2 == 0 ? first : glm::dvec2(-first.y, first.x);
    border_[i] = glm::normalize(quarter < 2 ? turned : -turned);
  }
  for (std::size_t i = 0; i < kBins; ++i) {
    const glm::dvec2 a = glm::abs(border_[i]), b = glm::abs(border_[(i + 1) % kBins]);
    inverse_x_[i] = static_cast<float>(1 / std::max(a.x, b.x));
    inverse_z_[i] = static_cast<float>(1 / std::max(a.y, b.y));
  }
  reset();
}

void Horizon::reset() {
  tangent_.fill(kNothing);
  distance_m_.fill(0);
  for (auto& band : within_)
    band.fill(kNothing);
  left_.fill({0, kNothing, 0});
  right_.fill({1, kNothing, 0});
}

// Number of bands that end at or before `distance_m`.
std::size_t Horizon::bands_within(float distance_m) {
  static_assert(kFirstBandM == 16);
  constexpr int kBias = 127 + 4 - 1;  // exponent of a float at 16 m, minus one
  const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(distance_m) >> 23);
  return static_cast<std::size_t>(std::clamp(exponent - kBias, 0, static_cast<int>(kBands)));
}

void Horizon::raise(std::size_t bin, float tangent, float distance_m) {
  for (std::size_t band = bands_within(std::nextafter(distance_m, 0.0F)) + 1;
       band <= kBands && within_[band][bin] < tangent; ++band)
    within_[band][bin] = tangent;
  if (tangent <= tangent_[bin]) return;
  tangent_[bin] = tangent;
  distance_m_[bin] = distance_m;
}

// Records a piece that ends at `other_end`. It covers its bin, or a part of it that may join
// another.
void Horizon::place(const Piece& piece, double other_end) {
  // Along a straight line the elevation is A · cos(angle − angle0). If it is negative, its
  // minimum may lie inside the bin. That minimum is lower than both ends by a factor of at most 1 /
  // cos(half the width of the bin), which exceeds 1 by less than kSlack.
  static_assert(8 / kBinCount * (8 / kBinCount) / 8 < kSlack);
  const auto tangent = static_cast<float>(piece.tangent - kSlack * (1 + std::abs(piece.tangent)));
  const auto distance_m = static_cast<float>(piece.distance * (1 + kSlack));
  const auto low = static_cast<float>(std::min(piece.end, other_end)),
             high = static_cast<float>(std::max(piece.end, other_end));
  constexpr auto kNear = static_cast<float>(kTolerance);
  const bool from_left = low <= kNear, to_right = high >= 1 - kNear;
  const std::size_t bin = wrapped(piece.bin);
  if (from_left && to_right) return raise(bin, tangent, distance_m);
  if (!from_left && !to_right) return;
  Part &left = left_[bin], &right = right_[bin];
  // A part is replaced unless the old one is better in both respects.
  if (from_left && (tangent > left.tangent || high > left.end)) left = {high, tangent, distance_m};
  if (to_right && (tangent > right.tangent || low < right.end)) right = {low, tangent, distance_m};
  if (left.end >= right.end - kNear)
    raise(bin, std::min(left.tangent, right.tangent), std::max(left.distance_m, right.distance_m));
}

// Follows a straight line from bin to bin. It leads one way around the camera.
void Horizon::follow(const Point& from, const Point& to, bool forward, Piece& piece) {
  const auto first = static_cast<std::int64_t>(from.bins);
  auto last = static_cast<std::int64_t>(to.bins);
  if (forward && to.bins < from.bins) last += static_cast<std::int64_t>(kBins);
  if (!forward && to.bins > from.bins) last -= static_cast<std::int64_t>(kBins);
  // A line spans at most half a turn; more is a rounding error near zero.
  const bool spans = std::abs(last - first) <= static_cast<std::int64_t>(kBins / 2 + 1);
  const std::int64_t step = forward ? 1 : -1;
  for (std::int64_t bin = first; spans && bin != last; bin += step) {
    const glm::dvec2& border = border_[wrapped(forward ? bin + 1 : bin)];
    // The line meets the border in the ratio of its ends' distances from it.
    const double a = std::abs(cross(to.ground, border)), b = std::abs(cross(from.ground, border));
    const double distance = a * glm::dot(from.ground, border) + b * glm::dot(to.ground, border);
    const double tangent = (a * from.height + b * to.height) / distance;
    piece.include(tangent, distance / (a + b));
    place(piece, forward ? 1 : 0);
    piece.start(bin + step, forward ? 0 : 1, tangent, distance / (a + b));
  }
  piece.include(to.tangent, to.distance);
}

void Horizon::add(std::span<const glm::vec3> line) {
  if (line.size() < 2) return;
  Point from(line[0]);
  Piece piece(from);
  int way = 0;  // around the camera: 1 forward, −1 backward, 0 neither
  const auto finish = [&] {
    if (way != 0) place(piece, from.bins - std::floor(from.bins));
    piece = Piece(from);
  };
  for (const glm::vec3& point : line.subspan(1)) {
    const Point to(point);
    const double turn = cross(from.ground, to.ground);
    int to_way = turn > 0 ? 1 : turn < 0 ? -1 : 0;
    if (!from.has_direction() || !to.has_direction()) to_way = 0;
    if (to_way != way) finish();
    way = to_way;
    if (way != 0) follow(from, to, way > 0, piece);
    from = to;
    if (way == 0) piece = Piece(from);
  }
  finish();
}

// A query. `near` is the distance of the box's near sides along both axes, 0 for none.
struct Horizon::Box {
  glm::vec2 near;
  float far_m, top_m;
  const float* within;  // the last band before the box
};

// For bins first … last. In every direction of a bin the box begins at `begin` or farther.
bool Horizon::hides_in(std::size_t first, std::size_t last, const Box& box) const {
  constexpr std::size_t kBlock = 16;
  for (std::size_t block = first; block <= last; block += kBlock) {
    const std::size_t end = std::min(block + kBlock, last + 1);
    int seen = 0;
    for (std::size_t bin = block; bin < end; ++bin) {
      const float begin = std::max(box.near.x * inverse_x_[bin], box.near.y * inverse_z_[bin]);
      const float at = box.top_m > 0 ? begin : box.far_m;  // where the top appears highest
      const float before = distance_m_[bin] <= begin ? tangent_[bin] : kNothing;
      const float tangent = box.within != nullptr ? std::max(before, box.within[bin]) : before;
      seen |= static_cast<int>(!(box.top_m < tangent * at));
    }
    if (seen != 0) return false;
  }
  return true;
}

bool Horizon::hides(const core::Bounds& box) const {
  const int side_x = box.min.x > 0   ? 1
                     : box.max.x < 0 ? -1
                                     : 0,
            side_z = box.min.z > 0   ? 1
                     : box.max.z < 0 ? -1
                                     : 0;
  if (side_x == 0 && side_z == 0) return false;
  // The corners that are first and last, turning from +X over +Z.
  const bool first_max_x = side_z > 0 || (side_z == 0 && side_x < 0),
             last_max_x = side_z < 0 || (side_z == 0 && side_x < 0),
             first_max_z = side_x < 0 || (side_x == 0 && side_z < 0),
             last_max_z = side_x > 0 || (side_x == 0 && side_z < 0);
  const double begin =
      bins_of(first_max_x ? box.max.x : box.min.x, first_max_z ? box.max.z : box.min.z) -
      kTolerance;
  double end =
      bins_of(last_max_x ? box.max.x : box.min.x, last_max_z ? box.max.z : box.min.z) + kTolerance;
  if (end < begin) end += kBinCount;
  // Counted from one turn before, which keeps everything positive.
  const auto first = static_cast<std::size_t>(begin + kBinCount),
             last = static_cast<std::size_t>(end + kBinCount), wrap = first / kBins * kBins;
  const glm::vec2 near(side_x > 0   ? box.min.x
                       : side_x < 0 ? -box.max.x
                                    : 0.0F,
                       side_z > 0   ? box.min.z
                       : side_z < 0 ? -box.max.z
                                    : 0.0F);
  const float far_m = glm::length(glm::vec2(std::max(std::abs(box.min.x), std::abs(box.max.x)),
                                            std::max(std::abs(box.min.z), std::abs(box.max.z))));
  const Box asked{near, far_m, box.max.y, within_[bands_within(glm::length(near))].data()};
  if (last < wrap + kBins) return hides_in(first - wrap, last - wrap, asked);
  return hides_in(first - wrap, kBins - 1, asked) && hides_in(0, last - wrap - kBins, asked);
}

float Horizon::elevation(float x, float z) const {
  return tangent_[static_cast<std::size_t>(bins_of(x, z))];
}

}  // namespace psygen::visibility
