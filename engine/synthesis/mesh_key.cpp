#include "engine/synthesis/mesh_key.hpp"

namespace psygen::synthesis {

std::string_view name_of(MeshState state) {
  switch (state) {
    case MeshState::kEmpty:
      return "empty";
    case MeshState::kRequested:
      return "requested";
    case MeshState::kReady:
      return "ready";
    case MeshState::kFailed:
      return "failed";
  }
  return "unknown";
}

}  // namespace psygen::synthesis
