// Painted images of a document: masks in memory until the world is saved.
#include <gmock/gmock.h>

#include "editor/document/document.hpp"
#include "engine/image/image_io.hpp"
#include "engine/world/files/text_edit.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor {
namespace {

using testing::good;
using ::testing::HasSubstr;
using testing::kWorld;
using testing::Place;

constexpr const char* kName = "trees.png";

PicturePtr grey_picture(std::uint16_t value, std::uint32_t side = 8) {
  auto picture = std::make_shared<world::GreyPicture>();
  picture->width = picture->height = side;
  picture->pixels.assign(std::size_t{side} * side, value);
  picture->hash = world::content_hash(*picture);
  return picture;
}

void write_grey(const std::filesystem::path& file, const PicturePtr& picture) {
  EXPECT_TRUE(good(
      image::write_png(file, image::GreyImage{picture->width, picture->height, picture->pixels})));
}

std::string with_mask(const std::string& text) {
  auto with = world::with_value(text, {"scatter", 0, "mask_image"}, "\"trees.png\"");
  return world::with_value(*with, {"scatter", 0, "mask_area_m"}, "[0, 0, 100, 100]").value();
}

// A world whose trees have a new mask.
struct Painted {
  Place place;
  std::unique_ptr<Document> document = std::make_unique<Document>(place.options());
  std::filesystem::path picture = place.file.parent_path() / kName;

  Painted() {
    EXPECT_TRUE(good(document->open(place.file)));
    add_mask();
  }
  void add_mask() {
    EXPECT_TRUE(good(document->paint("New mask", {PaintChange(kName, nullptr, grey_picture(9))},
                                     with_mask(document->text()))));
  }
  std::uint16_t shown() { return document->world().scatter[0].mask.picture->pixels[0]; }
  core::Result<void> paint(std::uint16_t value) {
    const PicturePtr before = document->picture(kName);
    return document->paint("Paint", {PaintChange::between(kName, *before, *grey_picture(value))},
                           document->text());
  }
  std::uint16_t on_disk() {
    const auto read = image::read_grey(picture);
    return read ? read->grey[0] : std::uint16_t{0};
  }
};

// A missing file does not affect the undo steps.
TEST(DocumentPictures, StepsAreUndoneAlthoughAFileIsMissing) {
  Place place;
  Document document(place.options());
  ASSERT_TRUE(good(document.open(place.file)));
  const std::filesystem::path file = place.file.parent_path() / kName;
  write_grey(file, grey_picture(300));
  ASSERT_TRUE(good(document.set_text(with_mask(document.text()), "Mask")));
  ASSERT_TRUE(good(document.set_value({"sky", "exposure"}, "2")));
  std::filesystem::remove(file);
  document.undo_stack().undo();
  EXPECT_EQ(document.world().sky.exposure, 1);
  EXPECT_EQ(document.world().scatter[0].mask.picture->pixels[0], 300);
  document.undo_stack().redo();
  EXPECT_EQ(document.world().sky.exposure, 2);
  document.undo_stack().undo();
  document.undo_stack().undo();
  EXPECT_EQ(document.text(), kWorld);
  EXPECT_EQ(document.world().scatter[0].mask.picture, nullptr);
}

TEST(DocumentPictures, AreWrittenWithTheWorldAndNotBefore) {
  Painted painted;
  Document& document = *painted.document;
  EXPECT_EQ(painted.shown(), 9);
  EXPECT_TRUE(document.is_modified());
  EXPECT_FALSE(std::filesystem::exists(painted.picture));
  EXPECT_TRUE(good(painted.paint(500)));
  EXPECT_EQ(document.undo_stack().count(), 2);
  EXPECT_TRUE(good(document.save()));
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(painted.on_disk(), 500) << "16 bits";
  EXPECT_TRUE(good(painted.paint(700)));
  EXPECT_TRUE(document.is_modified()) << "though the text is the same";
  EXPECT_EQ(document.unsaved_diff(), "Binary files trees.png and trees.png (unsaved) differ\n");
  EXPECT_EQ(painted.on_disk(), 500);
  document.undo_stack().undo();
  EXPECT_EQ(painted.shown(), 500);
  EXPECT_FALSE(document.is_modified());
  document.undo_stack().undo();
  EXPECT_EQ(painted.shown(), 9) << "before the save";
  EXPECT_TRUE(document.is_modified());
  document.undo_stack().undo();
  EXPECT_EQ(document.text(), kWorld);
  document.undo_stack().redo();
  document.undo_stack().redo();
  EXPECT_FALSE(document.is_modified());
  document.undo_stack().redo();
  EXPECT_EQ(painted.shown(), 700);
  EXPECT_TRUE(good(document.save()));
  EXPECT_TRUE(good(document.open(painted.place.file)));
  EXPECT_EQ(painted.shown(), 700);
}

TEST(DocumentPictures, APreviewIsNoStep) {
  Painted painted;
  EXPECT_TRUE(good(painted.document->save()));
  EXPECT_TRUE(good(painted.document->preview_picture(kName, grey_picture(77))));
  EXPECT_EQ(painted.shown(), 77);
  EXPECT_EQ(painted.document->undo_stack().count(), 1);
  EXPECT_TRUE(good(painted.document->preview_picture(kName, grey_picture(9))));
  EXPECT_FALSE(painted.document->is_modified());
}

TEST(DocumentPictures, ChangedByOthersAreReplacedOnlyWhenSavedTwice) {
  Painted painted;
  Document& document = *painted.document;
  EXPECT_TRUE(good(document.save()));
  EXPECT_TRUE(good(painted.paint(500)));
  write_grey(painted.picture, grey_picture(4444));
  const auto refused = document.save();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("trees.png: another program replaced this image"));
  EXPECT_EQ(painted.on_disk(), 4444);
  EXPECT_TRUE(document.is_modified());
  write_grey(painted.picture, grey_picture(5555));
  EXPECT_FALSE(document.save()) << "yet another one";
  EXPECT_TRUE(good(document.save()));
  EXPECT_EQ(painted.on_disk(), 500);
}

TEST(DocumentPictures, LoseNothingIfTheyCannotBeWritten) {
  Painted painted;
  Document& document = *painted.document;
  std::filesystem::create_directory(painted.picture);
  EXPECT_FALSE(document.save()) << "something else is there";
  EXPECT_FALSE(document.save()) << "and it is no file";
  EXPECT_EQ(testing::read(painted.place.file), kWorld) << "then the text is not written";
  EXPECT_TRUE(document.is_modified());
  EXPECT_EQ(painted.shown(), 9);
  std::filesystem::remove(painted.picture);
  EXPECT_TRUE(good(document.save()));
  EXPECT_EQ(painted.on_disk(), 9);
  // A missing file is written again, and steps do not need it.
  EXPECT_TRUE(good(painted.paint(500)));
  std::filesystem::remove(painted.picture);
  document.undo_stack().undo();
  EXPECT_EQ(painted.shown(), 9);
  document.undo_stack().redo();
  EXPECT_TRUE(good(document.save()));
  EXPECT_EQ(painted.on_disk(), 500);
}

TEST(DocumentPictures, OfAWorldWithoutAFileAreWrittenBesideItsFirst) {
  Painted painted;
  Document& document = *painted.document;
  EXPECT_TRUE(good(document.make_new()));
  painted.add_mask();
  EXPECT_EQ(painted.shown(), 9);
  const auto folder = painted.place.folder.path() / "other";
  std::filesystem::create_directory(folder);
  EXPECT_TRUE(good(document.save_as(folder / "new.toml")));
  EXPECT_TRUE(std::filesystem::exists(folder / kName));
  // Saving in another folder writes them there.
  const auto next = painted.place.folder.path() / "next";
  std::filesystem::create_directory(next);
  EXPECT_TRUE(good(document.save_as(next / "new.toml")));
  EXPECT_TRUE(std::filesystem::exists(next / kName));
  EXPECT_TRUE(good(document.open(next / "new.toml")));
  EXPECT_EQ(painted.shown(), 9);
}

TEST(DocumentPictures, AreRevertedWithTheText) {
  Painted painted;
  Document& document = *painted.document;
  EXPECT_TRUE(good(document.save()));
  EXPECT_TRUE(good(painted.paint(500)));
  EXPECT_TRUE(good(document.revert()));
  EXPECT_EQ(painted.shown(), 9);
  EXPECT_FALSE(document.is_modified());
  document.undo_stack().undo();
  EXPECT_EQ(painted.shown(), 500);
}

TEST(DocumentPictures, ReturnAfterACrash) {
  for (const bool has_file : {true, false}) {
    Painted painted;
    if (!has_file) {
      EXPECT_TRUE(good(painted.document->make_new()));
      painted.add_mask();
    }
    EXPECT_TRUE(good(painted.paint(500)));
    EXPECT_TRUE(good(painted.document->write_recovery()));
    // The files of a killed editor, without locks.
    const auto left_state = painted.place.folder.path() / "left";
    std::filesystem::copy(painted.place.state, left_state);
    painted.document.reset();
    const auto is_lock = [](const auto& entry) { return entry.path().extension() == ".lock"; };
    std::vector<std::filesystem::path> locks;
    for (const auto& entry : std::filesystem::directory_iterator(left_state))
      if (is_lock(entry)) locks.push_back(entry.path());
    for (const auto& lock : locks)
      std::filesystem::remove(lock);
    DocumentOptions options;
    options.state_folder = left_state;
    painted.document = std::make_unique<Document>(options);
    const auto left = painted.document->recoveries();
    ASSERT_EQ(left.size(), 1U);
    EXPECT_TRUE(good(painted.document->recover(left[0])));
    EXPECT_EQ(painted.shown(), 500);
    EXPECT_TRUE(painted.document->is_modified());
    if (has_file) {
      EXPECT_TRUE(good(painted.document->save()));
      EXPECT_EQ(painted.on_disk(), 500);
    }
    painted.document.reset();
    for (const auto& entry : std::filesystem::directory_iterator(left_state))
      EXPECT_NE(entry.path().extension(), ".png") << "a clean end leaves nothing";
  }
}

}  // namespace
}  // namespace psygen::editor
