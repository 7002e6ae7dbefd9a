// Interface to modelers outside this process: slots in which a mesh can be made, whose bytes are
// then sent here. The implementation (engine/cluster/remote_modeler_pool.hpp) knows the other
// processes and the transport. For meshes that take longer than their round trip. Serves one
// session, whose manager cancels the slots at its end. Outlives that session.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/synthesis/request.hpp"

namespace psygen::synthesis {

// Result of a remote request.
struct RemoteMesh {
  enum class Answer : std::uint8_t {
    kMade,    // the mesh has arrived
    kFailed,  // its type failed, as it would here
    kNone,    // nothing usable: the request is returned
  };
  Answer answer = Answer::kNone;
  std::vector<std::byte> storage;  // holds `bytes`
  std::span<std::byte> bytes;      // if made: vertices, then own indices; sizes as requested
  core::Bounds tight;              // if made
  double seconds = 0;              // of a core on the remote machine
  std::string error;               // if failed: names the model and the level

  RemoteMesh() = default;
  RemoteMesh(RemoteMesh&&) = default;  // a copy's `bytes` would point into the original
  RemoteMesh& operator=(RemoteMesh&&) = default;
};

// Calls for different slots may run concurrently.
class RemoteModelers {
 public:
  virtual ~RemoteModelers() = default;
  // Number of slots, 0 … count() − 1; each works on one request at a time. Constant.
  virtual unsigned count() const = 0;
  // Returns true if any slot may make this request: they know its type, and it is predicted to take
  // longer than the round trip. Main thread.
  virtual bool takes(const models::ModelType& type, const Request& request) const = 0;
  // Makes a mesh; blocks until the answer arrives or cancel() is called. The slot's thread.
  virtual RemoteMesh make(unsigned place, const models::ModelType& type,
                          const Request& request) = 0;
  // Returns false once a slot can make no more meshes. Any thread.
  virtual bool is_usable(unsigned place) const = 0;
  // Main thread: the slot's make() returns at once, now and later. `stalled`: because no answer
  // came; other slots of the same rank may be lost too.
  virtual void cancel(unsigned place, bool stalled) = 0;
};

}  // namespace psygen::synthesis
