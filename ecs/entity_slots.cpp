#include "ecs/entity_slots.hpp"

#include <algorithm>

#include "ecs/check.hpp"

namespace psygen::ecs::detail {

EntitySlots::EntitySlots(std::size_t max_entities, std::uint32_t first_generation)
    : memory_(std::min<std::size_t>(max_entities, UINT32_MAX) * sizeof(Slot)),
      max_entities_(std::min<std::size_t>(max_entities, UINT32_MAX)),
      first_generation_(std::max(first_generation, 1U)) {}

void EntitySlots::reserve_more(std::size_t count) {
  const std::size_t fresh = count - std::min(count, free_.size());
  if (fresh > max_entities_ - count_) give_up("more entities than WorldLimits::max_entities");
  const std::size_t need_bytes = (count_ + fresh) * sizeof(Slot);
  if (need_bytes <= memory_.committed_bytes()) return;
  const std::size_t ahead = std::max(need_bytes, memory_.committed_bytes() * 2);
  memory_.commit(std::max(need_bytes, std::min(ahead, memory_.capacity_bytes())));
}

void EntitySlots::issue(std::span<Entity> out, std::uint32_t first_location) {
  reserve_more(out.size());
  const std::size_t reused = std::min(out.size(), free_.size());
  const std::uint32_t* top = free_.data() + free_.size();
  for (std::size_t i = 0; i < reused; ++i) {
    const std::uint32_t index = *--top;
    Slot& slot = slots()[index];
    slot.location = first_location + static_cast<std::uint32_t>(i);
    out[i] = {index, slot.generation};
  }
  free_.resize(free_.size() - reused);

  for (std::size_t i = reused; i < out.size(); ++i) {
    slots()[count_] = {first_generation_, first_location + static_cast<std::uint32_t>(i)};
    out[i] = {count_++, first_generation_};
  }
}

void EntitySlots::restore(std::span<const std::uint32_t> generations,
                          std::span<const std::uint32_t> free) {
  count_ = static_cast<std::uint32_t>(generations.size());
  memory_.commit(generations.size() * sizeof(Slot));
  retired_ = 0;
  for (std::size_t i = 0; i < generations.size(); ++i) {
    slots()[i] = {generations[i], kNowhere};
    retired_ += generations[i] == 0 ? 1 : 0;
  }
  free_.assign(free.begin(), free.end());
}

}  // namespace psygen::ecs::detail
