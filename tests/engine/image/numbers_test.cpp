// Images as numbers: TIFF and OpenEXR files made here, alpha, orientation and pixels without data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "engine/image/image_io.hpp"
#include "engine/image/picture_header.hpp"
#include "tests/engine/image/test_files.hpp"
#include "tests/source_file.hpp"

namespace psygen::image {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

// A TIFF file: its fields by tag, each of one type, and one strip or tile after them.
struct Tiff {
  enum Type : std::uint16_t { kText = 2, kShort = 3, kLong = 4 };
  struct Field {
    Type type = kLong;
    std::vector<std::uint32_t> values;
  };
  std::map<std::uint16_t, Field> fields;
  Bytes pixels;
  bool is_big_endian = false;

  void set(std::uint16_t tag, std::vector<std::uint32_t> values, Type type = kLong) {
    fields[tag] = {type, std::move(values)};
  }
  void set_text(std::uint16_t tag, std::string_view text) {
    set(tag, {text.begin(), text.end()}, kText);
    fields[tag].values.push_back(0);
  }

  template <class Number>
  void put(Bytes& bytes, Number number) const {
    using Bits = std::conditional_t<
        sizeof(Number) == 8, std::uint64_t,
        std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                           std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
    const auto bits = std::uint64_t{std::bit_cast<Bits>(number)};
    for (std::size_t i = 0; i < sizeof number; ++i)
      bytes.push_back(
          static_cast<std::uint8_t>(bits >> (8 * (is_big_endian ? sizeof number - 1 - i : i))));
  }
  Bytes bytes() const {
    Bytes file = is_big_endian ? Bytes{'M', 'M', 0, 42} : Bytes{'I', 'I', 42, 0};
    put(file, std::uint32_t{8});
    put(file, static_cast<std::uint16_t>(fields.size()));
    const std::size_t end = file.size() + 12 * fields.size() + 4;
    Bytes beyond;
    for (const auto& [tag, field] : fields) {
      Bytes values;
      for (const std::uint32_t value : field.values) {
        if (field.type == kText) put(values, static_cast<std::uint8_t>(value));
        if (field.type == kShort) put(values, static_cast<std::uint16_t>(value));
        if (field.type == kLong) put(values, value);
      }
      put(file, tag);
      put(file, static_cast<std::uint16_t>(field.type));
      put(file, static_cast<std::uint32_t>(field.values.size()));
      if (values.size() > 4) {
        put(file, static_cast<std::uint32_t>(end + beyond.size()));
        beyond.insert(beyond.end(), values.begin(), values.end());
      } else {
        values.resize(4);
        file.insert(file.end(), values.begin(), values.end());
      }
    }
    put(file, std::uint32_t{0});
    file.insert(file.end(), beyond.begin(), beyond.end());
    return file;
  }
};

constexpr std::uint16_t kWidth = 256, kBits = 258, kCompression = 259, kColours = 262,
                        kStripOffsets = 273, kChannels = 277, kRowsPerStrip = 278,
                        kStripBytes = 279, kTileWidth = 322, kTileHeight = 323, kTileOffsets = 324,
                        kTileBytes = 325, kExtra = 338, kNumbers = 339, kNoData = 42113;
constexpr std::uint16_t kUnsigned = 1, kSigned = 2, kReal = 3;

// Two rows of numbers as a TIFF of one strip, without compression, at the end of the file.
template <class Number>
Tiff tiff_of(std::uint16_t numbers, const std::vector<Number>& values, bool big_endian = false) {
  Tiff tiff;
  tiff.is_big_endian = big_endian;
  tiff.set(kWidth, {static_cast<std::uint32_t>(values.size() / 2)});
  tiff.set(257, {2});
  tiff.set(kBits, {8 * sizeof(Number)}, Tiff::kShort);
  tiff.set(kCompression, {1}, Tiff::kShort);
  tiff.set(kColours, {1}, Tiff::kShort);
  tiff.set(kStripOffsets, {0});
  tiff.set(kChannels, {1}, Tiff::kShort);
  tiff.set(kRowsPerStrip, {2});
  tiff.set(kStripBytes, {static_cast<std::uint32_t>(values.size() * sizeof(Number))});
  tiff.set(284, {1}, Tiff::kShort);
  tiff.set(kNumbers, {numbers}, Tiff::kShort);
  for (const Number value : values)
    tiff.put(tiff.pixels, value);
  return tiff;
}

// The file, with its pixels at its end.
Bytes whole(Tiff tiff) {
  const auto at = static_cast<std::uint32_t>(tiff.bytes().size());
  for (const std::uint16_t tag : {kStripOffsets, kTileOffsets})
    if (tiff.fields.contains(tag)) tiff.fields[tag].values.assign(1, at);
  Bytes file = tiff.bytes();
  file.insert(file.end(), tiff.pixels.begin(), tiff.pixels.end());
  return file;
}

core::Result<NumberImage> numbers_of(const Bytes& bytes) {
  const TemporaryFolder folder;
  write_bytes(folder / "image", bytes);
  return read_numbers(folder / "image", {64, 64, 64 * 64 * 4, 1 << 20});
}

std::string error_of(const Bytes& bytes) {
  const auto read = numbers_of(bytes);
  return read ? "" : read.error().message;
}

template <class Number>
std::vector<float> read_back(std::uint16_t numbers, const std::vector<Number>& values,
                             bool big_endian = false) {
  const auto image = numbers_of(whole(tiff_of(numbers, values, big_endian)));
  EXPECT_TRUE(image) << image.error().message;
  return image ? image->values : std::vector<float>{};
}

TEST(Numbers, ATiffGivesThemAsItStoresThem) {
  const std::vector<float> metres{-3.5F, 1234.25F, 0, 8848.5F};
  EXPECT_EQ(read_back(kReal, metres), metres);
  EXPECT_EQ(read_back(kReal, metres, true), metres) << "big endian";
  EXPECT_EQ(read_back(kReal, std::vector<double>{-3.5, 1234.25, 0, 8848.5}), metres);
  EXPECT_EQ(read_back(kSigned, std::vector<std::int16_t>{-300, 12, 0, 8848}),
            (std::vector<float>{-300, 12, 0, 8848}));
  EXPECT_EQ(read_back(kSigned, std::vector<std::int32_t>{-300, 12, 0, 70'000}),
            (std::vector<float>{-300, 12, 0, 70'000}));
  EXPECT_EQ(read_back(kUnsigned, std::vector<std::uint32_t>{300, 12, 0, 70'000}),
            (std::vector<float>{300, 12, 0, 70'000}));
  EXPECT_EQ(read_back(kUnsigned, std::vector<std::uint16_t>{300, 12, 0, 65'535}, true),
            (std::vector<float>{300, 12, 0, 65'535}));
  EXPECT_EQ(read_back(kUnsigned, std::vector<std::uint8_t>{3, 12, 0, 255}),
            (std::vector<float>{3, 12, 0, 255}));
}

TEST(Numbers, WhiteIsTheLargestUnsignedNumberOrOne) {
  const auto white = [](const Tiff& tiff) { return numbers_of(whole(tiff))->white; };
  EXPECT_EQ(white(tiff_of(kUnsigned, std::vector<std::uint8_t>{1, 2})), 255);
  EXPECT_EQ(white(tiff_of(kUnsigned, std::vector<std::uint16_t>{1, 2})), 65'535);
  EXPECT_EQ(white(tiff_of(kSigned, std::vector<std::int16_t>{1, 2})), 1);
  EXPECT_EQ(white(tiff_of(kReal, std::vector<float>{1, 2})), 1);
}

TEST(Numbers, ATiffMayConsistOfTiles) {
  Tiff tiff = tiff_of(kReal, std::vector<float>{1, 2, 3, 4});
  tiff.fields.erase(kStripOffsets);
  tiff.fields.erase(kStripBytes);
  tiff.fields.erase(kRowsPerStrip);
  tiff.set(kTileWidth, {16});
  tiff.set(kTileHeight, {16});
  tiff.set(kTileOffsets, {0});
  tiff.set(kTileBytes, {16 * 16 * 4});
  tiff.pixels.clear();
  for (int i = 0; i < 16 * 16; ++i)
    tiff.put(tiff.pixels, static_cast<float>(i));
  const auto image = numbers_of(whole(tiff));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->values, (std::vector<float>{0, 1, 16, 17}));
}

TEST(Numbers, PixelsWithoutDataAreNanAndOthersThatAreNotFiniteAreCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  Tiff tiff = tiff_of(kReal, std::vector<float>{-9999, nan, infinite, 7});
  auto image = numbers_of(whole(tiff));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->not_finite, 2U);
  EXPECT_EQ(image->values[0], -9999);
  EXPECT_TRUE(std::isnan(image->values[1]) && std::isnan(image->values[2]));
  tiff.set_text(kNoData, "-9999 ");
  image = numbers_of(whole(tiff));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->not_finite, 2U);
  EXPECT_TRUE(std::isnan(image->values[0]));
  EXPECT_EQ(image->values[3], 7);
  EXPECT_EQ(range_of(image->values).least, 7);
  tiff.set_text(kNoData, "nan");
  EXPECT_EQ(numbers_of(whole(tiff))->not_finite, 1U) << "the file states NaN";
}

TEST(Numbers, ATiffThatCannotBeReadSaysWhy) {
  const Tiff sound = tiff_of(kReal, std::vector<float>{1, 2, 3, 4});
  const auto with = [&](std::uint16_t tag, std::vector<std::uint32_t> values,
                        Tiff::Type type = Tiff::kShort) {
    Tiff tiff = sound;
    tiff.set(tag, std::move(values), type);
    return error_of(whole(tiff));
  };
  EXPECT_EQ(with(kColours, {1}), "");
  EXPECT_THAT(with(kChannels, {7}), HasSubstr("has 7 channels; 1 to 4 can be read"));
  EXPECT_THAT(with(kBits, {24}), HasSubstr("has real pixels of 24 bits"));
  EXPECT_THAT(with(kNumbers, {6}), HasSubstr("has complex pixels of 32 bits"));
  EXPECT_THAT(with(kCompression, {34'925}), HasSubstr("has the compression 34925"));
  EXPECT_THAT(with(kColours, {6}), HasSubstr("photometric interpretation 6"));
  EXPECT_THAT(with(kWidth, {4000}), HasSubstr("4000 x 2; at most 64 x 64"));
  EXPECT_THAT(with(kWidth, {0}), HasSubstr("no pixels"));
  for (const auto& wrong :
       {with(kStripBytes, {0xFFFFFFF0U}, Tiff::kLong), with(kRowsPerStrip, {0}),
        with(kRowsPerStrip, {1}), with(kTileWidth, {1}), with(kStripBytes, {}, Tiff::kLong)})
    EXPECT_THAT(wrong, HasSubstr("is a truncated or damaged TIFF"));
}

TEST(Numbers, TilesMuchLargerThanTheImageAreRefusedBeforeTheyAreAllocated) {
  Tiff tiff = tiff_of(kReal, std::vector<float>{1, 2, 3, 4});
  tiff.fields.erase(kStripOffsets);
  tiff.set(kTileHeight, {1 << 20});
  tiff.set(kTileWidth, {1 << 20});
  tiff.set(kTileOffsets, {0});
  tiff.set(kTileBytes, {16});
  EXPECT_THAT(error_of(whole(tiff)), HasSubstr("is a truncated or damaged TIFF"));
}

TEST(Numbers, ADamagedTiffIsAnErrorOrAnImageWithinTheLimits) {
  Tiff tiff = tiff_of(kReal, std::vector<float>{1, 2, 3, 4});
  tiff.set_text(kNoData, "-9999");
  expect_errors_or_images(whole(tiff), read_numbers, &NumberImage::values);
}

// The start of an OpenEXR file: its flags, and a header of 1 × 1 pixels for each list of channels,
// all of 32-bit floats. `distance`: of the samples of each list's last channel.
Bytes exr_header(std::uint32_t flags, const std::vector<std::vector<std::string>>& parts,
                 std::uint32_t distance = 1) {
  const Tiff little;
  Bytes bytes;
  const auto text = [&bytes](std::string_view name) {
    bytes.insert(bytes.end(), name.begin(), name.end());
    bytes.push_back(0);
  };
  const auto attribute = [&](std::string_view name, std::string_view type, const Bytes& value) {
    text(name);
    text(type);
    little.put(bytes, static_cast<std::uint32_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
  };
  little.put(bytes, std::uint32_t{20'000'630});
  little.put(bytes, 2U | flags);
  for (const std::vector<std::string>& channels : parts) {
    Bytes list;
    for (const std::string& channel : channels) {
      list.insert(list.end(), channel.begin(), channel.end());
      list.push_back(0);
      const std::uint32_t apart = channel == channels.back() ? distance : 1;
      for (const std::uint32_t v : {2U, 0U, apart, apart})
        little.put(list, v);
    }
    list.push_back(0);
    attribute("channels", "chlist", list);
    attribute("compression", "compression", {0});
    attribute("dataWindow", "box2i", Bytes(16));
    attribute("displayWindow", "box2i", Bytes(16));
    attribute("lineOrder", "lineOrder", {0});
    attribute("pixelAspectRatio", "float", {0, 0, 0x80, 0x3F});
    attribute("screenWindowCenter", "v2f", Bytes(8));
    attribute("screenWindowWidth", "float", {0, 0, 0x80, 0x3F});
    bytes.push_back(0);
  }
  if ((flags & 0x1000U) != 0) bytes.push_back(0);
  return bytes;
}

TEST(Numbers, AnOpenExrFileThatCannotBeReadSaysWhy) {
  EXPECT_THAT(error_of(exr_header(0x1000, {{"Y"}, {"Y"}, {"Z"}})),
              HasSubstr("is an OpenEXR file of 3 parts"));
  EXPECT_THAT(error_of(exr_header(0x800, {{"Y"}})), HasSubstr("deep pixels"));
  EXPECT_THAT(error_of(exr_header(0, {{"RY", "Y", "BY"}}, 2)),
              HasSubstr("stores its channel BY for some pixels only (luminance and chroma)"));
  Bytes seven = exr_header(0, {{"A", "B", "C", "D", "E", "F", "G"}});
  seven.resize(seven.size() + 8 + 8 + 7 * 4);
  EXPECT_THAT(error_of(seven), HasSubstr("has 7 channels ("));
  EXPECT_TRUE(read_picture_header(exr_header(0x1000, {{"Y"}}))) << "one part in the form of many";
}

TEST(Numbers, MasksAreGreyTimesAlpha) {
  const TemporaryFolder folder;
  Image image = make_image(3, 1, 255, 255, 255, 255);
  image.pixel(1, 0)[3] = 51;
  image.pixel(2, 0)[3] = 0;
  ASSERT_TRUE(write_png(folder / "mask.png", image));
  EXPECT_EQ(read_grey(folder / "mask.png")->grey, (std::vector<std::uint16_t>{65'535, 13'107, 0}));
  EXPECT_FALSE(read_numbers(folder / "mask.png")->is_coloured);
  Tiff tiff = tiff_of(kUnsigned, std::vector<std::uint8_t>{200, 255, 200, 0});
  tiff.set(kWidth, {1});
  tiff.set(kChannels, {2}, Tiff::kShort);
  tiff.set(kBits, {8, 8}, Tiff::kShort);
  tiff.set(kNumbers, {1, 1}, Tiff::kShort);
  tiff.set(kExtra, {2}, Tiff::kShort);  // alpha, not multiplied
  const auto grey = numbers_of(whole(tiff));
  ASSERT_TRUE(grey) << grey.error().message;
  EXPECT_EQ(grey_of(*grey).grey, (std::vector<std::uint16_t>{200 * 257, 0}));
}

TEST(Numbers, AJpegIsTurnedAsItsExifDataSays) {
  const Bytes jpeg = bytes_of(source_file("tests/engine/image/data/two_halves.jpg"));
  const TemporaryFolder folder;
  const auto with = [&](std::uint8_t orientation) {
    Bytes exif{0xFF, 0xE1, 0, 34, 'E', 'x', 'i', 'f', 0, 0, 'M', 'M', 0, 42, 0, 0, 0, 8,
               0,    1,    1, 18, 0,   3,   0,   0,   0, 1, 0,   0,   0, 0,  0, 0, 0, 0};
    exif[29] = orientation;
    Bytes bytes = jpeg;
    bytes.insert(bytes.begin() + 2, exif.begin(), exif.end());
    write_bytes(folder / "turned.jpg", bytes);
    return *read_image(folder / "turned.jpg");
  };
  const Image upright = with(1);
  ASSERT_NE(upright.width, upright.height);
  const auto last_x = upright.width - 1, last_y = upright.height - 1;
  const auto equal = [](std::span<const std::uint8_t, 4> a, std::span<const std::uint8_t, 4> b) {
    return std::ranges::equal(a, b);
  };
  const Image right = with(6), half = with(3), left = with(8), mirrored = with(2);
  ASSERT_EQ(right.width, upright.height);
  ASSERT_EQ(half.width, upright.width);
  for (std::uint32_t y = 0; y <= last_y; ++y) {
    for (std::uint32_t x = 0; x <= last_x; ++x) {
      const auto pixel = upright.pixel(x, y);
      ASSERT_TRUE(equal(right.pixel(last_y - y, x), pixel)) << x << ' ' << y;
      ASSERT_TRUE(equal(half.pixel(last_x - x, last_y - y), pixel)) << x << ' ' << y;
      ASSERT_TRUE(equal(left.pixel(y, last_x - x), pixel)) << x << ' ' << y;
      ASSERT_TRUE(equal(mirrored.pixel(last_x - x, y), pixel)) << x << ' ' << y;
    }
  }
  EXPECT_EQ(read_numbers(folder / "turned.jpg")->width, upright.width);
}

}  // namespace
}  // namespace psygen::image
