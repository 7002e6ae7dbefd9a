#include "engine/scene/frame/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/log.hpp"
#include "engine/scene/frame/frame_context.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::scene {
namespace {

// Factors on coarsening per tick: quickly up while memory is short, slowly down when it suffices.
constexpr float kUp = 1.15F, kDown = 0.99F, kCoarsest = 64.0F;

std::string scarce_memory(const synthesis::CacheStats& stats) {
  const std::uint64_t capacity_mib = stats.capacity_bytes >> 20;
  if (capacity_mib >= stats.budget_bytes >> 20) return "the geometry budget";
  return fmt::format("the memory that the system has for geometry ({} MiB)", capacity_mib);
}

void warn_once(const SceneSettings& settings, const synthesis::CacheStats& stats,
               Quality& quality) {
  if (std::exchange(quality.warned_budget, true)) return;
  core::log_warning(fmt::format("{} is too small for this view{}", scarce_memory(stats),
                                settings.levels_of_detail
                                    ? "; drawing coarser levels"
                                    : " at full detail; some of it is missing"));
}

void adapt_to_memory(const FrameContext& frame, const MemoryPressure& pressure,
                     const synthesis::MeshSupply& supply, Quality& quality) {
  // Finer meshes in view need free memory, and so do meshes around the view. Lazy evaluation has no
  // next tick to catch up in, and the last two frames, still in flight, may hold their memory:
  // three frames must fit.
  const double roomy = frame.rules.wait ? 0.28 : 0.5;
  const bool too_late = frame.rules.wait && (pressure.waiting > 0 || pressure.seen_share > 1.0 / 3);
  if (pressure.refused_visible > 0 || too_late) {
    quality.coarsening = std::min(quality.coarsening * kUp, kCoarsest);
    warn_once(frame.settings, supply.stats(), quality);
  } else if (pressure.seen_share < roomy) {
    quality.coarsening = std::max(quality.coarsening * kDown, 1.0F);
  }
}

// The fraction of width and height that leaves at most 1 / load_reduction of the pixels. Changes in
// steps: one step is not visible, and most frames keep the scale of the frame before.
double resolution_for(double load_reduction, double minimum) {
  constexpr double kSteps = 20, kBeyondRounding = 1e-9;
  return std::max(std::floor(kSteps / std::sqrt(load_reduction) + kBeyondRounding) / kSteps,
                  minimum);
}

}  // namespace

double resolution_reduction_of(const SceneSettings& settings) {
  return 1 / (settings.min_resolution * settings.min_resolution);
}

void set_detail(const SceneSettings& settings, Quality& quality) {
  const double reduction = quality.governor.load_reduction();
  const double by_resolution = resolution_reduction_of(settings);
  quality.resolution = resolution_for(std::min(reduction, by_resolution), settings.min_resolution);
  const double factor = std::max(reduction / by_resolution, 1.0);
  const double unhurried = settings.max_error_pixels * double{quality.coarsening};
  quality.error_pixels = unhurried * factor;
  quality.model_error_pixels = unhurried * std::sqrt(factor);
}

void quality_system(FrameContext frame, const Input& input, const MemoryPressure& pressure,
                    const synthesis::MeshSupply& supply, Quality& quality) {
  adapt_to_memory(frame, pressure, supply, quality);
  quality.awaiting_since_s = pressure.awaited > 0
                                 ? std::min(quality.awaiting_since_s, pressure.at_s)
                                 : std::numeric_limits<double>::infinity();
  quality.governor.observe(input.frame_ms, input.frame_triangles);
  quality.draft = input.draft;
  set_detail(frame.settings, quality);
}

}  // namespace psygen::scene
