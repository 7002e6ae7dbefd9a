#include "engine/image/image_io.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <string>

#include "engine/core/cancellation.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/read_file.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/image/picture_codec.hpp"
#include "engine/image/picture_header.hpp"

namespace psygen::image {
namespace {

using core::ErrorCode;
using Bytes = std::vector<std::uint8_t>;

tl::unexpected<core::Error> fail_at(ErrorCode code, const std::filesystem::path& path,
                                    const std::string& sentence) {
  return core::fail(code, fmt::format("{}: {}", path.string(), sentence));
}

core::Result<PictureHeader> checked_header(const std::filesystem::path& path,
                                           std::span<const std::uint8_t> bytes,
                                           const ImageLimits& limits, bool has_numbers = false) {
  const auto header = read_picture_header(bytes);
  const bool in_colour =
      header && header->format != PictureFormat::kExr && header->format != PictureFormat::kTiff;
  if (!has_numbers && !in_colour)
    return fail_at(ErrorCode::kParse, path, "is not a PNG or JPEG image, nor a WebP one");
  if (!header) return fail_at(ErrorCode::kParse, path, header.error().message);
  if (has_numbers && header->format == PictureFormat::kWebp)
    return fail_at(ErrorCode::kParse, path, "is not a PNG, JPEG, OpenEXR or TIFF image");
  const std::uint64_t pixels = std::uint64_t{header->width} * header->height;
  if (pixels == 0) return fail_at(ErrorCode::kParse, path, "the image has no pixels");
  if (header->width > limits.max_width || header->height > limits.max_height ||
      pixels > limits.max_bytes / 4) {
    return fail_at(
        ErrorCode::kOverBudget, path,
        fmt::format("the image is {} x {}; at most {} x {} and {} bytes are allowed", header->width,
                    header->height, limits.max_width, limits.max_height, limits.max_bytes));
  }
  if (header->format == PictureFormat::kPng && !png_is_whole(bytes)) {
    return fail_at(ErrorCode::kParse, path, "the PNG is truncated or damaged");
  }
  return *header;
}

template <class T>
core::Result<T> with_path(const std::filesystem::path& path, core::Result<T> result) {
  if (result) return result;
  return fail_at(result.error().code, path, result.error().message);
}

// OpenImageIO and its decoders may throw; no exception leaves this file.
template <class Function>
auto without_exceptions(const std::filesystem::path& path, ErrorCode code, const Function& function)
    -> decltype(function()) {
  if (auto ok = core::check_cancelled(); !ok) return tl::unexpected(ok.error());
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return core::fail(ErrorCode::kOutOfMemory, core::out_of_memory(path.string()));
  } catch (const std::exception& exception) {
    return fail_at(code, path, std::string("cannot be processed: ") + exception.what());
  }
}

}  // namespace

core::Result<void> load_picture_libraries() {
  return picture_codec().map([](const PictureCodec*) {});
}

core::Result<Image> decode_image(std::span<const std::uint8_t> bytes,
                                 const std::filesystem::path& name, const ImageLimits& limits) {
  return without_exceptions(name, ErrorCode::kParse, [&]() -> core::Result<Image> {
    return checked_header(name, bytes, limits).and_then([&](const PictureHeader& header) {
      return with_path(name, picture_codec().and_then([&](const PictureCodec* codec) {
        return codec->decode(bytes, header);
      }));
    });
  });
}

core::Result<Image> read_image(const std::filesystem::path& path, const ImageLimits& limits) {
  return without_exceptions(path, ErrorCode::kParse, [&]() -> core::Result<Image> {
    return core::read_file(path, limits.max_file_bytes).and_then([&](const Bytes& bytes) {
      return decode_image(bytes, path, limits);
    });
  });
}

namespace {

// Replaces infinities, and the number of pixels without data, by NaN.
void mark_missing(std::optional<double> no_data, NumberImage& image) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const bool nan_is_no_data = no_data && std::isnan(*no_data);
  for (float& value : image.values) {
    if (!std::isfinite(value)) {
      const bool stated = (nan_is_no_data && std::isnan(value)) ||
                          (no_data && value == static_cast<float>(*no_data));
      image.not_finite += stated ? 0 : 1;
      value = kNone;
    } else if (no_data && value == static_cast<float>(*no_data)) {
      value = kNone;
    }
  }
}

}  // namespace

core::Result<NumberImage> read_numbers(const std::filesystem::path& path,
                                       const ImageLimits& limits) {
  return without_exceptions(path, ErrorCode::kParse, [&]() -> core::Result<NumberImage> {
    const auto bytes = core::read_file(path, limits.max_file_bytes);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto header = checked_header(path, *bytes, limits, true);
    if (!header) return tl::unexpected(header.error());
    return with_path(path, picture_codec().and_then([&](const PictureCodec* codec) {
             return codec->decode_numbers(*bytes, *header);
           }))
        .map([&](NumberImage image) {
          mark_missing(header->no_data, image);
          return image;
        });
  });
}

core::Result<GreyImage> read_grey(const std::filesystem::path& path, const ImageLimits& limits) {
  return read_numbers(path, limits).map(grey_of);
}

namespace {

constexpr std::uint32_t kLargest = 1U << 20;  // pixels per side

// `bytes_given` is the size of the pixel data.
template <class Picture, class Encode>
core::Result<Bytes> encode_any(const std::filesystem::path& path, const Picture& image,
                               bool is_sound, std::size_t bytes_given, const Encode& encode) {
  if (image.width == 0 || image.height == 0 || !is_sound || image.width > kLargest ||
      image.height > kLargest) {
    return fail_at(ErrorCode::kInvalidArgument, path,
                   fmt::format("an image of {} x {} pixels with {} bytes cannot be written",
                               image.width, image.height, bytes_given));
  }
  return without_exceptions(path, ErrorCode::kIo, [&]() -> core::Result<Bytes> {
    return with_path(path, picture_codec().and_then(encode));
  });
}

template <class Picture, class Encode>
core::Result<void> write_any(const std::filesystem::path& path, const Picture& image, bool is_sound,
                             std::size_t bytes_given, const Encode& encode) {
  return without_exceptions(path, ErrorCode::kIo, [&]() -> core::Result<void> {
    return encode_any(path, image, is_sound, bytes_given, encode).and_then([&](const Bytes& bytes) {
      return core::replace_file(path, bytes);
    });
  });
}

}  // namespace

core::Result<Bytes> encode_png(const std::filesystem::path& name, const Image& image) {
  return encode_any(name, image, is_valid(image), image.rgba.size(),
                    [&](const PictureCodec* codec) { return codec->encode_png(image); });
}

core::Result<void> write_png(const std::filesystem::path& path, const Image& image) {
  return write_any(path, image, is_valid(image), image.rgba.size(),
                   [&](const PictureCodec* codec) { return codec->encode_png(image); });
}

core::Result<void> write_png(const std::filesystem::path& path, const GreyImage& image) {
  const bool is_sound = image.grey.size() == std::size_t{image.width} * image.height;
  return write_any(path, image, is_sound, 2 * image.grey.size(),
                   [&](const PictureCodec* codec) { return codec->encode_grey_png(image); });
}

core::Result<void> write_exr(const std::filesystem::path& path, const FloatImage& image) {
  const bool is_sound = image.values.size() == std::size_t{image.width} * image.height;
  return write_any(path, image, is_sound, 4 * image.values.size(),
                   [&](const PictureCodec* codec) { return codec->encode_exr(image); });
}

}  // namespace psygen::image
