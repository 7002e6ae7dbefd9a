// A picture that changes a rectangle at a time while others still read older states of it. Each
// state is immutable for as long as anybody holds it; after that its memory becomes a later state,
// into which only what has changed meanwhile is copied. So a change costs what its rectangle costs,
// unless many states are held. States may be released by any thread; all else is one thread's.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "editor/document/paint_change.hpp"

namespace psygen::editor {

class ChangingPicture {
 public:
  explicit ChangingPicture(PicturePtr first) : now_(std::move(first)) {}

  // The newest state.
  const PicturePtr& now() const { return now_; }
  // The next state: `write` changes pixels of the rectangle, and no others. Their hash follows.
  void change(const PixelRect& rect, const std::function<void(world::GreyPicture&)>& write);

 private:
  // Memory of a state that nobody holds any more.
  struct Spare {
    std::unique_ptr<world::GreyPicture> picture;
    std::size_t state = 0;  // which one it was
  };
  struct Spares;
  std::unique_ptr<world::GreyPicture> memory_of_now();

  PicturePtr now_;
  std::vector<PixelRect> changes_;  // of each state but the first
  std::shared_ptr<Spares> spares_;
};

}  // namespace psygen::editor
