#include "editor/cost/cost_worker.hpp"

#include <QMetaObject>
#include <utility>

#include "engine/core/headroom.hpp"

namespace psygen::editor {
namespace {

constexpr std::uint64_t kEnd = UINT64_MAX;

}  // namespace

CostWorker::CostWorker(RegisterModels register_models, QObject* parent)
    : QObject(parent), register_models_(std::move(register_models)) {
  // Without a thread the editor works, but shows no costs.
  if (auto thread = core::start_thread([this] { run(); })) thread_ = std::move(*thread);
}

CostWorker::~CostWorker() {
  newest_.store(kEnd);
  {
    const std::lock_guard lock(mutex_);
    next_.reset();
    next_impact_.reset();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void CostWorker::request_curves(CurveRequest request) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(request);
    ++newest_;
  }
  changed_.notify_all();
}

void CostWorker::request_impact(ImpactRequest request) {
  {
    const std::lock_guard lock(mutex_);
    next_impact_ = std::move(request);
  }
  changed_.notify_all();
}

void CostWorker::rest(std::chrono::milliseconds duration) {
  {
    const std::lock_guard lock(mutex_);
    rest_until_ = std::chrono::steady_clock::now() + duration;
  }
  changed_.notify_all();
}

bool CostWorker::is_over() const {
  return newest_.load() == kEnd;
}

void CostWorker::wait_while_resting(std::unique_lock<std::mutex>& lock) {
  while (!is_over() && std::chrono::steady_clock::now() < rest_until_)
    changed_.wait_until(lock, rest_until_);
}

void CostWorker::run() {
  core::lower_priority_of_this_thread();
  while (true) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock,
                  [this] { return next_.has_value() || next_impact_.has_value() || is_over(); });
    wait_while_resting(lock);
    const std::uint64_t number = newest_.load();  // before the check, so that it is not the end
    if (is_over()) return;
    if (!next_) {
      lock.unlock();
      compute_impact();
      continue;
    }
    const CurveRequest request = *std::exchange(next_, std::nullopt);
    lock.unlock();
    compute_curves(request, number);
  }
}

void CostWorker::compute_impact() {
  std::unique_lock lock(mutex_);
  wait_while_resting(lock);
  if (!next_impact_) return;
  const ImpactRequest request = *std::exchange(next_impact_, std::nullopt);
  lock.unlock();
  const WorldImpact found = impact_of(*request.before, *request.after, request.around,
                                      request.contents, request.learnt.get());
  QMetaObject::invokeMethod(this, [this, found] { Q_EMIT impact(found); });
}

void CostWorker::compute_curves(const CurveRequest& request, std::uint64_t number) {
  const auto is_newest = [&] {
    compute_impact();
    return newest_.load() == number;
  };
  compute_impact();
  if (const auto parsed =
          parse_world_text(request.text, request.file, register_models_, request.files.get())) {
    const BlockCost cost = block_cost(**parsed, request.around, request.learnt.get(), true);
    QMetaObject::invokeMethod(this, [this, cost] { Q_EMIT world_cost(cost); });
  }
  for (const world::WorldField& field : request.fields) {
    if (!is_newest()) return;
    auto points = cost_curve({.text = request.text,
                              .file = request.file,
                              .register_models = register_models_,
                              .field = field,
                              .around = request.around,
                              .learnt = request.learnt.get(),
                              .files = request.files.get()},
                             is_newest);
    if (points.empty()) continue;
    QMetaObject::invokeMethod(this, [this, path = field.path, points = std::move(points)] {
      Q_EMIT curve(path, points);
    });
  }
}

}  // namespace psygen::editor
