#include "engine/image/picture_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "engine/core/utf8.hpp"

namespace psygen::image {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::array<std::uint8_t, 3> kJpegSignature{0xFF, 0xD8, 0xFF};

template <std::size_t N>
bool starts_with(Bytes bytes, const std::array<std::uint8_t, N>& signature) {
  return bytes.size() >= N && std::equal(signature.begin(), signature.end(), bytes.begin());
}

std::uint32_t big_endian(Bytes bytes) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes)
    value = (value << 8) | byte;
  return value;
}

// Signature, then the chunk IHDR: length, type, width, height (PNG specification, 11.2.2).
std::optional<PictureHeader> png_header(Bytes bytes) {
  constexpr std::array<std::uint8_t, 4> kType{'I', 'H', 'D', 'R'};
  if (bytes.size() < 33 || !starts_with(bytes.subspan(12), kType)) return std::nullopt;
  return PictureHeader{PictureFormat::kPng, big_endian(bytes.subspan(16, 4)),
                       big_endian(bytes.subspan(20, 4))};
}

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    table[i] = i;
    for (int bit = 0; bit < 8; ++bit)
      table[i] = (table[i] >> 1) ^ ((table[i] & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return table;
}

// CRC-32 (PNG specification, annex D).
std::uint32_t crc(Bytes bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = crc_table();
  std::uint32_t value = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes)
    value = kTable[(value ^ byte) & 0xFFU] ^ (value >> 8);
  return ~value;
}

// A start-of-frame marker: C0 … CF without the tables C4 and CC and the extension C8.
bool is_start_of_frame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

// Segments (FF, marker, length, …) up to a start of frame (ITU T.81, B.2.2).
std::optional<PictureHeader> jpeg_header(Bytes bytes) {
  std::size_t at = 2;
  while (at + 9 <= bytes.size() && bytes[at] == 0xFF) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // a fill byte
      ++at;
      continue;
    }
    if (is_start_of_frame(marker)) {
      return PictureHeader{PictureFormat::kJpeg, big_endian(bytes.subspan(at + 7, 2)),
                           big_endian(bytes.subspan(at + 5, 2))};
    }
    const std::uint32_t length = big_endian(bytes.subspan(at + 2, 2));
    if (length < 2 || marker == 0xD9 || marker == 0xDA) return std::nullopt;
    at += 2 + std::size_t{length};
  }
  return std::nullopt;
}

constexpr std::array<std::uint8_t, 4> kExrSignature{0x76, 0x2F, 0x31, 0x01};

std::uint32_t little_endian(Bytes bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;)
    value = (value << 8) | bytes[i];
  return value;
}

// "II" or "MM", then 42 or 43 (BigTIFF) in that byte order.
bool is_tiff(Bytes bytes) {
  return std::ranges::any_of(
      std::array<std::array<std::uint8_t, 4>, 4>{
          {{'I', 'I', 42, 0}, {'I', 'I', 43, 0}, {'M', 'M', 0, 42}, {'M', 'M', 0, 43}}},
      [bytes](const auto& signature) { return starts_with(bytes, signature); });
}

constexpr std::array<std::uint8_t, 4> kRiffSignature{'R', 'I', 'F', 'F'};

// A RIFF file whose first chunk has the size: that of a lossy or lossless image, or of the canvas
// of an extended one, which may also be animated (RFC 9649, sections 2.5 to 2.7).
std::optional<PictureHeader> webp_header(Bytes bytes) {
  constexpr std::array<std::uint8_t, 7> kType{'W', 'E', 'B', 'P', 'V', 'P', '8'};
  constexpr std::uint8_t kAnimated = 2, kLossless = 0x2F;
  constexpr std::uint32_t kSide = 0x3FFF, kCanvas = 0xFFFFFF;  // 14 and 24 bits
  if (bytes.size() < 25 || !starts_with(bytes.subspan(8), kType)) return std::nullopt;
  const auto of = [](std::uint32_t width, std::uint32_t height) {
    return PictureHeader{PictureFormat::kWebp, width, height};
  };
  if (bytes[15] == 'L' && bytes[20] == kLossless) {
    const std::uint32_t sides = little_endian(bytes.subspan(21));
    return of((sides & kSide) + 1, (sides >> 14 & kSide) + 1);
  }
  if (bytes.size() < 30) return std::nullopt;
  const std::uint32_t last = little_endian(bytes.subspan(26));
  if (bytes[15] == ' ') return of(last & kSide, last >> 16 & kSide);
  if (bytes[15] == 'X' && (bytes[20] & kAnimated) == 0)
    return of((little_endian(bytes.subspan(24)) & kCanvas) + 1, (last >> 8) + 1);
  return std::nullopt;
}

// The header of an OpenEXR file (OpenEXR file layout): attributes of each part up to an empty name.
class ExrHeader {
 public:
  explicit ExrHeader(Bytes bytes) : bytes_(bytes) {}

  core::Result<PictureHeader> read() {
    constexpr std::uint32_t kVersion = 2, kDeep = 0x800, kParts = 0x1000;
    if (bytes_.size() < 8) return unreadable("is a truncated OpenEXR file");
    const std::uint32_t version = little_endian(bytes_.subspan(4));
    if ((version & 0xFF) != kVersion)
      return unreadable(fmt::format("is an OpenEXR file of version {}; version {} can be read",
                                    version & 0xFF, kVersion));
    if ((version & kDeep) != 0) return unreadable("is an OpenEXR file with deep pixels");
    bytes_ = bytes_.subspan(8);
    if (!read_part() || picture_.width == 0)
      return unreadable("is a truncated or damaged OpenEXR file");
    std::size_t parts = 1;
    while ((version & kParts) != 0 && !bytes_.empty() && bytes_.front() != 0 && read_part())
      ++parts;
    if (parts > 1)
      return unreadable(
          fmt::format("is an OpenEXR file of {} parts; save one part in a file by itself", parts));
    if (!subsampled_.empty())
      return unreadable(
          fmt::format("stores its channel {} for some pixels only (luminance and chroma); save it "
                      "as RGB or grey",
                      subsampled_));
    return picture_;
  }

 private:
  static tl::unexpected<core::Error> unreadable(std::string sentence) {
    return core::fail(core::ErrorCode::kParse, std::move(sentence));
  }
  std::optional<std::string_view> word() {
    const auto end = std::ranges::find(bytes_, std::uint8_t{0});
    if (end == bytes_.end()) return std::nullopt;
    const auto length = static_cast<std::size_t>(end - bytes_.begin());
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), length);
    bytes_ = bytes_.subspan(length + 1);
    return text;
  }
  // Attributes: name, type, size, value. Returns false if the bytes end before the empty name.
  bool read_part() {
    while (const auto name = word()) {
      if (name->empty()) return true;
      if (!word() || bytes_.size() < 4) return false;
      const std::uint32_t size = little_endian(bytes_);
      bytes_ = bytes_.subspan(4);
      if (size > bytes_.size()) return false;
      const Bytes value = bytes_.first(size);
      if (*name == "channels") note_channels(value);
      if (*name == "dataWindow" && !note_size(value)) return false;
      bytes_ = bytes_.subspan(size);
    }
    return false;
  }
  // Minimum x and y, maximum x and y.
  bool note_size(Bytes box) {
    if (box.size() != 16) return false;
    const auto at = [&box](std::size_t i) {
      return std::int64_t{static_cast<std::int32_t>(little_endian(box.subspan(4 * i)))};
    };
    const auto side = [&at](std::size_t axis) {
      const std::int64_t pixels = at(axis + 2) - at(axis) + 1;
      return static_cast<std::uint32_t>(std::clamp<std::int64_t>(pixels, 0, UINT32_MAX));
    };
    picture_ = {PictureFormat::kExr, side(0), side(1)};
    return true;
  }
  // Channels up to an empty name: name, type, linearity, distances of samples along x and y.
  void note_channels(Bytes list) {
    constexpr std::size_t kAfterName = 16, kDistances = 8;
    std::swap(bytes_, list);
    for (auto name = word(); name && !name->empty() && bytes_.size() >= kAfterName; name = word()) {
      const bool whole = little_endian(bytes_.subspan(kDistances)) == 1 &&
                         little_endian(bytes_.subspan(kDistances + 4)) == 1;
      if (!whole && subsampled_.empty()) subsampled_ = core::shown(*name, kMaxNameBytes);
      bytes_ = bytes_.subspan(kAfterName);
    }
    std::swap(bytes_, list);
  }

  static constexpr std::size_t kMaxNameBytes = 40;
  Bytes bytes_;
  PictureHeader picture_{PictureFormat::kExr, 0, 0};
  std::string subsampled_;  // the name of the first subsampled channel
};

}  // namespace

bool png_is_whole(Bytes bytes) {
  if (!starts_with(bytes, kPngSignature)) return false;
  constexpr std::array<std::uint8_t, 4> kEnd{'I', 'E', 'N', 'D'};
  bytes = bytes.subspan(kPngSignature.size());
  // A chunk: length, type, that many bytes, checksum of type and bytes.
  while (bytes.size() >= 12) {
    const std::size_t length = big_endian(bytes.first(4));
    if (length > bytes.size() - 12) return false;
    const Bytes content = bytes.subspan(4, 4 + length);
    if (crc(content) != big_endian(bytes.subspan(8 + length, 4))) return false;
    if (starts_with(content, kEnd)) return true;
    bytes = bytes.subspan(12 + length);
  }
  return false;
}

core::Result<PictureHeader> read_picture_header(std::span<const std::uint8_t> bytes) {
  if (starts_with(bytes, kExrSignature)) return ExrHeader(bytes).read();
  if (is_tiff(bytes)) return read_tiff_header(bytes);
  const auto header = starts_with(bytes, kPngSignature)    ? png_header(bytes)
                      : starts_with(bytes, kJpegSignature) ? jpeg_header(bytes)
                      : starts_with(bytes, kRiffSignature) ? webp_header(bytes)
                                                           : std::nullopt;
  if (header) return *header;
  return core::fail(core::ErrorCode::kParse, "is not a PNG, JPEG, OpenEXR or TIFF image");
}

}  // namespace psygen::image
