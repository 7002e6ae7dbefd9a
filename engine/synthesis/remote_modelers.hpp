// Modelers that are no threads of this process, as the manager sees them: places where a mesh can
// be made, whose bytes then come here. An interface; who the others are, and how requests travel,
// is for who implements it (engine/cluster/remote_models.hpp). For meshes that take longer than
// their way. Of one session: its manager cancels them at its end. Outlives it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// What came back of a request.
struct RemoteMesh {
  enum class Answer : std::uint8_t {
    kMade,    // the mesh is here
    kFailed,  // its type failed, as it would here
    kNone,    // nothing that can be used: the request goes back
  };
  Answer answer = Answer::kNone;
  std::vector<std::byte> storage;  // of `bytes`
  std::span<std::byte> bytes;      // if made: vertices, then own indices; sizes as requested
  core::Bounds tight;              // if made
  double seconds = 0;              // of a core there
  std::string error;               // if failed: names the model and the level

  RemoteMesh() = default;
  RemoteMesh(RemoteMesh&&) = default;  // a copy's `bytes` would be the original's
  RemoteMesh& operator=(RemoteMesh&&) = default;
};

// Calls of different places may come at the same time.
class RemoteModelers {
 public:
  virtual ~RemoteModelers() = default;
  // The number of places, 0 … count() − 1: each works on one request at a time. Never changes.
  virtual unsigned count() const = 0;
  // Whether a request may go to any of the places: they know its type, and it is predicted to take
  // longer than its way there and back. Main thread.
  virtual bool takes(const models::ModelType& type, const Request& request) const = 0;
  // Makes a mesh: blocks until there is an answer or cancel(). The thread of the place.
  virtual RemoteMesh make(unsigned place, const models::ModelType& type,
                          const Request& request) = 0;
  // False once nothing more is to be expected of a place. Any thread.
  virtual bool is_usable(unsigned place) const = 0;
  // Main thread: the place's make() returns at once, now and later. `stalled`: because there was no
  // answer; other places may be lost with it.
  virtual void cancel(unsigned place, bool stalled) = 0;
};

}  // namespace psygen::synthesis
