#include "engine/scene/settings.hpp"

#include <fmt/format.h>

namespace psygen::scene {

std::string_view to_string(Paradigm paradigm) {
  switch (paradigm) {
    case Paradigm::kDataAmplification:
      return "amplify";
    case Paradigm::kLazyEvaluation:
      return "lazy";
    case Paradigm::kParallelLazyAmplification:
      break;
  }
  return "pla";
}

core::Result<Paradigm> paradigm_from(std::string_view name) {
  if (name == "pla") return Paradigm::kParallelLazyAmplification;
  if (name == "amplify") return Paradigm::kDataAmplification;
  if (name == "lazy") return Paradigm::kLazyEvaluation;
  return core::invalid_argument(
      fmt::format("paradigm '{}' is unknown; allowed are pla, amplify, lazy", name));
}

std::string_view to_string(visibility::PlpMode mode) {
  return mode == visibility::PlpMode::kSolidity ? "solidity" : "layers";
}

core::Result<visibility::PlpMode> plp_mode_from(std::string_view name) {
  if (name == "layers") return visibility::PlpMode::kLayers;
  if (name == "solidity") return visibility::PlpMode::kSolidity;
  return core::invalid_argument(
      fmt::format("PLP mode '{}' is unknown; allowed are layers, solidity", name));
}

}  // namespace psygen::scene
