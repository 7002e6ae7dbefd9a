// Records each mesh of a flight when it is first wanted, for `psygen schedule`. Main thread.
#pragma once

#include <unordered_set>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/synthesis/request_stream.hpp"

namespace psygen::cli {

// Records the requests of one flight.
class RequestRecorder {
 public:
  // Call after each tick: records its wanted meshes. Times are those of the flight.
  void observe(const scene::Scene& scene);
  const std::vector<synthesis::SimulatedJob>& jobs() const { return jobs_; }

 private:
  std::unordered_set<synthesis::MeshKey> seen_;
  std::vector<synthesis::SimulatedJob> jobs_;
};

}  // namespace psygen::cli
