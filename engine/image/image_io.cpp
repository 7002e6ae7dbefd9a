#include "engine/image/image_io.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "engine/core/out_of_memory.hpp"
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

core::Result<Bytes> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return fail_at(ErrorCode::kIo, path, error ? error.message() : "is not a regular file");
  }
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) return fail_at(ErrorCode::kIo, path, error.message());
  if (size > max_bytes) {
    return fail_at(ErrorCode::kOverBudget, path,
                   fmt::format("the file has {} bytes; at most {} are allowed", size, max_bytes));
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return fail_at(ErrorCode::kIo, path, "cannot be opened for reading");
  Bytes bytes(size);
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    return fail_at(ErrorCode::kIo, path, "cannot be read to its end");
  }
  return bytes;
}

core::Result<PictureHeader> checked_header(const std::filesystem::path& path, const Bytes& bytes,
                                           const ImageLimits& limits) {
  const auto header = read_picture_header(bytes);
  if (!header) return fail_at(ErrorCode::kParse, path, "is not a PNG or JPEG picture");
  const std::uint64_t pixels = std::uint64_t{header->width} * header->height;
  if (pixels == 0) return fail_at(ErrorCode::kParse, path, "the picture has no pixels");
  if (header->width > limits.max_width || header->height > limits.max_height ||
      pixels > limits.max_bytes / 4) {
    return fail_at(ErrorCode::kOverBudget, path,
                   fmt::format("the picture is {} x {}; at most {} x {} and {} bytes are allowed",
                               header->width, header->height, limits.max_width, limits.max_height,
                               limits.max_bytes));
  }
  if (header->format == PictureFormat::kPng && !png_is_whole(bytes)) {
    return fail_at(ErrorCode::kParse, path, "the PNG is cut off or damaged");
  }
  return *header;
}

template <class T>
core::Result<T> with_path(const std::filesystem::path& path, core::Result<T> result) {
  if (result) return result;
  return fail_at(result.error().code, path, result.error().message);
}

// OpenImageIO and the decoders below it may throw; no exception leaves this file.
template <class Function>
auto without_exceptions(const std::filesystem::path& path, ErrorCode code, const Function& function)
    -> decltype(function()) {
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

core::Result<Image> read_image(const std::filesystem::path& path, const ImageLimits& limits) {
  return without_exceptions(path, ErrorCode::kParse, [&]() -> core::Result<Image> {
    return read_file(path, limits.max_file_bytes).and_then([&](const Bytes& bytes) {
      return checked_header(path, bytes, limits).and_then([&](const PictureHeader& header) {
        return with_path(path, picture_codec().and_then([&](const PictureCodec* codec) {
          return codec->decode(bytes, header);
        }));
      });
    });
  });
}

core::Result<void> write_png(const std::filesystem::path& path, const Image& image) {
  constexpr std::uint32_t kLargest = 1U << 20;  // pixels per side
  if (image.width == 0 || image.height == 0 || !is_valid(image) || image.width > kLargest ||
      image.height > kLargest) {
    return fail_at(ErrorCode::kInvalidArgument, path,
                   fmt::format("a picture of {} x {} pixels with {} bytes cannot be written",
                               image.width, image.height, image.rgba.size()));
  }
  return without_exceptions(path, ErrorCode::kIo, [&]() -> core::Result<void> {
    return with_path(path, picture_codec().and_then(
                               [&](const PictureCodec* codec) { return codec->encode_png(image); }))
        .and_then([&](const Bytes& bytes) { return core::replace_file(path, bytes); });
  });
}

}  // namespace psygen::image
