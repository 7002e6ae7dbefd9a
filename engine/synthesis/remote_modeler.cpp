// The request loop of a remote modeler.
#include <mutex>
#include <utility>

#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/making.hpp"

namespace psygen::synthesis {

// This thread owns the destination only after the mesh has arrived and unless the request was
// abandoned.
bool Modeler::execute_there(Workshop& workshop) {
  Completion c = completion_of(current_, number_);
  c.remote = true;
  c.started_s = workshop.clock();
  c.predicted_seconds = current_.cost.warm_s();
  // Look up the type first: once the request can be abandoned, the types may change.
  const models::ModelIndex model = current_.key.model;
  const models::ModelType& type = (*workshop.registry)[model];
  const Annotate* annotate = annotate_of(workshop, model);
  begin(c.started_s);
  RemoteMesh mesh = place_.modelers->make(place_.number, type, current_);
  std::uint64_t expected = serial_ * 4 + kWorking;
  if (!state_.compare_exchange_strong(expected, serial_ * 4 + kWriting, std::memory_order_acq_rel))
    return false;
  const bool made = mesh.answer != RemoteMesh::Answer::kNone;
  if (made) write_remote_mesh(workshop, annotate, mesh, c);
  c.finished_s = workshop.clock();
  state_.store(serial_ * 4 + kIdle, std::memory_order_release);
  if (made) {
    finish(std::move(c));
  } else {
    give_back(workshop);
  }
  return true;
}

void Modeler::write_remote_mesh(const Workshop& workshop, const Annotate* annotate,
                                RemoteMesh& mesh, Completion& c) {
  c.seconds = mesh.seconds;
  c.tight = mesh.tight;
  c.ok = mesh.answer == RemoteMesh::Answer::kMade;
  c.error = std::move(mesh.error);
  if (!c.ok) return;
  const models::MeshView made = models::mesh_view(mesh.bytes.data(), current_.size);
  if (annotate != nullptr) noting(c, [&] { c.note = (*annotate)(current_, made); });
  copy_mesh(made, current_.destination);
  if (workshop.hash_content && c.ok) c.content_hash = content_hash(current_.key, made);
}

void Modeler::give_back(Workshop& workshop) {
  const std::lock_guard lock(workshop.mutex);
  workshop.returned.push_back(current_);
  workshop.has_returned.store(true, std::memory_order_release);
}

}  // namespace psygen::synthesis
