#include "engine/image/picture_header.hpp"

#include <algorithm>
#include <array>
#include <string_view>

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

// Signature, version, then attributes up to an empty name: name, type, size, value. The size of the
// image is that of the box "dataWindow": minimum x and y, maximum x and y (OpenEXR file layout).
std::optional<PictureHeader> exr_header(Bytes bytes) {
  constexpr std::uint32_t kPlain = 0xFF | 0x200 | 0x400;  // version, tiles, long names
  if (bytes.size() < 8 || (little_endian(bytes.subspan(4)) & ~kPlain) != 0) return std::nullopt;
  bytes = bytes.subspan(8);
  const auto word = [&bytes]() -> std::optional<std::string_view> {
    const auto end = std::ranges::find(bytes, std::uint8_t{0});
    if (end == bytes.end()) return std::nullopt;
    const auto length = static_cast<std::size_t>(end - bytes.begin());
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), length);
    bytes = bytes.subspan(length + 1);
    return text;
  };
  while (const auto name = word()) {
    if (name->empty() || !word() || bytes.size() < 4) return std::nullopt;
    const std::uint32_t size = little_endian(bytes);
    bytes = bytes.subspan(4);
    if (size > bytes.size()) return std::nullopt;
    if (*name == "dataWindow") {
      if (size != 16) return std::nullopt;
      const auto side = [&bytes](std::size_t axis) {
        const auto at = [&bytes](std::size_t i) {
          return std::int64_t{static_cast<std::int32_t>(little_endian(bytes.subspan(4 * i)))};
        };
        const std::int64_t pixels = at(axis + 2) - at(axis) + 1;
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(pixels, 0, UINT32_MAX));
      };
      return PictureHeader{PictureFormat::kExr, side(0), side(1)};
    }
    bytes = bytes.subspan(size);
  }
  return std::nullopt;
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

std::optional<PictureHeader> read_picture_header(std::span<const std::uint8_t> bytes) {
  if (starts_with(bytes, kPngSignature)) return png_header(bytes);
  if (starts_with(bytes, kJpegSignature)) return jpeg_header(bytes);
  if (starts_with(bytes, kExrSignature)) return exr_header(bytes);
  if (starts_with(bytes, kRiffSignature)) return webp_header(bytes);
  return std::nullopt;
}

}  // namespace psygen::image
