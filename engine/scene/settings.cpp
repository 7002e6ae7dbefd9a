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
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("paradigm '{}' is unknown; allowed are pla, amplify, lazy", name));
}

}  // namespace psygen::scene
