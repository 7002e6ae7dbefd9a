// Guarded calls of a model type: an exception becomes an error message, and invalid bounds become a
// failure. Also provides heap memory of the right size for a single mesh (calibration, tools).
// Stateless; any thread. Writes beyond the spans cannot be detected.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "engine/models/model_type.hpp"

namespace psygen::synthesis {

// The result of one synthesis.
struct SynthesisOutcome {
  bool ok = false;
  core::Bounds tight;  // if ok
  std::string error;   // else a message that names the model and the level
  // Cause of the failure: the request may succeed later or on another machine.
  bool out_of_memory = false;
};

// Calls type.synthesise(); `out` has exactly the sizes of mesh_size(p, level).
SynthesisOutcome synthesise_guarded(const models::ModelType& type, const models::Parameters& p,
                                    int level, const models::MeshView& out);

// Calls type.mesh_size(), unless the caller knows the size. Fails with kSynthesisFailed if the type
// throws, with kOutOfMemory without memory, and with kOverBudget beyond 65,536 vertices (16-bit
// indices) or 2^26 indices.
core::Result<models::MeshSize> mesh_size_guarded(const models::ModelType& type,
                                                 const models::Parameters& p, int level,
                                                 const std::optional<models::MeshSize>& known = {});

// Memory on the heap for one mesh.
class HeapDestination {
 public:
  // Fails as mesh_size_guarded(), and with kOutOfMemory if the heap is exhausted.
  static core::Result<HeapDestination> make(const models::ModelType& type,
                                            const models::Parameters& p, int level);
  const models::MeshSize& size() const { return size_; }
  models::MeshView view() const;

 private:
  models::MeshSize size_;
  std::unique_ptr<std::byte[]> memory_;
};

}  // namespace psygen::synthesis
