#include "engine/image/image_io.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "tests/engine/image/test_files.hpp"
#include "tests/full_disk.hpp"
#include "tests/source_file.hpp"

namespace psygen::image {
namespace {

using core::ErrorCode;

const std::filesystem::path kJpegFile = source_file("tests/engine/image/data/two_halves.jpg");

void put_big_endian(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

// Updates the checksum of the chunk at `at` to its present content.
void repair_checksum(std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t length) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (std::size_t i = at + 4; i < at + 8 + length; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  put_big_endian(bytes, at + 8 + length, ~crc);
}

// A written PNG whose header states another size, so that the reader must reject the header.
std::vector<std::uint8_t> png_that_claims(const std::filesystem::path& path, std::uint32_t width,
                                          std::uint32_t height) {
  EXPECT_TRUE(write_png(path, make_image(1, 1)));
  std::vector<std::uint8_t> bytes = bytes_of(path);
  put_big_endian(bytes, 16, width);
  put_big_endian(bytes, 20, height);
  repair_checksum(bytes, 8, 13);
  return bytes;
}

TEST(ImageIo, APngComesBackBitForBitWithItsAlpha) {
  const TemporaryFolder folder;
  const Image image = noise_image(67, 31);
  ASSERT_TRUE(write_png(folder / "noise.png", image));
  const auto read = read_image(folder / "noise.png");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, image);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(ImageIo, ReadsGreyValuesWithSixteenBits) {
  const auto ramp = read_grey(source_file("tests/engine/image/data/ramp_16_bits.png"));
  ASSERT_TRUE(ramp) << ramp.error().message;
  EXPECT_EQ(ramp->width, 4U);
  EXPECT_EQ(ramp->height, 2U);
  EXPECT_EQ(ramp->grey, (std::vector<std::uint16_t>{0, 1, 256, 65535, 1000, 2000, 3000, 40001}));
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "red.png", make_image(3, 1, 255, 0, 0, 255)));
  const auto mean = read_grey(folder / "red.png");
  ASSERT_TRUE(mean) << mean.error().message;
  EXPECT_EQ(mean->grey, std::vector<std::uint16_t>(3, 21845));
  const GreyImage steps{3, 2, {0, 1, 257, 32768, 65534, 65535}};
  ASSERT_TRUE(write_png(folder / "steps.png", steps));
  EXPECT_EQ(read_grey(folder / "steps.png")->grey, steps.grey) << "all 16 bits are written";
  EXPECT_FALSE(write_png(folder / "steps.png", GreyImage{3, 2, {0, 1}}));
  EXPECT_EQ(read_grey(folder / "no.png").error().code, ErrorCode::kIo);
  EXPECT_EQ(read_grey(folder / "red.png", {2, 2, 16, 1000}).error().code, ErrorCode::kOverBudget);
}

// An OpenEXR file without compression: one channel of floats, 3 × 2 pixels.
std::vector<std::uint8_t> small_exr() {
  std::vector<std::uint8_t> bytes;
  const auto put = [&bytes](auto value) {
    std::uint8_t raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.insert(bytes.end(), raw, raw + sizeof value);
  };
  const auto text = [&bytes](std::string_view name) {
    bytes.insert(bytes.end(), name.begin(), name.end());
    bytes.push_back(0);
  };
  const auto attribute = [&](std::string_view name, std::string_view type, std::uint32_t size) {
    text(name);
    text(type);
    put(size);
  };
  put(std::uint32_t{20'000'630});
  put(std::uint32_t{2});
  attribute("channels", "chlist", 19);
  text("Y");
  for (const std::uint32_t v : {2U, 0U, 1U, 1U})  // float, linear, every pixel
    put(v);
  bytes.push_back(0);
  attribute("compression", "compression", 1);
  bytes.push_back(0);
  for (const char* window : {"dataWindow", "displayWindow"}) {
    attribute(window, "box2i", 16);
    for (const std::int32_t v : {0, 0, 2, 1})
      put(v);
  }
  attribute("lineOrder", "lineOrder", 1);
  bytes.push_back(0);
  attribute("pixelAspectRatio", "float", 4);
  put(1.0F);
  attribute("screenWindowCenter", "v2f", 8);
  put(0.0F);
  put(0.0F);
  attribute("screenWindowWidth", "float", 4);
  put(1.0F);
  bytes.push_back(0);
  const std::uint64_t first = bytes.size() + 16;
  put(first);
  put(first + 20);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float pixels[2][3] = {{0, 0.5F, 1}, {-3, 7, nan}};
  for (std::int32_t y = 0; y < 2; ++y) {
    put(y);
    put(std::uint32_t{12});
    for (const float v : pixels[y])
      put(v);
  }
  return bytes;
}

TEST(ImageIo, ReadsOpenExrAsGreyValuesOnly) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.exr", small_exr());
  const auto grey = read_grey(folder / "a.exr");
  ASSERT_TRUE(grey) << grey.error().message;
  EXPECT_EQ(grey->width, 3U);
  EXPECT_EQ(grey->height, 2U);
  EXPECT_EQ(grey->grey, (std::vector<std::uint16_t>{0, 32768, 65535, 0, 65535, 0}));
  const auto image = read_image(folder / "a.exr");
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("is not a PNG or JPEG"), std::string::npos);
  EXPECT_EQ(read_grey(folder / "a.exr", {2, 2, 800, 1000}).error().code, ErrorCode::kOverBudget);
}

TEST(ImageIo, DamagedOpenExrFilesAreErrorsOrImagesWithinTheLimits) {
  expect_errors_or_images(small_exr(), read_grey, &GreyImage::grey);
}

TEST(ImageIo, ReadsAJpegWithAnyFileName) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(kJpegFile, folder / "picture.png");
  const auto read = read_image(folder / "picture.png");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->width, 24U);
  ASSERT_EQ(read->height, 16U);
  EXPECT_NEAR(read->pixel(2, 8)[1], 40, 8);
  EXPECT_NEAR(read->pixel(21, 8)[1], 120, 8);
  EXPECT_EQ(read->pixel(2, 8)[3], 255);
}

// 8 x 4 pixels of one colour, written by libwebp without loss.
constexpr std::string_view kWebp(
    "RIFF\036\0\0\0WEBPVP8L\021\0\0\0/\007\300\0\020\007P\262\"W\246\200\201\210\350\177\0\0", 38);

TEST(ImageIo, ReadsAWebpWithItsAlphaInColourOnly) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> bytes(kWebp.begin(), kWebp.end());
  const auto image = decode_image(bytes, "a.webp");
  ASSERT_TRUE(image) << image.error().message;
  const Image wanted = make_image(8, 4, 200, 100, 50, 128);
  ASSERT_EQ(image->rgba.size(), wanted.rgba.size());
  for (std::size_t i = 0; i < wanted.rgba.size(); ++i)
    EXPECT_NEAR(image->rgba[i], wanted.rgba[i], 1) << "OpenImageIO multiplies it by the alpha";
  write_bytes(folder / "a.webp", bytes);
  EXPECT_TRUE(read_image(folder / "a.webp"));
  EXPECT_FALSE(read_grey(folder / "a.webp"));
  for (std::size_t size = 0; size < bytes.size() - 2; ++size)
    EXPECT_FALSE(decode_image(std::span(bytes).first(size), "a.webp")) << size;
}

TEST(ImageIo, RejectsAHugeHeaderInASmallFileBeforeAllocating) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> bytes = png_that_claims(folder / "a.png", 65536, 65536);
  bytes.resize(100);
  write_bytes(folder / "huge.png", bytes);
  const auto read = read_image(folder / "huge.png");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kOverBudget);
  EXPECT_NE(read.error().message.find("65536 x 65536"), std::string::npos);
}

TEST(ImageIo, RejectsAHugeJpegHeaderBeforeTheDecoderSeesIt) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> bytes = bytes_of(kJpegFile);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t frame = text.find("\xFF\xC0");
  ASSERT_NE(frame, std::string_view::npos);
  for (std::size_t i = frame + 5; i < frame + 9; ++i)
    bytes[i] = 0xFF;
  bytes[frame + 1] = 0xC2;
  write_bytes(folder / "huge.jpg", bytes);
  EXPECT_EQ(read_image(folder / "huge.jpg").error().code, ErrorCode::kOverBudget);
}

TEST(ImageIo, EachLimitIsChecked) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", make_image(20, 10)));
  EXPECT_TRUE(read_image(folder / "a.png", {20, 10, 800, 10'000}));
  for (const ImageLimits limits :
       {ImageLimits{19, 10, 800, 10'000}, ImageLimits{20, 9, 800, 10'000},
        ImageLimits{20, 10, 799, 10'000}, ImageLimits{20, 10, 800, 50}}) {
    EXPECT_EQ(read_image(folder / "a.png", limits).error().code, ErrorCode::kOverBudget);
  }
}

TEST(ImageIo, RejectsAnImageWithoutPixels) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.png", png_that_claims(folder / "a.png", 0, 7));
  EXPECT_EQ(read_image(folder / "a.png").error().code, ErrorCode::kParse);
}

TEST(ImageIo, APngCutOffAtAnyByteIsAnErrorWithThePath) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", noise_image(5, 5)));
  const std::vector<std::uint8_t> bytes = bytes_of(folder / "a.png");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_bytes(folder / "cut.png", std::span(bytes).first(length));
    const auto read = read_image(folder / "cut.png");
    ASSERT_FALSE(read) << "cut to " << length << " of " << bytes.size();
    EXPECT_EQ(read.error().code, ErrorCode::kParse);
    EXPECT_EQ(read.error().message.find((folder / "cut.png").string()), 0U);
  }
}

TEST(ImageIo, AnyDamagedByteGivesAnImageOfTheSameSizeOrAnError) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", noise_image(5, 5)));
  // Every byte of the PNG; every fifth of the JPEG, whose decoder continues after damage.
  for (const std::vector<std::uint8_t>& bytes : {bytes_of(folder / "a.png"), bytes_of(kJpegFile)}) {
    for (std::size_t i = 0; i < bytes.size(); i += bytes[0] == 0xFF ? 5 : 1) {
      std::vector<std::uint8_t> damaged = bytes;
      damaged[i] ^= static_cast<std::uint8_t>(1U << (i % 8));
      write_bytes(folder / "damaged", damaged);
      const auto read = read_image(folder / "damaged", {64, 64, 1 << 14, 1 << 20});
      EXPECT_TRUE(!read || is_valid(*read)) << "byte " << i;
    }
  }
}

TEST(ImageIo, PixelsThatTheDecoderCannotUnpackAreAnError) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", noise_image(5, 5)));
  std::vector<std::uint8_t> bytes = bytes_of(folder / "a.png");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t chunk = text.find("IDAT") - 4;
  const std::size_t length = bytes[chunk + 2] * 256U + bytes[chunk + 3];
  bytes[chunk + 8] = 0xFF;
  repair_checksum(bytes, chunk, length);
  write_bytes(folder / "broken.png", bytes);
  EXPECT_EQ(read_image(folder / "broken.png").error().code, ErrorCode::kParse);
}

TEST(ImageIo, AHeaderThatClaimsTooManyPixelsIsAnError) {
  const TemporaryFolder folder;
  write_bytes(folder / "more.png", png_that_claims(folder / "a.png", 40, 30));
  EXPECT_EQ(read_image(folder / "more.png").error().code, ErrorCode::kParse);
}

TEST(ImageIo, AFileOfAnotherTypeIsAParseErrorAndAMissingOneIsAnIoError) {
  const TemporaryFolder folder;
  write_bytes(folder / "empty.png", {});
  EXPECT_EQ(read_image(folder / "empty.png").error().code, ErrorCode::kParse);
  write_bytes(folder / "zeros.png", std::vector<std::uint8_t>(5000));
  EXPECT_EQ(read_image(folder / "zeros.png").error().code, ErrorCode::kParse);
  EXPECT_EQ(read_image(folder / "none.png").error().code, ErrorCode::kIo);
  EXPECT_EQ(read_image(folder.path()).error().code, ErrorCode::kIo);
}

TEST(ImageIo, DoesNotWriteAnInvalidImage) {
  const TemporaryFolder folder;
  EXPECT_EQ(write_png(folder / "a.png", Image{}).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(write_png(folder / "a.png", Image{4, 4, std::vector<std::uint8_t>(63)}).error().code,
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(ImageIo, AnUnwritablePathIsAnIoErrorWithThePath) {
  const auto result = write_png("/proc/psygen/a.png", make_image(1, 1));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kIo);
  EXPECT_NE(result.error().message.find("/proc/psygen/a.png"), std::string::npos);
}

TEST(ImageIo, OnAFullDiskAPngIsWholeOrMissing) {
  expect_whole_files(
      [](const auto& folder) { return write_png(folder / "noise.png", noise_image(67, 31)); });
}

}  // namespace
}  // namespace psygen::image
