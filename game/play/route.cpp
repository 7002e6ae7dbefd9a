#include "game/play/route.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/query/path_finder.hpp"

namespace cairns {
namespace {

constexpr double kMinSiteUp = 0.90, kStartUp = 0.966;  // normal.y of slopes of 26° and 15°
constexpr double kHighestStartM = 110, kHighestM = 200, kDryM = 1.5;
constexpr double kProminentM = 9;  // more gains nothing
constexpr double kMinWayM = 200, kMaxWayM = 360;
constexpr std::size_t kMaxCells = 60'000;  // enough for a path of a few hundred metres
constexpr int kTries = 24, kMaxTries = 192, kRings = 60, kTurns = 5;
constexpr double kSeenFromM = 45;  // radius of the surroundings that a site is compared with
constexpr core::Purpose kPurpose = core::Purpose::kStructure;

// Returns the ground at a position if the player can stand there, and sets the position's height.
std::optional<query::Ground> dry_ground(query::World& query, core::WorldPosition& at, double min_up,
                                        double highest_m) {
  at = core::normalised(at, query.world().block_size_m());
  const auto ground = query.ground(at);
  if (!ground || ground->normal.y < min_up || ground->height_m > highest_m) return std::nullopt;
  const auto water = world::water_surface(query.world(), at);
  if (water && ground->height_m < water->surface_m + kDryM) return std::nullopt;
  at.local.y = ground->height_m;
  return *ground;
}

// Returns the height of a position above the mean of its surroundings.
double prominence_m(query::World& query, const core::WorldPosition& at) {
  double sum_m = 0;
  constexpr int kAround = 8;
  for (int i = 0; i < kAround; ++i) {
    const double angle = i * 2 * std::numbers::pi / kAround;
    core::WorldPosition there = at;
    there.local += kSeenFromM * glm::dvec3(std::cos(angle), 0, std::sin(angle));
    if (const auto ground = query.ground(there)) sum_m += ground->height_m;
  }
  return at.local.y - sum_m / kAround;
}

// Returns the first suitable position on growing circles around the centre of the land.
std::optional<core::WorldPosition> find_start(query::World& query) {
  for (int ring = 0; ring < kRings; ++ring) {
    for (int i = 0; i <= 6 * ring; ++i) {
      const double angle = i * 2 * std::numbers::pi / std::max(6 * ring, 1);
      core::WorldPosition at;
      at.local = 24.0 * ring * glm::dvec3(std::cos(angle), 0, std::sin(angle));
      if (dry_ground(query, at, kStartUp, kHighestStartM)) return at;
    }
  }
  return std::nullopt;
}

// A possible site of a cairn, and the heading that leads there.
struct Candidate {
  core::WorldPosition at;
  double heading = 0, score = 0;
};

// Returns sites ahead, best first.
std::vector<Candidate> candidates(query::World& query, const core::WorldPosition& from,
                                  double heading, core::RandomStream& random) {
  std::vector<Candidate> found;
  for (int k = 0; k < kMaxTries && (k < kTries || found.empty()); ++k) {
    const double angle = heading + random.next_real(-0.6, 0.6) * (1 + 3.0 * k / kTries);
    const double far_m = random.next_real(kMinWayM, kMaxWayM);
    core::WorldPosition at = from;
    at.local += far_m * glm::dvec3(std::sin(angle), 0, -std::cos(angle));
    if (!dry_ground(query, at, kMinSiteUp, kHighestM)) continue;
    found.push_back({at, angle, std::min(prominence_m(query, at), kProminentM)});
  }
  std::ranges::stable_sort(found, std::greater(), &Candidate::score);
  return found;
}

}  // namespace

core::Result<Route> find_route(query::World& query) {
  const auto fail = [] {
    return core::invalid_argument("this land has no route for twelve cairns; choose another seed");
  };
  const auto start = find_start(query);
  if (!start) return fail();
  Route route{*start, {}};
  query::PathFinder finder(query, {.max_cells = kMaxCells});
  core::WorldPosition from = *start;
  core::RandomStream course(query.world().seed, 0, 0, 0, kPurpose);
  double heading = course.next_real(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < kCairns; ++i) {
    core::RandomStream random(query.world().seed, 0, 0, static_cast<std::uint32_t>(i + 1),
                              kPurpose);
    heading += random.next_real(-0.9, 0.9);
    std::optional<Candidate> next;
    // If no site ahead is reachable, the route turns.
    for (int turn = 0; turn < kTurns && !next; ++turn) {
      const double ahead = heading + turn * 2 * std::numbers::pi / kTurns;
      const auto found = candidates(query, from, ahead, random);
      const auto best = std::ranges::find_if(
          found, [&](const Candidate& site) { return finder.reaches(from, site.at); });
      if (best != found.end()) next = *best;
    }
    if (!next) return fail();
    route.cairns[i] = from = next->at;
    heading = next->heading;
  }
  return route;
}

}  // namespace cairns
