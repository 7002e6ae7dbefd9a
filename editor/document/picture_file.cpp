#include "editor/document/picture_file.hpp"

#include "engine/image/image_io.hpp"

namespace psygen::editor {

core::Result<void> write_picture_file(const std::filesystem::path& file,
                                      const world::GreyPicture& picture) {
  return image::write_png(file, image::GreyImage{picture.width, picture.height, picture.pixels});
}

}  // namespace psygen::editor
