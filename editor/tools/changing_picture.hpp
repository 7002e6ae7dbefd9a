// An image that changes rectangle by rectangle while other threads read its older states. A state
// that is in use is immutable. A released state's memory is reused for a later state, into which
// only the changed pixels are copied. A change therefore costs as much as its rectangle, unless
// many states are in use. Any thread may release a state; all other calls come from one thread.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "editor/document/paint_change.hpp"

namespace psygen::editor {

// The newest state of an image, and the memory of released states.
class ChangingPicture {
 public:
  explicit ChangingPicture(PicturePtr first) : now_(std::move(first)) {}

  // The newest state.
  const PicturePtr& now() const { return now_; }
  // Makes the next state: `write` changes pixels of the rectangle only. Updates the hash.
  void change(const PixelRect& rect, const std::function<void(world::GreyPicture&)>& write);

 private:
  // Memory of a released state.
  struct Spare {
    std::unique_ptr<world::GreyPicture> picture;
    std::size_t state = 0;  // its number
  };
  struct Spares;
  std::unique_ptr<world::GreyPicture> memory_of_now();

  PicturePtr now_;
  std::vector<PixelRect> changes_;  // of each state except the first
  std::shared_ptr<Spares> spares_;
};

}  // namespace psygen::editor
