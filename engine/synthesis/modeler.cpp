#include "engine/synthesis/modeler.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/synthesise.hpp"

namespace psygen::synthesis {
namespace {
// For a counter with one writer.
template <class T>
void add(std::atomic<T>& counter, T value) {
  counter.store(counter.load(std::memory_order_relaxed) + value, std::memory_order_relaxed);
}

// Calls a function that annotates a mesh. An exception fails the request.
template <class Work>
void noting(Completion& c, const Work& work) {
  const auto noted = core::catch_exceptions(
      core::ErrorCode::kSynthesisFailed, [] { return "the annotation of a mesh"; }, "failed",
      [&]() -> core::Result<void> { return work(), core::Result<void>{}; });
  if (noted) return;
  c.ok = false;
  c.error = noted.error().message;
}

// Copies vertices and indices. Both meshes have the same size.
void copy_mesh(const models::MeshView& mesh, const models::MeshView& destination) {
  std::ranges::copy(mesh.vertices, destination.vertices.begin());
  std::ranges::copy(mesh.indices, destination.indices.begin());
}

}  // namespace

void Modeler::run(Workshop& workshop) {
  core::name_this_thread(fmt::format("modeler-{}", number_));
  bool lowered = false;
  cpu_s_ = core::thread_cpu_seconds();
  while (!workshop.stop.load(std::memory_order_acquire)) {
    if (is_remote() && !place_.modelers->is_usable(place_.number)) break;
    const std::uint32_t epoch = workshop.board.epoch(*reader_);
    const bool claimed = claim(workshop);
    // A remote modeler's thread uses hardly any processor time.
    if (!lowered && !is_remote() && workshop.lowest_priority.load(std::memory_order_relaxed)) {
      core::lower_priority_of_this_thread();
      lowered = true;
    }
    if (claimed) {
      if (!(is_remote() ? execute_there(workshop) : execute(workshop))) break;
    } else {
      wake_waiting(workshop);
      // stop is set before the epoch moves, so that it cannot be missed here.
      if (!workshop.stop.load(std::memory_order_acquire)) workshop.board.wait(*reader_, epoch);
      cpu_s_ = core::thread_cpu_seconds();
    }
  }
  exited_.store(true, std::memory_order_release);
}

bool Modeler::claim(Workshop& workshop) {
  std::uint64_t retries = 0;
  const bool claimed = workshop.board.claim(*reader_, current_, retries);
  if (retries > 0) add(counters_.retries, retries);
  return claimed;
}

void Modeler::perform(Workshop& workshop, const Request& request) {
  current_ = request;
  cpu_s_ = core::thread_cpu_seconds();
  execute(workshop);
}

bool Modeler::write_mesh(const models::ModelType& type, const models::MeshView& mesh,
                         Completion& c) {
  SynthesisOutcome outcome =
      synthesise_guarded(type, current_.parameters, current_.key.level, mesh);
  c.ok = outcome.ok;
  c.tight = outcome.tight;
  c.error = std::move(outcome.error);
  return c.ok;
}

// Writes the mesh and its annotation. Synthesises into cached memory and annotates there, because
// destinations may be slow to read; a copy costs no more than writing in place.
void Modeler::write_noted_mesh(const models::ModelType& type, const Annotate& annotate,
                               Completion& c) {
  noting(c, [&] {
    const models::MeshView mesh = scratch();
    if (!write_mesh(type, mesh, c) || is_given_up()) return;
    c.note = annotate(current_, mesh);
    copy_mesh(mesh, current_.destination);
  });
}

models::MeshView Modeler::scratch() {
  if (scratch_.size() < current_.size.bytes()) scratch_.resize(current_.size.bytes());
  return models::mesh_view(scratch_.data(), current_.size);
}

// Returns the warmth of the caches for this request. A pause, asleep or without a processor, fills
// them with other data.
Warmth Modeler::warmth_at(double now_s) {
  constexpr double kForgotten_s = 100e-6;
  if (now_s - finished_s_ > kForgotten_s) warm_.clear();
  if (std::ranges::find(warm_, current_.cost.code) != warm_.end()) return Warmth::kWarm;
  warm_.push_back(current_.cost.code);
  return warm_.size() == 1 ? Warmth::kAfterSleep : Warmth::kCold;
}

// Looks up the type first: once the request can be abandoned, the types may change.
Modeler::Job Modeler::begin(const Workshop& workshop) {
  const models::ModelIndex model = current_.key.model;
  const std::vector<Annotate>& notes = workshop.annotate;
  const bool noted = model < notes.size() && notes[model];
  Job job{completion_of(current_, number_), (*workshop.registry)[model],
          noted ? &notes[model] : nullptr};
  Completion& c = job.completion;
  c.remote = is_remote();
  c.started_s = workshop.clock();
  c.warmth = is_remote() ? Warmth::kWarm : warmth_at(c.started_s);
  c.predicted_seconds = current_.cost.of(c.warmth);
  started_s_.store(c.started_s, std::memory_order_relaxed);
  ++serial_;
  state_.store(serial_ * 4 + kWorking, std::memory_order_release);
  return job;
}

bool Modeler::execute(Workshop& workshop) {
  Job job = begin(workshop);
  Completion& c = job.completion;
  if (job.annotate != nullptr) {
    write_noted_mesh(job.type, *job.annotate, c);
  } else {
    write_mesh(job.type, current_.destination, c);
  }
  const double cpu_s = core::thread_cpu_seconds();
  c.seconds = cpu_s - std::exchange(cpu_s_, cpu_s);
  finished_s_ = c.finished_s = workshop.clock();
  if (workshop.hash_content && c.ok)
    c.content_hash = content_hash(current_.key, current_.destination);

  std::uint64_t expected = serial_ * 4 + kWorking;
  if (!state_.compare_exchange_strong(expected, serial_ * 4 + kIdle, std::memory_order_acq_rel)) {
    c.ok = false;
    c.late = true;
    c.note.reset();
    c.error = "abandoned before it was finished";
    queue_.push(std::move(c));
    return false;
  }
  finish(std::move(c));
  return true;
}

void Modeler::finish(Completion&& c) {
  count(c);
  queue_.push(std::move(c));
  finished_.store(finished_.load(std::memory_order_relaxed) + 1, std::memory_order_seq_cst);
}

// The last modeler to finish claims nothing more; at that point all requests may be done.
void Modeler::wake_waiting(Workshop& workshop) {
  if (!workshop.waiting.load(std::memory_order_seq_cst)) return;
  add(counters_.locks, std::uint64_t{1});
  const std::lock_guard lock(workshop.mutex);
  workshop.finished.notify_one();
}

void Modeler::count(const Completion& c) {
  add(counters_.cpu_seconds, c.seconds);
  add(counters_.busy_seconds, c.finished_s - c.started_s);
  if (!c.ok) {
    add(counters_.failed, std::uint64_t{1});
    return;
  }
  add(counters_.models, std::uint64_t{1});
  add(counters_.triangles, std::uint64_t{current_.size.triangle_count()});
  add(counters_.bytes, std::uint64_t{current_.size.bytes()});
}

bool Modeler::is_older(double limit_s) const {
  const std::uint64_t state = state_.load(std::memory_order_acquire);
  return (state & kPhaseMask) == kWorking && started_s_.load(std::memory_order_relaxed) < limit_s;
}

bool Modeler::give_up_if_older(double limit_s, double now_s, Completion& out) {
  std::uint64_t state = state_.load(std::memory_order_acquire);
  if ((state & kPhaseMask) != kWorking) return false;
  const double started_s = started_s_.load(std::memory_order_relaxed);
  if (started_s >= limit_s) return false;
  // Fails if the request has ended, even if another one runs by now: the serial number differs.
  if (!state_.compare_exchange_strong(state, (state & ~std::uint64_t{kPhaseMask}) | kGivenUp,
                                      std::memory_order_acq_rel)) {
    return false;
  }
  out = completion_of(current_, number_);
  out.abandoned = true;
  out.started_s = started_s;
  out.finished_s = now_s;
  out.remote = is_remote();
  out.error =
      fmt::format("level {} was abandoned after {:.1f} s", out.key.level, now_s - started_s);
  return true;
}

// This thread owns the destination only after the mesh has arrived and unless the request was
// abandoned.
bool Modeler::execute_there(Workshop& workshop) {
  Job job = begin(workshop);
  Completion& c = job.completion;
  RemoteMesh mesh = place_.modelers->make(place_.number, job.type, current_);
  std::uint64_t expected = serial_ * 4 + kWorking;
  if (!state_.compare_exchange_strong(expected, serial_ * 4 + kWriting, std::memory_order_acq_rel))
    return false;
  const bool made = mesh.answer != RemoteMesh::Answer::kNone;
  if (made) write_remote_mesh(workshop, job.annotate, mesh, c);
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
