#include "editor/cost/cost_worker.hpp"

#include <QCoreApplication>
#include <QDeadlineTimer>
#include <QThread>

#include "tests/editor/cost/worlds.hpp"

namespace psygen::editor {
namespace {

constexpr int kLongestMs = 300'000;
constexpr std::chrono::hours kLong{1};

class CostWorkerTest : public ::testing::Test {
 protected:
  CostWorkerTest() {
    QObject::connect(&worker_, &CostWorker::world_cost, [this](const BlockCost&) { ++costs_; });
    QObject::connect(&worker_, &CostWorker::impact, [this](const WorldImpact&) { ++impacts_; });
  }
  bool until(const std::function<bool()>& so) {
    const QDeadlineTimer end(kLongestMs);
    while (!so() && !end.hasExpired()) {
      QCoreApplication::processEvents();
      QThread::yieldCurrentThread();
    }
    return so();
  }
  void request_curves() {
    worker_.request_curves({.text = kCostedWorld,
                            .file = "costed.toml",
                            .around = {20, 20},
                            .files = handmade::files_with({}, nullptr)});
  }
  void request_impact() {
    worker_.request_impact({.before = costed(), .after = costed(), .around = {20, 20}});
  }

  int argc_ = 0;
  QCoreApplication application_{argc_, nullptr};
  CostWorker worker_{{}};
  int costs_ = 0, impacts_ = 0;
};

TEST_F(CostWorkerTest, AnswersRequestsForCurvesAndImpacts) {
  request_curves();
  request_impact();
  EXPECT_TRUE(until([this] { return costs_ == 1 && impacts_ == 1; }));
}

TEST_F(CostWorkerTest, RestsUntilItIsResumed) {
  worker_.rest(kLong);
  request_curves();
  request_impact();
  for (int i = 0; i < 1000; ++i) {
    QCoreApplication::processEvents();
    QThread::yieldCurrentThread();
  }
  EXPECT_EQ(costs_ + impacts_, 0);
  worker_.resume();
  EXPECT_TRUE(until([this] { return costs_ == 1 && impacts_ == 1; }));
}

TEST_F(CostWorkerTest, EndsDuringARest) {
  worker_.rest(kLong);
  request_curves();
}

}  // namespace
}  // namespace psygen::editor
