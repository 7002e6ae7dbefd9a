// Painted images: the change of an image by an undo step, as the pixels of a rectangle or as a
// whole image, and writing an image as a PNG file. Knows no document. Main thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/world/mask.hpp"

namespace psygen::editor {

// An image of a world, shared and immutable.
using PicturePtr = std::shared_ptr<const world::GreyPicture>;

// Pixels left … right − 1 of the rows top … bottom − 1; empty by default.
struct PixelRect {
  std::uint32_t left = 0, top = 0, right = 0, bottom = 0;

  bool empty() const { return left >= right || top >= bottom; }
  // Grows to contain another rectangle.
  void add(const PixelRect& other);
};

class PaintChange {
 public:
  // Replaces the whole image `name`; null: no image in memory.
  PaintChange(std::string name, PicturePtr before, PicturePtr after)
      : name_(std::move(name)), whole_{std::move(before), std::move(after)} {}
  // Replaces the pixels in which two images of one size differ. They must be equal outside of
  // `within`.
  static PaintChange between(std::string name, const world::GreyPicture& before,
                             const world::GreyPicture& after, const PixelRect& within);
  static PaintChange between(std::string name, const world::GreyPicture& before,
                             const world::GreyPicture& after) {
    return between(std::move(name), before, after, {0, 0, after.width, after.height});
  }

  const std::string& name() const { return name_; }
  // Returns the image after the change (`done`) or after its undo. An image that has another size
  // by now stays as it is.
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

// Writes an image as a PNG file with 16 bits, atomically. Fails with kIo; the message starts with
// the path.
core::Result<void> write_picture_file(const std::filesystem::path& file,
                                      const world::GreyPicture& picture);

}  // namespace psygen::editor
