#include "editor/tools/changing_picture.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

namespace psygen::editor {
namespace {

void copy_rect(const world::GreyPicture& from, world::GreyPicture& to, const PixelRect& rect) {
  for (std::uint32_t y = rect.top; y < rect.bottom; ++y) {
    const auto row = static_cast<std::ptrdiff_t>(std::size_t{y} * from.width);
    std::copy(from.pixels.begin() + row + rect.left, from.pixels.begin() + row + rect.right,
              to.pixels.begin() + row + rect.left);
  }
}

std::uint64_t hash_of_rows(const world::GreyPicture& picture, const PixelRect& rect) {
  std::uint64_t hash = 0;
  for (std::uint32_t y = rect.top; y < rect.bottom; ++y)
    hash += world::row_hash(picture, y);
  return hash;
}

}  // namespace

// Shared with the states in use, whose memory any thread returns here.
struct ChangingPicture::Spares {
  std::mutex mutex;
  std::vector<Spare> all;

  // Takes the memory of the newest released state.
  std::optional<Spare> take() {
    const std::lock_guard lock(mutex);
    const auto newest = std::ranges::max_element(all, {}, &Spare::state);
    if (newest == all.end()) return std::nullopt;
    Spare spare = std::move(*newest);
    all.erase(newest);
    return spare;
  }
  void give(Spare spare) {
    const std::lock_guard lock(mutex);
    all.push_back(std::move(spare));
  }
};

std::unique_ptr<world::GreyPicture> ChangingPicture::memory_of_now() {
  auto spare = spares_->take();
  if (!spare) return std::make_unique<world::GreyPicture>(*now_);
  PixelRect stale;
  for (std::size_t i = spare->state; i < changes_.size(); ++i)
    stale.add(changes_[i]);
  copy_rect(*now_, *spare->picture, stale);
  spare->picture->hash = now_->hash;
  return std::move(spare->picture);
}

void ChangingPicture::change(const PixelRect& rect,
                             const std::function<void(world::GreyPicture&)>& write) {
  if (!spares_) spares_ = std::make_shared<Spares>();
  std::unique_ptr<world::GreyPicture> next = memory_of_now();
  next->hash -= hash_of_rows(*next, rect);
  write(*next);
  next->hash += hash_of_rows(*next, rect);
  changes_.push_back(rect);
  const auto give_memory_back = [home = std::weak_ptr(spares_),
                                 state = changes_.size()](const world::GreyPicture* picture) {
    std::unique_ptr<world::GreyPicture> memory(const_cast<world::GreyPicture*>(picture));
    if (const auto spares = home.lock()) spares->give({std::move(memory), state});
  };
  now_ = PicturePtr(next.release(), give_memory_back);
}

}  // namespace psygen::editor
