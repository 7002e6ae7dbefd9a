// Takes what the modelers finished into the cache: the only place where completions become ready or
// failed meshes. Main thread.
#pragma once

#include <cstdint>
#include <span>

#include "engine/synthesis/cost_model.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// What one land() did, in meshes.
struct LandingReport {
  std::uint32_t ready = 0;
  std::uint32_t failed = 0;   // threw, or was given up
  std::uint32_t settled = 0;  // hung modelers that let go of their destination
  std::uint64_t bytes = 0;    // of the meshes that are ready now
};

// Completes or fails each mesh; stale handles are dropped. `cost`, if not null, learns from every
// success of this machine. Completions may come in any order, but a late one after its abandoned
// one. Notes go to the records of their meshes.
LandingReport land(std::span<Completion> completions, GeometryCache& cache, CostModel* cost);

}  // namespace psygen::synthesis
