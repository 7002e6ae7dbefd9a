// Requests to modelers and their completions, both plain values. A modeler needs only its request;
// it never sees the cache, the world or the renderer.
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "engine/models/registry.hpp"
#include "engine/synthesis/cost_fit.hpp"
#include "engine/synthesis/mesh_key.hpp"

namespace psygen::synthesis {

// A mesh to synthesise and its destination.
struct Request {
  MeshHandle handle;
  MeshKey key;
  models::Parameters parameters;
  models::MeshView destination;  // reserved for this request; written by its modeler
  models::MeshSize size;
  Work work;  // for the cost model
  RequestCost cost;
  std::uint64_t owner = 0;
  // Keeps the edits that the parameters refer to alive until the mesh is made. Null without edits.
  std::shared_ptr<const models::EditLayer> edits;
  // A remote modeler returned it without a mesh, or too late: it goes to no other remote modeler,
  // which could hang too.
  bool stays_here = false;
};

// Computes a value for the main thread from a new mesh, so that the main thread need not read the
// mesh back. A pure function of the request and its mesh. Modelers call it concurrently. A
// std::exception fails the request.
using Annotate = std::function<std::any(const Request&, const models::MeshView& mesh)>;

// The result of one request.
struct Completion {
  MeshHandle handle;
  MeshKey key;
  std::uint64_t owner = 0;
  bool ok = false;
  // Abandoned by the watchdog: the modeler still holds the destination. A second completion of the
  // same handle, with `late` set, follows when it releases the destination. Both have ok == false.
  bool abandoned = false;
  bool late = false;
  bool remote = false;  // made by a remote modeler: its time says nothing about this machine
  std::uint32_t modeler = 0;
  std::string error;  // if not ok: a message that names the model and the level
  // CPU time of the modeler's thread for this request, including claiming and timing: since the
  // last request, or since it woke. For a remote request, that of a core there.
  double seconds = 0;
  double started_s = 0, finished_s = 0;  // by the manager's clock, for traces
  Work work;                             // as requested, for CostModel::observe()
  Warmth warmth = Warmth::kWarm;         // of its modeler when it claimed the request
  double predicted_seconds = 0;          // for that warmth
  core::Bounds tight;
  std::any note;                   // result of the model's Annotate, if ok and there is one
  std::uint64_t content_hash = 0;  // if the manager hashes content, else 0
};

// Initial completion of a request by `modeler`: not ok, and no error yet.
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
