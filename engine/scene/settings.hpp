// What a user chooses about a scene, with defaults. Values only.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/synthesis/policy.hpp"
#include "engine/visibility/plp.hpp"

namespace psygen::scene {

// The three ways of the paper (sections 3.3 and 4) to get geometry from parameters.
enum class Paradigm : std::uint8_t {
  kParallelLazyAmplification,  // on demand, in parallel, cached, prefetched
  kDataAmplification,          // a region is synthesised before the first frame, nothing after it
  kLazyEvaluation,             // what is visible is made again in every frame; nothing is kept
};
std::string_view to_string(Paradigm paradigm);  // "pla", "amplify", "lazy"
core::Result<Paradigm> paradigm_from(std::string_view name);

// The modes of Prioritized-Layered Projection: "layers", "solidity".
std::string_view to_string(visibility::PlpMode mode);
core::Result<visibility::PlpMode> plp_mode_from(std::string_view name);

// The defaults suit a machine with a few cores.
struct Settings {
  Paradigm paradigm = Paradigm::kParallelLazyAmplification;
  synthesis::Policy policy = synthesis::Policy::kDeadline;
  visibility::PlpMode plp_mode = visibility::PlpMode::kLayers;
  std::uint32_t modelers = 0;  // 0: cores − 1, at least 1; threads, as virtual time has 1
  // Whether modelers run at the lowest priority of the operating system. Else they take processors
  // from the frame; for comparison only.
  bool modelers_yield = true;
  std::uint64_t budget_bytes = 512ull << 20;  // all geometry: resident, in flight, retired
  double view_distance_m = 16'000;            // nothing farther away is drawn
  double max_error_pixels = 4.0;              // of the level of detail that is chosen
  // Held by fewer pixels of the landscape, then by a larger error; 0: both are fixed.
  double target_frame_ms = 0;
  double min_resolution = 0.6;         // share of width and height, 0.25 … 1
  double max_error_factor = 4;         // so much larger at most
  double min_size_pixels = 1.5;        // models smaller on screen are not drawn
  double fade_seconds = 0.25;          // in which models come and go; 0: at once
  bool levels_of_detail = true;        // false: full detail everywhere, as in the paper
  bool occlusion = true;               // leave out what lies behind ridges
  double watchdog_seconds = 10;        // a model that takes longer is given up
  double main_thread_budget_ms = 2.0;  // per tick, for meshes whose absence is seen
  double plan_seconds_ahead = 0.05;    // synthesis time per modeler in one plan
  std::uint32_t plan_max_requests = 4096;
  std::uint32_t plan_max_new = 256;   // of them, reserved in one tick
  double streaming_budget_ms = 2.0;   // per tick, for creating nodes
  std::uint32_t streaming_ticks = 8;  // over which new nodes and their meshes are spread at most
  std::uint64_t upload_budget_bytes = 16ull << 20;  // per tick
  double step_hz = 60;                              // fixed steps of the simulation a second
  // The flight's clock is the only one: synthesis and streaming take what is predicted of them, and
  // everything is the same to the bit on any machine. Nothing is calibrated.
  bool virtual_time = false;
};

// What the paradigm asks of a tick, decided once (rules_of).
struct Rules {
  bool request = true;       // meshes that are missing are synthesised
  bool wait = false;         // for all of them, before the frame is drawn
  bool keep = true;          // what this frame draws may be drawn by the next one
  bool look_ahead = true;    // also for nodes out of view
  bool coarse_first = true;  // the first mesh of a hole is the coarsest level
  bool settle = false;       // before the first frame: levels follow from the pose alone, not from
                             // what came first, or when
};
// `settling`: before the first frame.
Rules rules_of(const Settings& settings, bool settling);

}  // namespace psygen::scene
