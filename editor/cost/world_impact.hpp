// What a change of the world does to the meshes that a cache holds: how many have to be made anew,
// how long that takes, how full the cache is then. Estimated from some blocks of both worlds and
// what the cost model predicts; nothing is made. Pure; any thread, with parsed worlds and a cost
// model of its own.
#pragma once

#include <QString>
#include <cstdint>
#include <string>
#include <vector>

#include "editor/document/parsed_world.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::editor {

// What a cache holds of one model type.
struct HeldMeshes {
  enum class Kind : std::uint8_t { kGround, kModel, kDerived };
  std::string type;
  Kind kind = Kind::kModel;  // kDerived: of the scene's own types, made from what is scattered
  std::uint64_t meshes = 0;
  double bytes = 0;
  double seconds = 0;  // of one core, predicted to make all of them
};
struct CacheContents {
  std::vector<HeldMeshes> held;
  double budget_bytes = 0;
  unsigned modelers = 1;
};

struct WorldImpact {
  double held = 0, changed = 0;        // meshes; those that are made anew
  double seconds = 0;                  // of all modelers together
  double bytes = 0, budget_bytes = 0;  // of what is needed afterwards, and of the cache
  // The worlds differ, but not where it was looked: a road, a model at a place, a spot of a mask.
  bool is_elsewhere = false;
};

// The impact of `after` where `contents` are of `before`; of blocks around one. `learnt`: as in
// block_cost(). Some milliseconds.
WorldImpact impact_of(const ParsedWorld& before, const ParsedWorld& after, core::BlockCoord around,
                      const CacheContents& contents, const synthesis::CostModel* learnt);

// "About 3,412 meshes change of 8,120 in the cache; 0.7 s to make them. …".
QString impact_text(const WorldImpact& impact);

}  // namespace psygen::editor
