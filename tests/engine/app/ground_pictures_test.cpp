// Ground textures of a world file: each error names file and field.
#include "engine/app/ground_pictures.hpp"

#include <fstream>

#include "engine/image/image_io.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class GroundPicturesTest : public ::testing::Test {
 protected:
  std::filesystem::path place(const std::string& name) const { return folder_.path() / name; }

  core::Result<GroundPictures> read(const std::string& name) const {
    world::World world;
    world.palette.images[2] = name;
    return read_ground_pictures(world, place("w.toml"));
  }

  // The error of an image, which begins with the world's file and the field.
  std::string error_of(const std::string& name) const {
    const auto pictures = read(name);
    if (pictures) return "accepted";
    const std::string start =
        place("w.toml").string() + ": palette.dry_image: " + place(name).string();
    EXPECT_THAT(pictures.error().message, StartsWith(start));
    return pictures.error().message;
  }

  void write(const std::string& name, const image::Image& image) const {
    ASSERT_TRUE(image::write_png(place(name), image));
  }

  TemporaryFolder folder_;
};

TEST_F(GroundPicturesTest, AreReadFromTheFolderOfTheWorld) {
  std::filesystem::create_directory(place("ground"));
  write("ground/even.png", image::make_image(64, 64, 90, 80, 40, 255));
  const auto pictures = read("ground/even.png");
  ASSERT_TRUE(pictures) << pictures.error().message;
  EXPECT_FALSE((*pictures)[2].rgb.empty());
  EXPECT_TRUE((*pictures)[0].rgb.empty());
}

TEST_F(GroundPicturesTest, AMissingOneIsNamed) {
  EXPECT_THAT(error_of("missing.png"), HasSubstr("missing.png"));
  EXPECT_EQ(read("missing.png").error().code, core::ErrorCode::kIo);
}

TEST_F(GroundPicturesTest, ADamagedOneIsRejected) {
  write("whole.png", image::make_image(64, 64, 90, 80, 40, 255));
  std::filesystem::resize_file(place("whole.png"), 60);
  EXPECT_THAT(error_of("whole.png"), HasSubstr("truncated or damaged"));
  std::ofstream(place("text.png")) << "not a picture";
  EXPECT_THAT(error_of("text.png"), HasSubstr("is not a PNG or JPEG"));
}

TEST_F(GroundPicturesTest, AHugeOneIsRejectedBeforeDecoding) {
  write("huge.png", image::make_image(5000, 16, 90, 80, 40, 255));
  EXPECT_THAT(error_of("huge.png"), HasSubstr("5000 x 16; at most 4096 x 4096"));
}

TEST_F(GroundPicturesTest, AnUnusableOneIsRejected) {
  write("line.png", image::make_image(1, 64, 90, 80, 40, 255));
  EXPECT_THAT(error_of("line.png"), HasSubstr("1 x 64; it must be square"));
  write("glass.png", image::make_image(64, 64, 90, 80, 40, 128));
  EXPECT_THAT(error_of("glass.png"), HasSubstr("transparent"));
  image::Image ramp = image::make_image(64, 64, 0, 80, 40, 255);
  for (std::uint32_t i = 0; i < 64 * 64; ++i)
    ramp.rgba[i * 4] = static_cast<std::uint8_t>(i % 64 * 4);
  write("ramp.png", ramp);
  EXPECT_THAT(error_of("ramp.png"), HasSubstr("without a seam"));
}

TEST_F(GroundPicturesTest, ALinkOutOfTheFolderIsRejected) {
  write("a.png", image::make_image(64, 64, 9, 9, 9, 255));
  std::filesystem::create_directory(place("worlds"));
  std::filesystem::create_symlink(place("a.png"), place("worlds/link.png"));
  world::World world;
  world.palette.images[2] = "link.png";
  const auto pictures = read_ground_pictures(world, place("worlds/w.toml"));
  ASSERT_FALSE(pictures);
  EXPECT_THAT(pictures.error().message, HasSubstr("leads out of the folder"));
  EXPECT_TRUE(read_ground_pictures(world, place("w.toml")).error().code == core::ErrorCode::kIo);
}

TEST_F(GroundPicturesTest, ASessionWithABadOneFailsWithAMessage) {
  std::ifstream paper(source_file("game/worlds/paper.toml"));
  std::string text{std::istreambuf_iterator<char>(paper), std::istreambuf_iterator<char>()};
  const std::size_t palette = text.find("[palette]\n");
  if (palette == std::string::npos) {
    text += "\n[palette]\nrock_image = \"stone.png\"\n";
  } else {
    text.insert(palette + 10, "rock_image = \"stone.png\"\n");
  }
  std::ofstream(place("w.toml")) << text;
  SessionOptions options = short_session();
  options.world_file = place("w.toml");
  const auto refused = Session::create(options);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr("w.toml: palette.rock_image: "), HasSubstr("stone.png")));
  write("stone.png", image::make_image(64, 64, 90, 80, 70, 255));
  const auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_TRUE((*session)->renderer().validation_messages().empty());
}

}  // namespace
}  // namespace psygen::app
