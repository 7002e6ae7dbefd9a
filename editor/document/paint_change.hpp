// How an undo step changes one picture beside the world file: the pixels of a rectangle, or the
// picture as a whole. It keeps only what changes. Knows no files and no document. Main thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/mask.hpp"

namespace psygen::editor {

using PicturePtr = std::shared_ptr<const world::GreyPicture>;

// Pixels left … right − 1 of the rows top … bottom − 1; by default none.
struct PixelRect {
  std::uint32_t left = 0, top = 0, right = 0, bottom = 0;

  bool empty() const { return left >= right || top >= bottom; }
  // Grows so that it holds another one.
  void add(const PixelRect& other);
};

class PaintChange {
 public:
  // The picture `name` as a whole; null: it has none in memory.
  PaintChange(std::string name, PicturePtr before, PicturePtr after)
      : name_(std::move(name)), whole_{std::move(before), std::move(after)} {}
  // The pixels in which two pictures of one size differ; outside of `within` they must not.
  static PaintChange between(std::string name, const world::GreyPicture& before,
                             const world::GreyPicture& after, const PixelRect& within);
  static PaintChange between(std::string name, const world::GreyPicture& before,
                             const world::GreyPicture& after) {
    return between(std::move(name), before, after, {0, 0, after.width, after.height});
  }

  const std::string& name() const { return name_; }
  // What the picture becomes: `done`, or undone. Where it has another size by now it stays.
  PicturePtr applied(const PicturePtr& now, bool done) const;

 private:
  explicit PaintChange(std::string name) : name_(std::move(name)) {}

  std::string name_;
  PicturePtr whole_[2];  // undone, done
  bool is_part_ = false;
  std::uint32_t width_ = 0, height_ = 0;  // of the picture
  PixelRect rect_;
  std::vector<std::uint16_t> pixels_[2];
};

}  // namespace psygen::editor
