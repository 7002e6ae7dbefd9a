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

class PaintChange {
 public:
  // The picture `name` as a whole; null: it has none in memory.
  PaintChange(std::string name, PicturePtr before, PicturePtr after)
      : name_(std::move(name)), whole_{std::move(before), std::move(after)} {}
  // The pixels in which two pictures of one size differ.
  static PaintChange between(std::string name, const world::GreyPicture& before,
                             const world::GreyPicture& after);

  const std::string& name() const { return name_; }
  // What the picture becomes: `done`, or undone. Where it has another size by now it stays.
  PicturePtr applied(const PicturePtr& now, bool done) const;

 private:
  explicit PaintChange(std::string name) : name_(std::move(name)) {}

  std::string name_;
  PicturePtr whole_[2];  // undone, done
  bool is_part_ = false;
  std::uint32_t width_ = 0, height_ = 0;  // of the picture
  std::uint32_t left_ = 0, top_ = 0, columns_ = 0, rows_ = 0;
  std::vector<std::uint16_t> pixels_[2];
};

}  // namespace psygen::editor
