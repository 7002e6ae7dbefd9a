// Computes costs of fields in a thread of its own, at the lowest priority: what is asked last comes
// first, and what is not wanted any more is dropped. Signals arrive in the thread that made it.
#pragma once

#include <QObject>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include "editor/cost/block_cost.hpp"
#include "editor/cost/world_impact.hpp"
#include "engine/handmade/files.hpp"

namespace psygen::editor {

class CostWorker final : public QObject {
  Q_OBJECT

 public:
  explicit CostWorker(RegisterModels register_models, QObject* parent = nullptr);
  ~CostWorker() override;

  // Curves of these fields in this text, and the cost of the text itself, of blocks around one.
  // `files` reads those beside it. Replaces what was asked before. `learnt` may be null.
  void ask(std::string text, std::string file, std::vector<world::WorldField> fields,
           core::BlockCoord around, std::shared_ptr<const synthesis::CostModel> learnt,
           handmade::FilesPtr files);
  // What `after` changes of a cache that has meshes of `before`. Goes before curves, and replaces
  // only the impact that was asked before.
  void ask_impact(ParsedWorldPtr before, ParsedWorldPtr after, core::BlockCoord around,
                  CacheContents contents, std::shared_ptr<const synthesis::CostModel> learnt);
  // Something that a person waits for needs the processors: nothing more is computed until go_on(),
  // or for this long.
  void rest(std::chrono::milliseconds most);
  void go_on() { rest(std::chrono::milliseconds(0)); }

 Q_SIGNALS:
  void world_cost(const psygen::editor::BlockCost& cost);
  void curve(const std::string& path, const std::vector<psygen::editor::CostPoint>& points);
  void impact(const psygen::editor::WorldImpact& impact);

 private:
  struct Job {
    std::string text, file;
    std::vector<world::WorldField> fields;
    core::BlockCoord around;
    std::shared_ptr<const synthesis::CostModel> learnt;
    handmade::FilesPtr files;
    std::uint64_t number = 0;
  };
  struct ImpactJob {
    ParsedWorldPtr before, after;
    core::BlockCoord around;
    CacheContents contents;
    std::shared_ptr<const synthesis::CostModel> learnt;
  };
  void run();
  bool is_over() const;
  void wait_while_resting(std::unique_lock<std::mutex>& lock);
  void work(const Job& job);
  void work_on_impact();

  RegisterModels register_models_;
  std::mutex mutex_;
  std::condition_variable asked_;
  std::optional<Job> next_;
  std::optional<ImpactJob> next_impact_;
  std::chrono::steady_clock::time_point rest_until_{};
  std::atomic<std::uint64_t> newest_{0};  // number of the newest job; UINT64_MAX: the end
  std::thread thread_;
};

}  // namespace psygen::editor
