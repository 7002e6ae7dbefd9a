#include "engine/synthesis/mesh_supply.hpp"

#include <iterator>

#include "engine/core/assert.hpp"

namespace psygen::synthesis {

LandingReport land(std::span<Completion> completions, GeometryCache& cache, CostModel* cost) {
  LandingReport report;
  for (Completion& c : completions) {
    if (c.late) {
      cache.settle(c.handle);
      ++report.settled;
    } else if (!c.ok) {
      cache.fail(c.handle, c.error, c.abandoned);
      ++report.failed;
    } else {
      if (cost != nullptr && !c.remote) {
        cost->observe(c.key.model, c.key.level, c.work, c.warmth, c.seconds);
      }
      cache.complete(c.handle, c.tight, std::move(c.note));
      const MeshRecord* record = cache.get(c.handle);  // may be evicted or released by now
      if (record == nullptr || record->state != MeshState::kReady) continue;
      ++report.ready;
      report.bytes += record->range.bytes;
    }
  }
  return report;
}

void MeshSupply::open(const models::Registry& registry, core::GeometryMemory& memory,
                      std::uint64_t budget_bytes) {
  PSYGEN_CHECK(cache_ == nullptr, "open() may be called only once");
  cache_ = std::make_unique<GeometryCache>(memory, registry, budget_bytes);
  cost_ = std::make_unique<CostModel>(registry);
}

CalibrationReport MeshSupply::calibrate(std::span<const CostSample> samples, double seconds_limit,
                                        const std::function<void(double)>& progress) {
  return cost_->calibrate(samples, {.seconds_limit = seconds_limit}, progress);
}

unsigned MeshSupply::start_modelers(const SynthesisOptions& options) {
  manager_ = std::make_unique<SynthesisManager>(cache_->registry(), options);
  return manager_->modeler_count();
}

const MeshRecord* MeshSupply::ready(MeshHandle handle) const {
  const MeshRecord* record = cache_->get(handle);
  return record != nullptr && record->state == MeshState::kReady ? record : nullptr;
}

PlanReport MeshSupply::plan(const PlanLimits& limits, Policy policy) {
  return plan(wants_, limits, policy);
}

PlanReport MeshSupply::plan(std::span<const Want> wants, const PlanLimits& limits, Policy policy) {
  return planner_.plan(wants, *cache_, *cost_, *manager_, limits, policy);
}

double MeshSupply::predict(const Want& want) const {
  return cost_->predict(want.key.model, *want.parameters, want.key.level);
}

std::span<const Completion> MeshSupply::collect() {
  const std::size_t before = arrived_.size();
  manager_->collect(arrived_);
  return std::span(arrived_).subspan(before);
}

MeshSupply::Landed MeshSupply::land(std::uint64_t max_bytes) {
  std::uint64_t bytes = 0;
  std::size_t count = 0;
  while (count < arrived_.size() && bytes < max_bytes) {
    const MeshRecord* record = cache_->get(arrived_[count++].handle);
    if (record != nullptr) bytes += record->range.bytes;
  }
  const auto end = arrived_.begin() + static_cast<std::ptrdiff_t>(count);
  Landed landed{{std::make_move_iterator(arrived_.begin()), std::make_move_iterator(end)}, 0};
  arrived_.erase(arrived_.begin(), end);
  landed.bytes = synthesis::land(landed.completions, *cache_, cost_.get()).bytes;
  return landed;
}

bool MeshSupply::quiesce() {
  begin_wants();
  plan({}, Policy::kDeadline);
  for (const Request& unmade : manager_->quiesce())
    cache_->cancel(unmade.handle);
  collect();
  land(UINT64_MAX);
  return manager_->is_idle();
}

void MeshSupply::adopt_types(std::vector<Annotate> annotate) {
  auto cost = std::make_unique<CostModel>(cache_->registry());
  cost->learn_from(*cost_);
  cost_ = std::move(cost);
  manager_->set_notes(std::move(annotate));
}

}  // namespace psygen::synthesis
