#include "editor/document/paint_change.hpp"

#include <algorithm>

#include "engine/image/image_io.hpp"

namespace psygen::editor {

void PixelRect::add(const PixelRect& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  left = std::min(left, other.left), right = std::max(right, other.right);
  top = std::min(top, other.top), bottom = std::max(bottom, other.bottom);
}

PaintChange PaintChange::between(std::string name, const world::GreyPicture& before,
                                 const world::GreyPicture& after, const PixelRect& within) {
  PaintChange change(std::move(name));
  change.is_part_ = true;
  change.width_ = after.width, change.height_ = after.height;
  PixelRect& rect = change.rect_;
  for (std::uint32_t y = within.top; y < within.bottom; ++y) {
    for (std::uint32_t x = within.left; x < within.right; ++x) {
      const std::size_t i = std::size_t{y} * after.width + x;
      if (before.pixels[i] != after.pixels[i]) rect.add({x, y, x + 1, y + 1});
    }
  }
  for (const auto& [from, to] :
       {std::pair{&before, &change.pixels_[0]}, std::pair{&after, &change.pixels_[1]}}) {
    for (std::uint32_t y = rect.top; y < rect.bottom; ++y) {
      const auto row = from->pixels.begin() + std::ptrdiff_t{y} * after.width;
      to->insert(to->end(), row + rect.left, row + rect.right);
    }
  }
  return change;
}

PicturePtr PaintChange::applied(const PicturePtr& now, bool done) const {
  if (!is_part_) return whole_[done ? 1 : 0];
  if (!now || now->width != width_ || now->height != height_) return now;
  auto next = std::make_shared<world::GreyPicture>(*now);
  const std::uint32_t columns = rect_.right - rect_.left;
  auto from = pixels_[done ? 1 : 0].begin();
  for (std::uint32_t y = rect_.top; y < rect_.bottom; ++y, from += columns) {
    next->hash -= world::row_hash(*next, y);
    std::copy_n(from, columns, next->pixels.begin() + std::ptrdiff_t{y} * width_ + rect_.left);
    next->hash += world::row_hash(*next, y);
  }
  return next;
}

core::Result<void> write_picture_file(const std::filesystem::path& file,
                                      const world::GreyPicture& picture) {
  return image::write_png(file, image::GreyImage{picture.width, picture.height, picture.pixels});
}

}  // namespace psygen::editor
