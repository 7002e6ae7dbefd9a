#include "game/play/route.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "engine/query/path_finder.hpp"

namespace cairns {
namespace {

constexpr double kMinSiteUp = 0.90, kStartUp = 0.966;  // normal.y of slopes of 26° and 15°
constexpr double kHighestStartM = 110, kHighestM = 200, kDryM = 1.5;
constexpr double kProminentM = 9;  // more gains nothing
constexpr double kMinWayM = 200, kMaxWayM = 360, kApartM = 120, kHillsM = 45;
constexpr std::size_t kMaxCells = 60'000;  // enough for a path of a few hundred metres
constexpr int kTries = 24, kMaxTries = 192, kRings = 160, kPlacesOfRing = 48, kTurns = 5;
constexpr std::size_t kStarts = 8;
constexpr double kStartsApartM = 240, kRingM = 24, kNearRings = 40;
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

bool near_any(const core::WorldPosition& at, std::span<const core::WorldPosition> others,
              double near_m, double block_m) {
  return std::ranges::any_of(others, [&](const core::WorldPosition& other) {
    return distance_m(at, other, block_m) < near_m;
  });
}

// Heights of the ground around a position.
struct Around {
  double mean_m = 0, lowest_m = 1e9, highest_m = -1e9;
};
Around around(query::World& query, const core::WorldPosition& at, double far_m) {
  constexpr int kPlaces = 8;
  Around found;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = i * 2 * std::numbers::pi / kPlaces;
    core::WorldPosition there = at;
    there.local += far_m * glm::dvec3(std::cos(angle), 0, std::sin(angle));
    const auto ground = query.ground(there);
    if (!ground) continue;
    found.mean_m += ground->height_m / kPlaces;
    found.lowest_m = std::min(found.lowest_m, ground->height_m);
    found.highest_m = std::max(found.highest_m, ground->height_m);
  }
  return found;
}

// A possible site of a cairn, and the heading that leads there.
struct Candidate {
  core::WorldPosition at;
  double heading = 0, score = 0;
};

// Returns sites ahead, best first, away from those that the route has.
std::vector<Candidate> candidates(query::World& query, const core::WorldPosition& from,
                                  double heading, std::span<const core::WorldPosition> others,
                                  core::RandomStream& random) {
  std::vector<Candidate> found;
  for (int k = 0; k < kMaxTries && (k < kTries || found.empty()); ++k) {
    const double angle = heading + random.next_real(-0.6, 0.6) * (1 + 3.0 * k / kTries);
    const double far_m = random.next_real(kMinWayM, kMaxWayM);
    core::WorldPosition at = from;
    at.local += far_m * glm::dvec3(std::sin(angle), 0, -std::cos(angle));
    if (!dry_ground(query, at, kMinSiteUp, kHighestM)) continue;
    if (near_any(at, others, kApartM, query.world().block_size_m())) continue;
    // Sites that are seen from afar come first, and ways that climb or offer a flight.
    const double prominence_m = at.local.y - around(query, at, kSeenFromM).mean_m;
    const double change_m = std::abs(at.local.y - from.local.y);
    found.push_back(
        {at, angle, std::min(prominence_m, kProminentM) + std::min(change_m / 4, kProminentM)});
  }
  std::ranges::stable_sort(found, std::greater(), &Candidate::score);
  return found;
}

// Returns the route that begins here, or none if a cairn finds no site.
std::optional<Route> route_from(query::World& query, query::PathFinder& finder,
                                const core::WorldPosition& start) {
  Route route{start, {}};
  core::WorldPosition from = start;
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
      const auto found = candidates(query, from, ahead, std::span(route.cairns).first(i), random);
      const auto best = std::ranges::find_if(
          found, [&](const Candidate& site) { return finder.reaches(from, site.at); });
      if (best != found.end()) next = *best;
    }
    if (!next) return std::nullopt;
    route.cairns[i] = from = next->at;
    heading = next->heading;
  }
  return route;
}

// Tries suitable starts on growing circles around the centre of the land, among hills of at least
// this height and apart from those tried before. Returns the first route, or none.
std::optional<Route> first_route(query::World& query, double highest_m, double hills_m,
                                 std::vector<core::WorldPosition>& tried) {
  query::PathFinder finder(query, {.max_cells = kMaxCells});
  const std::size_t end = tried.size() + kStarts;
  for (int ring = 0; ring < kRings; ++ring) {
    // Land may be far away.
    const double far_m = kRingM * ring * std::max(1.0, ring / kNearRings);
    const int places = std::clamp(6 * ring, 1, kPlacesOfRing);
    for (int i = 0; i < places; ++i) {
      const double angle = i * 2 * std::numbers::pi / places;
      core::WorldPosition at;
      at.local = far_m * glm::dvec3(std::cos(angle), 0, std::sin(angle));
      if (!dry_ground(query, at, kStartUp, highest_m)) continue;
      if (near_any(at, tried, kStartsApartM, query.world().block_size_m())) continue;
      const Around land = around(query, at, kMinWayM);
      if (land.highest_m - land.lowest_m < hills_m) continue;
      if (auto route = route_from(query, finder, at)) return route;
      tried.push_back(at);
      if (tried.size() == end) return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

core::Result<Route> find_route(query::World& query) {
  std::vector<core::WorldPosition> tried;
  auto route = first_route(query, kHighestStartM, kHillsM, tried);
  if (!route) route = first_route(query, kHighestM, 0, tried);
  if (route) return *route;
  return core::invalid_argument("this land has no route for twelve cairns; choose another seed");
}

}  // namespace cairns
