#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <map>
#include <string>
#include <string_view>

#include "engine/image/picture_header.hpp"

namespace psygen::image {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Tags (TIFF revision 6.0, section 8; GDAL's for pixels without data).
enum Tag : std::uint16_t {
  kWidth = 256,
  kHeight = 257,
  kBits = 258,
  kCompression = 259,
  kColours = 262,
  kStripOffsets = 273,
  kChannels = 277,
  kRowsPerStrip = 278,
  kStripBytes = 279,
  kPlanes = 284,
  kTileWidth = 322,
  kTileHeight = 323,
  kTileOffsets = 324,
  kTileBytes = 325,
  kNumbers = 339,
  kNoData = 42113,
};

// The compressions whose memory the size of a strip or tile bounds: none, LZW, Deflate (two codes),
// PackBits, LERC and Zstandard. LZMA and JPEG state their own sizes.
constexpr std::array<std::uint64_t, 7> kCompressions{1, 5, 8, 32'946, 32'773, 34'887, 50'000};

tl::unexpected<core::Error> unreadable(std::string sentence) {
  return core::fail(core::ErrorCode::kParse, std::move(sentence));
}

std::uint64_t ceil_of(std::uint64_t size, std::uint64_t part) {
  return size / part + (size % part != 0 ? 1 : 0);
}

class TiffHeader {
 public:
  explicit TiffHeader(Bytes bytes)
      : bytes_(bytes), little_(bytes[0] == 'I'), big_(number(2, 2) == 43) {}

  core::Result<PictureHeader> read() {
    if (!read_directory() || failed_) return damaged();
    const std::uint64_t width = value(kWidth, 0), height = value(kHeight, 0);
    if (width > UINT32_MAX || height > UINT32_MAX) return damaged();
    PictureHeader header{PictureFormat::kTiff, static_cast<std::uint32_t>(width),
                         static_cast<std::uint32_t>(height), no_data()};
    if (width == 0 || height == 0) return header;
    if (auto ok = check_pixels(); !ok) return tl::unexpected(ok.error());
    if (!check_parts(width, height) || failed_) return damaged();
    return header;
  }

 private:
  struct Entry {
    std::size_t size = 0;     // of one value, in bytes
    std::uint64_t count = 0;  // of values
    std::size_t at = 0;       // of the first one in the file
  };

  static tl::unexpected<core::Error> damaged() {
    return unreadable("is a truncated or damaged TIFF");
  }

  // The unsigned number of `size` bytes at a place of the file.
  std::uint64_t number(std::size_t at, std::size_t size) {
    if (at > bytes_.size() || bytes_.size() - at < size) {
      failed_ = true;
      return 0;
    }
    std::uint64_t n = 0;
    for (std::size_t i = 0; i < size; ++i)
      n = (n << 8) | bytes_[little_ ? at + size - 1 - i : at + i];
    return n;
  }

  // The size of a value of a type, in bytes; 0: an unknown type.
  static std::size_t size_of(std::uint64_t type) {
    constexpr std::array<std::uint8_t, 19> kSizes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4,
                                                  8, 4, 8, 4, 0, 0, 8, 8, 8};
    return type < kSizes.size() ? kSizes[type] : 0;
  }

  // Reads the first directory. Returns false if values lie outside the file, so that no decoder
  // allocates more for one than the file has.
  bool read_directory() {
    const std::size_t word = big_ ? 8 : 4, entry = big_ ? 20 : 12;
    if (big_ && number(4, 2) != 8) return false;
    std::uint64_t at = number(big_ ? 8 : 4, word);
    if (at > bytes_.size()) return false;
    const std::uint64_t count = number(at, big_ ? 8 : 2);
    at += big_ ? 8 : 2;
    if (failed_ || count > (bytes_.size() - at) / entry) return false;
    for (std::uint64_t i = 0; i < count; ++i, at += entry) {
      Entry made{size_of(number(at + 2, 2)), number(at + 4, word), at + 4 + word};
      if (made.size == 0) continue;
      if (made.count > bytes_.size() / made.size) return false;
      if (made.count * made.size > word) made.at = number(made.at, word);
      if (made.at > bytes_.size() || bytes_.size() - made.at < made.count * made.size) return false;
      entries_.try_emplace(static_cast<std::uint16_t>(number(at, 2)), made);
    }
    return true;
  }

  std::uint64_t count(Tag tag) const {
    const auto found = entries_.find(tag);
    return found == entries_.end() ? 0 : found->second.count;
  }
  // The i-th value of a tag.
  std::uint64_t value(Tag tag, std::uint64_t usual, std::uint64_t i = 0) {
    if (i >= count(tag)) return usual;
    const Entry& entry = entries_[tag];
    return number(entry.at + i * entry.size, entry.size);
  }
  // True if all values of a tag are equal, as for its channels.
  bool are_equal(Tag tag) {
    for (std::uint64_t i = 1; i < count(tag); ++i)
      if (value(tag, 0, i) != value(tag, 0)) return false;
    return true;
  }

  std::optional<double> no_data() {
    const auto found = entries_.find(kNoData);
    if (found == entries_.end()) return std::nullopt;
    std::string_view text(reinterpret_cast<const char*>(bytes_.data()) + found->second.at,
                          found->second.count * found->second.size);
    text.remove_prefix(std::min(text.find_first_not_of(" +"), text.size()));
    double no_data = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), no_data);
    return parsed.ec == std::errc() ? std::optional(no_data) : std::nullopt;
  }

  core::Result<void> check_pixels() {
    const std::uint64_t channels = value(kChannels, 1), bits = value(kBits, 1);
    const std::uint64_t numbers = value(kNumbers, 1), colours = value(kColours, 1);
    if (channels < 1 || channels > 4)
      return unreadable(fmt::format("has {} channels; 1 to 4 can be read", channels));
    const bool is_whole = std::has_single_bit(bits) && bits <= 32;
    const bool is_known = (numbers == 1 && is_whole) || (numbers == 2 && is_whole && bits >= 8) ||
                          (numbers == 3 && std::has_single_bit(bits) && bits >= 16 && bits <= 64);
    if (!is_known || !are_equal(kBits) || !are_equal(kNumbers)) {
      constexpr std::array<std::string_view, 7> kNames{"untyped", "unsigned", "signed", "real",
                                                       "untyped", "complex",  "complex"};
      return unreadable(fmt::format(
          "has {} pixels of {} bits; unsigned (1, 2, 4, 8, 16, 32 bits), signed (8, 16, 32) and "
          "real (16, 32, 64) ones can be read",
          numbers < kNames.size() ? kNames[numbers] : "unknown", bits));
    }
    if (colours > 3)
      return unreadable(fmt::format(
          "stores its colours in another way (photometric interpretation {}); grey, RGB and "
          "palettes can be read",
          colours));
    if (std::ranges::find(kCompressions, value(kCompression, 1)) == kCompressions.end())
      return unreadable(fmt::format(
          "has the compression {}; none, LZW, Deflate, PackBits, LERC and Zstandard can be read",
          value(kCompression, 1)));
    return {};
  }

  // True if all strips or tiles lie in the file and none is much larger than the image.
  bool check_parts(std::uint64_t width, std::uint64_t height) {
    static constexpr std::uint64_t kStep = 16, kUsual = 1024;  // the sides of tiles
    const bool tiled = entries_.contains(kTileWidth) || entries_.contains(kTileOffsets);
    std::uint64_t parts = 0;
    if (tiled) {
      const std::uint64_t columns = value(kTileWidth, 0), rows = value(kTileHeight, 0);
      const auto fits = [](std::uint64_t side, std::uint64_t whole) {
        return side > 0 && side % kStep == 0 &&
               side <= std::max(kUsual, ceil_of(whole, kStep) * kStep);
      };
      if (!fits(columns, width) || !fits(rows, height)) return false;
      parts = ceil_of(width, columns) * ceil_of(height, rows);
    } else {
      const std::uint64_t rows = value(kRowsPerStrip, height);
      if (rows == 0) return false;
      parts = ceil_of(height, rows);
    }
    if (value(kPlanes, 1) == 2) parts *= value(kChannels, 1);
    const Tag offsets = tiled ? kTileOffsets : kStripOffsets;
    const Tag sizes = tiled ? kTileBytes : kStripBytes;
    if (count(offsets) < parts || count(sizes) < parts) return false;
    for (std::uint64_t i = 0; i < parts; ++i) {
      const std::uint64_t at = value(offsets, 0, i), size = value(sizes, 0, i);
      if (at > bytes_.size() || size > bytes_.size() - at) return false;
    }
    return true;
  }

  Bytes bytes_;
  bool failed_ = false;
  bool little_, big_;
  std::map<std::uint16_t, Entry> entries_;
};

}  // namespace

core::Result<PictureHeader> read_tiff_header(std::span<const std::uint8_t> bytes) {
  return TiffHeader(bytes).read();
}

}  // namespace psygen::image
