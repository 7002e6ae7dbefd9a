// What goes to the modelers and what comes back: values, both of them. A modeler needs nothing but
// its request; it never sees the cache, the world or the renderer.
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "engine/models/registry.hpp"
#include "engine/synthesis/cost_correction.hpp"
#include "engine/synthesis/cost_fit.hpp"
#include "engine/synthesis/mesh_key.hpp"

namespace psygen::synthesis {

// One mesh to synthesise, and where it goes.
struct Request {
  MeshHandle handle;
  MeshKey key;
  models::Parameters parameters;
  models::MeshView destination;  // reserved for this request; its modeler writes it
  models::MeshSize size;
  Work work;  // for the cost model
  RequestCost cost;
  std::uint64_t owner = 0;
  // Keeps what the parameters refer to alive until the mesh is made. Null where there are no edits.
  std::shared_ptr<const models::EditLayer> edits;
  // It came back from a remote modeler without a mesh, or with none in time: it goes to no other,
  // which it may make hang too.
  bool stays_here = false;
};

// What the main thread must know of a mesh when it lands, so that it need not be read back: any
// value, a pure function of the request and of the mesh that was made for it. Called by modelers,
// several at once. A std::exception fails the request.
using Annotate = std::function<std::any(const Request&, const models::MeshView& mesh)>;

// The result of one request.
struct Completion {
  MeshHandle handle;
  MeshKey key;
  std::uint64_t owner = 0;
  bool ok = false;
  // Given up by the watchdog: the modeler still holds the destination, and a second completion of
  // the same handle with `late` set follows when it lets go. Both have ok == false.
  bool abandoned = false;
  bool late = false;
  bool remote = false;  // made by a remote modeler: what it took says nothing of this machine
  std::uint32_t modeler = 0;
  std::string error;  // if not ok: one sentence that names the model and the level
  // CPU time of the modeler's thread for it, with claiming and timing: since the last request, or
  // since it woke. Of a remote one: that of a core there.
  double seconds = 0;
  double started_s = 0, finished_s = 0;  // by the manager's clock, for traces
  Work work;                             // as requested, for CostModel::observe()
  Warmth warmth = Warmth::kWarm;         // of its modeler when it claimed the request
  double predicted_seconds = 0;          // for that warmth
  core::Bounds tight;
  std::any note;                   // by the Annotate of its model, if ok and there is one
  std::uint64_t content_hash = 0;  // if the manager hashes content, else 0
};

// What `modeler` answers to a request before it has tried: not ok, and no error yet.
inline Completion completion_of(const Request& request, std::uint32_t modeler) {
  Completion c;
  c.handle = request.handle;
  c.key = request.key;
  c.owner = request.owner;
  c.modeler = modeler;
  c.work = request.work;
  return c;
}

}  // namespace psygen::synthesis
