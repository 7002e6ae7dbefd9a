#include "engine/telemetry/own_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/clock.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::string_view kMilliseconds = "ms";

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

// True for "ai" and "ai.paths": in files with dotted keys, one name cannot be a value and a table.
bool continues(std::string_view name, std::string_view other) {
  return name.size() > other.size() && name.starts_with(other) && name[other.size()] == '.';
}

tl::unexpected<core::Error> refuse(const FigureInfo& info, std::string_view sentence) {
  return core::invalid_argument(
      fmt::format("the figure '{}': {}", core::shown(info.name, kMaxOwnNameBytes), sentence));
}

bool is_unit(std::string_view unit) {
  return unit.size() <= kMaxUnitBytes && core::shown(unit) == unit;
}

}  // namespace

std::string_view name_of(FigureKind kind) {
  constexpr std::array<std::string_view, 3> kNames{"gauge", "counter", "duration"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool is_own_name(std::string_view name) {
  if (name.empty() || name.size() > kMaxOwnNameBytes) return false;
  char before = '.';
  for (const char c : name) {
    if (!is_word(c) && (c != '.' || before == '.')) return false;
    before = c;
  }
  return before != '.';
}

void OwnFigure::report(double value) {
  if (slot_ == nullptr) return;
  if (!std::isfinite(value)) {
    slot_->invalid.fetch_add(1, std::memory_order_relaxed);
  } else if (slot_->kind == FigureKind::kGauge) {
    slot_->value.store(value, std::memory_order_relaxed);
  } else {
    slot_->value.fetch_add(value, std::memory_order_relaxed);
  }
}

ScopedTime::ScopedTime(OwnFigure& figure) : figure_(figure), start_s_(core::monotonic_seconds()) {}

ScopedTime::~ScopedTime() {
  figure_.report((core::monotonic_seconds() - start_s_) * 1000.0);
}

core::Result<OwnFigure> OwnFigures::add(FigureInfo info) {
  if (closed_) return refuse(info, "figures are declared before the first frame (add_systems)");
  if (!is_own_name(info.name))
    return refuse(info, fmt::format("a name has 1 to {} of a-z, 0-9 and _, and single dots between",
                                    kMaxOwnNameBytes));
  if (info.kind == FigureKind::kDuration && info.unit.empty()) info.unit = kMilliseconds;
  if (info.kind == FigureKind::kDuration && info.unit != kMilliseconds)
    return refuse(info, fmt::format("a duration is in ms, not in {}", core::shown(info.unit, 32)));
  if (!is_unit(info.unit))
    return refuse(
        info, fmt::format("a unit has at most {} bytes without control characters", kMaxUnitBytes));
  for (const FigureInfo& other : infos_) {
    if (other.name == info.name) return refuse(info, "it is declared twice");
    if (continues(info.name, other.name) || continues(other.name, info.name))
      return refuse(info,
                    fmt::format("its name and '{}' differ only by words after a dot", other.name));
  }
  if (infos_.size() >= kMaxOwnFigures)
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("the figure '{}': the maximum of {} figures is reached",
                                  info.name, kMaxOwnFigures));
  detail::FigureSlot& slot = slots_.emplace_back(info.kind);
  infos_.push_back(std::move(info));
  return OwnFigure(slot);
}

void OwnFigures::take(std::vector<double>& values) {
  values.clear();
  for (detail::FigureSlot& slot : slots_)
    values.push_back(slot.kind == FigureKind::kGauge
                         ? slot.value.load(std::memory_order_relaxed)
                         : slot.value.exchange(0.0, std::memory_order_relaxed));
}

std::vector<std::uint64_t> OwnFigures::invalid_counts() const {
  std::vector<std::uint64_t> counts;
  for (const detail::FigureSlot& slot : slots_)
    counts.push_back(slot.invalid.load(std::memory_order_relaxed));
  return counts;
}

}  // namespace psygen::telemetry
