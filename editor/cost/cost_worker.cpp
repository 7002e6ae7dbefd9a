#include "editor/cost/cost_worker.hpp"

#include <QMetaObject>
#include <utility>

#include "engine/core/start_thread.hpp"
#include "engine/synthesis/thread_priority.hpp"

namespace psygen::editor {
namespace {

constexpr std::uint64_t kEnd = UINT64_MAX;

}  // namespace

CostWorker::CostWorker(RegisterModels register_models, QObject* parent)
    : QObject(parent), register_models_(std::move(register_models)) {
  // Without a thread there are no curves; everything else works.
  if (auto thread = core::start_thread([this] { run(); })) thread_ = std::move(*thread);
}

CostWorker::~CostWorker() {
  newest_.store(kEnd);
  {
    const std::lock_guard lock(mutex_);
    next_.reset();
    next_impact_.reset();
  }
  asked_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void CostWorker::ask(std::string text, std::string file, std::vector<world::WorldField> fields,
                     core::BlockCoord around, std::shared_ptr<const synthesis::CostModel> learnt,
                     handmade::FilesPtr files) {
  {
    const std::lock_guard lock(mutex_);
    next_ = Job{std::move(text),   std::move(file),  std::move(fields), around,
                std::move(learnt), std::move(files), newest_.load() + 1};
    newest_.store(next_->number);
  }
  asked_.notify_all();
}

void CostWorker::ask_impact(ParsedWorldPtr before, ParsedWorldPtr after, core::BlockCoord around,
                            CacheContents contents,
                            std::shared_ptr<const synthesis::CostModel> learnt) {
  {
    const std::lock_guard lock(mutex_);
    next_impact_ = ImpactJob{std::move(before), std::move(after), around, std::move(contents),
                             std::move(learnt)};
  }
  asked_.notify_all();
}

void CostWorker::rest(std::chrono::milliseconds most) {
  {
    const std::lock_guard lock(mutex_);
    rest_until_ = std::chrono::steady_clock::now() + most;
  }
  asked_.notify_all();
}

bool CostWorker::is_over() const {
  return newest_.load() == kEnd;
}

void CostWorker::wait_while_resting(std::unique_lock<std::mutex>& lock) {
  while (!is_over() && std::chrono::steady_clock::now() < rest_until_)
    asked_.wait_until(lock, rest_until_);
}

void CostWorker::run() {
  synthesis::lower_priority_of_this_thread();
  while (true) {
    std::unique_lock lock(mutex_);
    asked_.wait(lock,
                [this] { return next_.has_value() || next_impact_.has_value() || is_over(); });
    wait_while_resting(lock);
    if (is_over()) return;
    if (!next_) {
      lock.unlock();
      work_on_impact();
      continue;
    }
    const Job job = *std::exchange(next_, std::nullopt);
    lock.unlock();
    work(job);
  }
}

void CostWorker::work_on_impact() {
  std::unique_lock lock(mutex_);
  wait_while_resting(lock);
  if (!next_impact_) return;
  const ImpactJob job = *std::exchange(next_impact_, std::nullopt);
  lock.unlock();
  const WorldImpact found =
      impact_of(*job.before, *job.after, job.around, job.contents, job.learnt.get());
  QMetaObject::invokeMethod(this, [this, found] { Q_EMIT impact(found); });
}

void CostWorker::work(const Job& job) {
  const auto wanted = [&] {
    work_on_impact();
    return newest_.load() == job.number;
  };
  work_on_impact();
  if (const auto parsed = parse_world_text(job.text, job.file, register_models_, job.files.get())) {
    const BlockCost cost = block_cost(**parsed, job.around, job.learnt.get(), true);
    QMetaObject::invokeMethod(this, [this, cost] { Q_EMIT world_cost(cost); });
  }
  for (const world::WorldField& field : job.fields) {
    if (!wanted()) return;
    auto points = cost_curve(job.text, job.file, register_models_, field, job.around,
                             job.learnt.get(), wanted, job.files.get());
    if (points.empty()) continue;
    QMetaObject::invokeMethod(this, [this, path = field.path.text(), points = std::move(points)] {
      Q_EMIT curve(path, points);
    });
  }
}

}  // namespace psygen::editor
