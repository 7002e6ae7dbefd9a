// Computes the costs of fields in a thread of lowest priority. A new request replaces the previous
// one of its kind. Signals arrive in the thread that created the worker.
#pragma once

#include <QObject>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "editor/cost/block_cost.hpp"
#include "editor/cost/world_impact.hpp"
#include "engine/handmade/files.hpp"

namespace psygen::editor {

// The destructor waits for the thread, which checks for the end between values.
class CostWorker final : public QObject {
  Q_OBJECT

 public:
  // Starts the thread. `register_models` is called in it.
  explicit CostWorker(RegisterModels register_models, QObject* parent = nullptr);
  ~CostWorker() override;

  // Cost curves of the fields of a world text, and the cost of the text itself.
  struct CurveRequest {
    std::string text, file;  // file: for messages and for the folder of resources
    std::vector<world::WorldField> fields = {};
    core::BlockCoord around;
    std::shared_ptr<const synthesis::CostModel> learnt = {};  // may be null
    handmade::FilesPtr files;                                 // reads the resources
  };
  // The impact of replacing `before` by `after` on a cache with meshes of `before`.
  struct ImpactRequest {
    ParsedWorldPtr before, after;
    core::BlockCoord around;
    CacheContents contents = {};
    std::shared_ptr<const synthesis::CostModel> learnt = {};  // may be null
  };
  // Replaces the previous request for curves.
  void request_curves(CurveRequest request);
  // Replaces the previous request for an impact. Impacts come before curves.
  void request_impact(ImpactRequest request);
  // Computes nothing until resume(), or for this long, so that the view gets the processors.
  void rest(std::chrono::milliseconds duration);
  void resume() { rest(std::chrono::milliseconds(0)); }

 Q_SIGNALS:
  // Results of the newest requests. `path`: of the field.
  void world_cost(const psygen::editor::BlockCost& cost);
  void curve(const psygen::world::TextPath& path,
             const std::vector<psygen::editor::CostPoint>& points);
  void impact(const psygen::editor::WorldImpact& impact);

 private:
  void run();
  bool is_over() const;
  void wait_while_resting(std::unique_lock<std::mutex>& lock);
  void compute_curves(const CurveRequest& request, std::uint64_t number);
  void compute_impact();

  RegisterModels register_models_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<CurveRequest> next_;
  std::optional<ImpactRequest> next_impact_;
  std::chrono::steady_clock::time_point rest_until_{};
  std::atomic<std::uint64_t> newest_{0};  // number of the newest request; UINT64_MAX: the end
  std::thread thread_;
};

}  // namespace psygen::editor
