// Modelers do not contend: between two requests of one plan a modeler takes no lock, waits for
// nothing and wakes no thread. The test counts calls, so that it does not depend on the load of the
// machine.
#include "tests/engine/synthesis/waits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <vector>

#include "engine/synthesis/synthesis_manager.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {

using testing::waits_of_this_thread;

struct Counted {
  std::uint64_t gaps = 0;   // between two requests of one modeler
  std::uint64_t waits = 0;  // from the begin of one to the begin of the next
};

// Executes one plan of many requests with this number of modelers.
Counted count_waits(unsigned modelers, const std::function<void()>& during = {}) {
  constexpr std::uint32_t kRequests = 3000;
  std::atomic<std::uint64_t> gaps{0}, waits{0};
  const models::Registry registry = testing::registry_of(
      std::make_unique<testing::ScriptedModel>("watched", [&](const models::Parameters&, int) {
        static thread_local const void* last_plan = nullptr;
        static thread_local std::uint64_t before = 0;
        if (last_plan == &gaps) {
          gaps.fetch_add(1, std::memory_order_relaxed);
          waits.fetch_add(waits_of_this_thread() - before, std::memory_order_relaxed);
        }
        last_plan = &gaps;
        before = waits_of_this_thread();
        if (during) during();
      }));
  std::vector<HeapDestination> places;
  std::vector<Request> plan;
  for (std::uint32_t i = 0; i < kRequests; ++i) {
    const models::Parameters p = testing::parameters_of(i, 80);
    places.push_back(HeapDestination::make(registry[0], p, 0).value());
    Request request;
    request.handle = {i, 1};
    request.key = testing::key_of(i, p);
    request.parameters = p;
    request.destination = places.back().view();
    request.size = places.back().size();
    plan.push_back(request);
  }
  SynthesisOptions options;
  options.modelers = modelers;
  options.hash_content = true;
  SynthesisManager manager(registry, options);
  manager.publish(std::move(plan));
  EXPECT_TRUE(manager.wait_all());
  std::vector<Completion> done;
  EXPECT_EQ(manager.collect(done), kRequests);
  return {gaps.load(), waits.load()};
}

TEST(Waits, BetweenTwoRequestsOfAPlanAModelerDoesNotWait) {
  for (const unsigned modelers : {1u, 2u, 4u, 16u}) {
    const Counted counted = count_waits(modelers);
    EXPECT_GE(counted.gaps, 3000u - modelers);
    EXPECT_EQ(counted.waits, 0u) << modelers << " modelers";
  }
}

TEST(Waits, ALockDuringARequestIsCounted) {
  std::mutex shared;
  const Counted counted = count_waits(2, [&] { const std::lock_guard lock(shared); });
  EXPECT_GE(counted.waits, counted.gaps);
}

}  // namespace
}  // namespace psygen::synthesis
