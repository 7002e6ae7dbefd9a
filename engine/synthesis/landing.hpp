// Publishes finished meshes in the cache: completions become ready or failed meshes only here. Main
// thread.
#pragma once

#include <cstdint>
#include <span>

#include "engine/synthesis/cost_model.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// Counts of one land() call, in meshes.
struct LandingReport {
  std::uint32_t ready = 0;
  std::uint32_t failed = 0;   // threw, or abandoned
  std::uint32_t settled = 0;  // hung modelers that released their destination
  std::uint64_t bytes = 0;    // of the meshes that became ready
};

// Completes or fails each mesh; stale handles are dropped. `cost`, if not null, learns from every
// success on this machine. Completions may come in any order, except that a late one follows its
// abandoned one. Notes are stored in the records of their meshes.
LandingReport land(std::span<Completion> completions, GeometryCache& cache, CostModel* cost);

}  // namespace psygen::synthesis
