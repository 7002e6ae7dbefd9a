// Saving a world in another folder: all referenced files are copied, or none.
#include <gmock/gmock.h>

#include <set>

#include "editor/document/document.hpp"
#include "engine/image/image_io.hpp"
#include "tests/editor/document/support.hpp"
#include "tests/engine/handmade/shapes.hpp"
#include "tests/faults.hpp"

namespace psygen::editor {
namespace {

using ::testing::AllOf;
using testing::good;
using ::testing::HasSubstr;
using testing::Place;
using testing::read;
using ::testing::UnorderedElementsAre;

constexpr const char* kNamingWorld = R"(format = 1
[world]
name = "with files"
seed = 5
blocks = [8, 4]
[terrain]
octaves = 4
[palette]
grass_image = "ground/grass.png"
[[model]]
name = "ball"
file = "things/ball.gltf"
[[scatter]]
model = "ball"
count = 2
mask_image = "balls.png"
[[stamp]]
image = "hill.png"
centre_m = [100, 100]
size_m = 60
height_m = 5
)";

// A folder with a world and all referenced files, and another folder.
struct WithFiles {
  Place place{kNamingWorld};
  std::filesystem::path from = place.folder.path(), to = place.folder.path() / "other";
  std::unique_ptr<Document> document = std::make_unique<Document>(place.options());

  WithFiles() {
    for (const char* folder : {"ground", "things", "things/parts", "other"})
      std::filesystem::create_directory(from / folder);
    const gltf::Sample sample = handmade::ball(12, 16);
    gltf::write_bytes(from / "things/ball.gltf", sample.text("parts/a ball.bin"));
    gltf::write_bytes(from / "things/parts/a ball.bin", sample.binary);
    write_grey("balls.png", 9);
    write_grey("hill.png", 10);
    EXPECT_TRUE(good(
        image::write_png(from / "ground/grass.png", image::make_image(8, 8, 10, 200, 10, 255))));
    EXPECT_TRUE(good(document->open(place.file)));
  }
  void write_grey(const std::string& name, std::uint16_t value) {
    EXPECT_TRUE(good(image::write_png(
        from / name, image::GreyImage{4, 4, std::vector<std::uint16_t>(16, value)})));
  }
  // One value everywhere.
  void paint(const std::string& name, std::uint16_t value) {
    auto painted = std::make_shared<world::GreyPicture>(*document->picture(name));
    painted->pixels.assign(painted->pixels.size(), value);
    painted->hash = world::content_hash(*painted);
    const auto change = PaintChange::between(name, *document->picture(name), *painted);
    EXPECT_TRUE(good(document->paint("Paint", {change}, document->text())));
  }
  std::set<std::string> in_other() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(to))
      names.insert(entry.path().lexically_relative(to).string());
    return names;
  }
  std::string refusal() {
    const auto saved = document->save_as(to / "new.toml");
    EXPECT_FALSE(saved);
    EXPECT_EQ(document->file(), place.file);
    return saved ? "" : saved.error().message;
  }
};

const std::set<std::string> kAll{"new.toml",         "balls.png",        "hill.png",
                                 "ground",           "ground/grass.png", "things",
                                 "things/ball.gltf", "things/parts",     "things/parts/a ball.bin"};

TEST(SaveAs, InAnotherFolderCopiesAllReferencedFiles) {
  WithFiles bench;
  const auto copied = bench.document->save_as(bench.to / "new.toml");
  ASSERT_TRUE(good(copied));
  EXPECT_THAT(*copied, UnorderedElementsAre("balls.png", "hill.png", "ground/grass.png",
                                            "things/ball.gltf", "things/parts/a ball.bin"));
  EXPECT_EQ(bench.in_other(), kAll);
  for (const std::string& name : *copied)
    EXPECT_EQ(read(bench.to / name), read(bench.from / name)) << name;
  std::filesystem::remove_all(bench.from / "things");
  EXPECT_TRUE(good(bench.document->open(bench.to / "new.toml"))) << "it needs the first no more";
  // Another name in the same folder needs no copies.
  const auto again = bench.document->save_as(bench.to / "again.toml");
  ASSERT_TRUE(good(again));
  EXPECT_TRUE(again->empty());
}

TEST(SaveAs, AnotherFileOfTheSameNameIsReplacedOnlyWhenSavedTwice) {
  WithFiles bench;
  std::filesystem::create_directory(bench.to / "things");
  testing::write(bench.to / "things/ball.gltf", "of somebody");
  testing::write(bench.to / "hill.png", "of somebody else");
  std::filesystem::copy(bench.from / "balls.png", bench.to / "balls.png");
  const auto before = bench.in_other();
  EXPECT_THAT(bench.refusal(),
              AllOf(HasSubstr("things/ball.gltf: another file of this name exists"),
                    HasSubstr("hill.png"), HasSubstr("save again to replace it")));
  EXPECT_EQ(bench.in_other(), before);
  testing::write(bench.to / "hill.png", "of yet another");
  EXPECT_THAT(bench.refusal(), HasSubstr("hill.png")) << "the file has changed again";
  EXPECT_EQ(read(bench.to / "things/ball.gltf"), "of somebody");
  const auto copied = bench.document->save_as(bench.to / "new.toml");
  ASSERT_TRUE(good(copied));
  EXPECT_EQ(copied->size(), 4U) << "balls.png is there";
  EXPECT_EQ(bench.in_other(), kAll);
  EXPECT_EQ(read(bench.to / "hill.png"), read(bench.from / "hill.png"));
}

TEST(SaveAs, AMissingFileIsNamedAndNoNewFilesAreLeft) {
  for (const char* name : {"balls.png", "hill.png", "ground/grass.png", "things/ball.gltf",
                           "things/parts/a ball.bin"}) {
    WithFiles bench;
    std::filesystem::remove(bench.from / name);
    EXPECT_THAT(bench.refusal(), AllOf(HasSubstr(name), HasSubstr("No such file"))) << name;
    EXPECT_EQ(bench.in_other(), std::set<std::string>()) << name;
    std::filesystem::create_directory(bench.from / name);
    EXPECT_THAT(bench.refusal(), AllOf(HasSubstr(name), HasSubstr("not a regular file"))) << name;
  }
}

// Also for painted images, which are written after the copies.
TEST(SaveAs, AFullDiskLeavesNoNewFiles) {
  for (const bool painted : {false, true}) {
    WithFiles bench;
    if (painted) bench.paint("balls.png", 4000);
    std::size_t failures = 0;
    for (std::size_t calls = 0;; ++calls) {
      const FullDisk full(bench.to, calls);
      const auto saved = bench.document->save_as(bench.to / "new.toml");
      if (!full.was_met()) break;
      if (saved) break;  // only writes after the text failed
      ++failures;
      EXPECT_THAT(saved.error().message, HasSubstr("No space left"));
      EXPECT_EQ(saved.error().code, core::ErrorCode::kIo);
      EXPECT_EQ(bench.document->file(), bench.place.file);
      EXPECT_EQ(bench.in_other(), std::set<std::string>()) << "after " << calls << " calls";
    }
    EXPECT_GE(failures, 20U) << "create, write, flush, close and rename of six files";
    EXPECT_EQ(bench.in_other(), kAll);
  }
}

TEST(SaveAs, PaintedPicturesAreUnsavedUntilTheTextIsWritten) {
  WithFiles bench;
  Document& document = *bench.document;
  bench.paint("balls.png", 4000);
  std::filesystem::create_directory(bench.to / "new.toml");
  EXPECT_THAT(bench.refusal(), HasSubstr("new.toml"));
  EXPECT_TRUE(document.is_modified());
  EXPECT_EQ(document.picture("balls.png")->pixels[0], 4000);
  EXPECT_TRUE(good(document.save()));
  EXPECT_EQ(image::read_grey(bench.from / "balls.png")->grey[0], 4000);
}

TEST(SaveAs, AWorldThatComesWithPsygenIsATemplate) {
  const Place place;
  const std::filesystem::path shipped = place.folder / "shipped/worlds/small.toml";
  std::filesystem::create_directories(shipped.parent_path());
  testing::write(shipped, kWorld);
  std::filesystem::create_directory_symlink(place.folder / "shipped", place.folder / "built");
  std::filesystem::create_symlink(shipped, place.folder / "link.toml");
  DocumentOptions options = place.options();
  options.shipped_folders = {place.folder / "none", place.folder / "built/worlds"};
  for (const auto& name : {shipped, place.folder / "link.toml"}) {
    Document document(options), second(options);
    EXPECT_TRUE(good(document.open(name)));
    EXPECT_TRUE(document.is_template());
    EXPECT_TRUE(good(second.open(shipped))) << "nobody writes it";
    EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
    EXPECT_FALSE(document.save());
    EXPECT_FALSE(document.save_as(name));
    EXPECT_FALSE(document.save_as(shipped));
    EXPECT_TRUE(document.is_template() && document.is_modified());
    EXPECT_TRUE(good(document.save_as(place.folder / "mine.toml")));
    EXPECT_FALSE(document.is_template());
    EXPECT_TRUE(good(document.set_value({"world", "seed"}, "7")));
    EXPECT_TRUE(good(document.save()));
    EXPECT_EQ(testing::read(shipped), kWorld);
    EXPECT_TRUE(good(document.open(place.file)));
    EXPECT_FALSE(document.is_template());
  }
}

}  // namespace
}  // namespace psygen::editor
