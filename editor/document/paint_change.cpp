#include "editor/document/paint_change.hpp"

#include <algorithm>

namespace psygen::editor {

PaintChange PaintChange::between(std::string name, const world::GreyPicture& before,
                                 const world::GreyPicture& after) {
  PaintChange change(std::move(name));
  change.is_part_ = true;
  change.width_ = after.width, change.height_ = after.height;
  std::uint32_t left = after.width, top = after.height, right = 0, bottom = 0;
  for (std::uint32_t y = 0; y < after.height; ++y) {
    for (std::uint32_t x = 0; x < after.width; ++x) {
      const std::size_t i = std::size_t{y} * after.width + x;
      if (before.pixels[i] == after.pixels[i]) continue;
      left = std::min(left, x), right = std::max(right, x + 1);
      top = std::min(top, y), bottom = std::max(bottom, y + 1);
    }
  }
  if (left >= right) return change;
  change.left_ = left, change.top_ = top;
  change.columns_ = right - left, change.rows_ = bottom - top;
  for (const auto& [from, to] :
       {std::pair{&before, &change.pixels_[0]}, std::pair{&after, &change.pixels_[1]}}) {
    for (std::uint32_t y = top; y < bottom; ++y) {
      const auto row = from->pixels.begin() + std::ptrdiff_t{y} * after.width;
      to->insert(to->end(), row + left, row + right);
    }
  }
  return change;
}

PicturePtr PaintChange::applied(const PicturePtr& now, bool done) const {
  if (!is_part_) return whole_[done ? 1 : 0];
  if (!now || now->width != width_ || now->height != height_) return now;
  auto next = std::make_shared<world::GreyPicture>(*now);
  const std::vector<std::uint16_t>& pixels = pixels_[done ? 1 : 0];
  for (std::uint32_t y = 0; y < rows_; ++y) {
    std::copy_n(pixels.begin() + std::ptrdiff_t{y} * columns_, columns_,
                next->pixels.begin() + std::ptrdiff_t{top_ + y} * width_ + left_);
  }
  next->hash = world::content_hash(*next);
  return next;
}

}  // namespace psygen::editor
