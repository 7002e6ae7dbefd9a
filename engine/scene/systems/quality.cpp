// The one loop that steers how fine pictures are: fewer pixels of the landscape and then a larger
// error where frames take too long (governor), a larger error where what is seen needs more memory
// than there is (coarsening); and how long pictures have lacked something.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/log.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

// Under pressure of memory everything gets coarser, and finer again when there is room: quickly up,
// slowly down.
constexpr float kUp = 1.15F, kDown = 0.99F, kCoarsest = 64.0F;

std::string what_is_small(const synthesis::CacheStats& stats) {
  const std::uint64_t capacity_mib = stats.capacity_bytes >> 20;
  if (capacity_mib >= stats.budget_bytes >> 20) return "the geometry budget";
  return fmt::format("the memory that the system has for geometry ({} MiB)", capacity_mib);
}

void warn_once(const Settings& settings, const synthesis::CacheStats& stats, Quality& quality) {
  if (std::exchange(quality.warned_budget, true)) return;
  core::log_warning(fmt::format("{} is too small for this view{}", what_is_small(stats),
                                settings.levels_of_detail
                                    ? "; drawing coarser levels"
                                    : " at full detail; some of it is missing"));
}

void adapt_to_memory(const Settings& settings, const Rules& rules, const Pressure& pressure,
                     const synthesis::MeshSupply& meshes, Quality& quality) {
  // Finer levels of what is seen need room, and so does what is around. Lazy evaluation has no next
  // tick in which to come again, and may make a picture while the last two, still in flight, hold
  // their memory: three must fit.
  const double roomy = rules.wait ? 0.28 : 0.5;
  const bool too_late = rules.wait && (pressure.waiting > 0 || pressure.seen_share > 1.0 / 3);
  if (pressure.refused_visible > 0 || too_late) {
    quality.coarsening = std::min(quality.coarsening * kUp, kCoarsest);
    warn_once(settings, meshes.stats(), quality);
  } else if (pressure.seen_share < roomy) {
    quality.coarsening = std::max(quality.coarsening * kDown, 1.0F);
  }
}

// The share of width and height that leaves at most 1 / relief of the pixels, in steps: nobody sees
// one of them, and most frames scale like the one before.
double resolution_for(double relief, double least) {
  constexpr double kSteps = 20, kBeyondRounding = 1e-9;
  return std::max(std::floor(kSteps / std::sqrt(relief) + kBeyondRounding) / kSteps, least);
}

}  // namespace

double pixel_relief_of(const Settings& settings) {
  return 1 / (settings.min_resolution * settings.min_resolution);
}

void set_detail(const Settings& settings, Quality& quality) {
  const double relief = quality.governor.relief(), by_pixels = pixel_relief_of(settings);
  quality.resolution = resolution_for(std::min(relief, by_pixels), settings.min_resolution);
  const double factor = std::max(relief / by_pixels, 1.0);
  const double unhurried = settings.max_error_pixels * double{quality.coarsening};
  quality.error_pixels = unhurried * factor;
  quality.model_error_pixels = unhurried * std::sqrt(factor);
}

void quality_system(const Settings& settings, const Rules& rules, const Input& input,
                    const Pressure& pressure, const synthesis::MeshSupply& meshes,
                    Quality& quality) {
  adapt_to_memory(settings, rules, pressure, meshes, quality);
  quality.awaiting_since_s = pressure.awaited > 0
                                 ? std::min(quality.awaiting_since_s, pressure.at_s)
                                 : std::numeric_limits<double>::infinity();
  quality.governor.observe(input.frame_ms, input.frame_triangles);
  quality.draft = input.draft;
  set_detail(settings, quality);
}

}  // namespace psygen::scene
