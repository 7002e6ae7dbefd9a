// The library that picture_codec() loads. It alone links OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>
#include <utility>

#include "engine/image/picture_codec.hpp"

namespace psygen::image {
namespace {

using core::ErrorCode;
using Bytes = std::vector<std::uint8_t>;

// Expands 1 to 4 channels to red, green, blue, alpha.
void expand_channels(const Bytes& source, std::size_t channels, Bytes& rgba) {
  const bool grey = channels <= 2;
  const bool has_alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
    const std::uint8_t* from = source.data() + i * channels;
    rgba[i * 4] = from[0];
    rgba[i * 4 + 1] = grey ? from[0] : from[1];
    rgba[i * 4 + 2] = grey ? from[0] : from[2];
    rgba[i * 4 + 3] = has_alpha ? from[channels - 1] : std::uint8_t{255};
  }
}

// The channels of all pixels, as many as the file has.
template <class Channel>
struct Decoded {
  std::size_t channels = 0;
  std::vector<Channel> values;
  bool is_premultiplied = false;  // OpenImageIO's WebP ignores a request for plain colours
};

// Divides colours by their opacity.
void unmultiply(Bytes& rgba) {
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    const unsigned alpha = rgba[i / 4 * 4 + 3];
    if (i % 4 == 3 || alpha == 0) continue;
    rgba[i] = static_cast<std::uint8_t>(std::min((rgba[i] * 255U + alpha / 2) / alpha, 255U));
  }
}

template <class Channel>
core::Result<Decoded<Channel>> decode_channels(std::span<const std::uint8_t> bytes,
                                               const PictureHeader& header,
                                               OIIO::TypeDesc::BASETYPE type) {
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const char* format = header.format == PictureFormat::kPng    ? "png"
                       : header.format == PictureFormat::kExr  ? "openexr"
                       : header.format == PictureFormat::kWebp ? "webp"
                                                               : "jpeg";
  const auto input = OIIO::ImageInput::create(format);
  if (!input && header.format == PictureFormat::kWebp)
    return core::fail(ErrorCode::kParse, "is WebP, which this OpenImageIO cannot read");
  if (!input) return core::fail(ErrorCode::kInternal, OIIO::geterror());
  input->threads(1);
  OIIO::ImageSpec spec;
  OIIO::ImageSpec configuration;
  configuration.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->set_ioproxy(&reader) || !input->open("picture", spec, configuration)) {
    return core::fail(ErrorCode::kParse, "cannot be decoded: " + input->geterror());
  }
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  if (std::cmp_not_equal(spec.width, header.width) ||
      std::cmp_not_equal(spec.height, header.height) || channels < 1 || channels > 4) {
    return core::fail(ErrorCode::kParse, "its headers contradict each other");
  }
  const std::size_t pixels = std::size_t{header.width} * header.height;
  Decoded<Channel> decoded{channels, std::vector<Channel>(pixels * channels)};
  decoded.is_premultiplied = header.format == PictureFormat::kWebp &&
                             spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
  if (!input->read_image(0, 0, 0, spec.nchannels, type, decoded.values.data())) {
    return core::fail(ErrorCode::kParse, "cannot be decoded: " + input->geterror());
  }
  return decoded;
}

core::Result<Image> decode(std::span<const std::uint8_t> bytes, const PictureHeader& header) {
  const auto decoded = decode_channels<std::uint8_t>(bytes, header, OIIO::TypeDesc::UINT8);
  if (!decoded) return tl::unexpected(decoded.error());
  Image image{header.width, header.height, Bytes(std::size_t{header.width} * header.height * 4)};
  expand_channels(decoded->values, decoded->channels, image.rgba);
  if (decoded->is_premultiplied) unmultiply(image.rgba);
  return image;
}

// The mean of the colours of each pixel.
template <class Channel, class Spread>
GreyImage means_of(const Decoded<Channel>& decoded, const PictureHeader& header,
                   const Spread& spread) {
  const std::size_t colours = decoded.channels >= 3 ? 3 : 1;
  GreyImage image{header.width, header.height, {}};
  image.grey.reserve(decoded.values.size() / decoded.channels);
  for (std::size_t i = 0; i < decoded.values.size(); i += decoded.channels) {
    std::uint32_t sum = 0;
    for (std::size_t c = 0; c < colours; ++c)
      sum += spread(decoded.values[i + c]);
    image.grey.push_back(
        static_cast<std::uint16_t>((sum + colours / 2) / static_cast<std::uint32_t>(colours)));
  }
  return image;
}

core::Result<GreyImage> decode_grey(std::span<const std::uint8_t> bytes,
                                    const PictureHeader& header) {
  if (header.format == PictureFormat::kExr) {
    const auto decoded = decode_channels<float>(bytes, header, OIIO::TypeDesc::FLOAT);
    if (!decoded) return tl::unexpected(decoded.error());
    return means_of(*decoded, header, [](float v) {
      if (!(v > 0)) return std::uint32_t{0};
      return static_cast<std::uint32_t>(std::min(v, 1.0F) * 65535.0F + 0.5F);
    });
  }
  const auto decoded = decode_channels<std::uint16_t>(bytes, header, OIIO::TypeDesc::UINT16);
  if (!decoded) return tl::unexpected(decoded.error());
  return means_of(*decoded, header, [](std::uint16_t v) { return std::uint32_t{v}; });
}

core::Result<Bytes> encode(const OIIO::ImageSpec& spec, const void* pixels,
                           const char* format = "png") {
  Bytes bytes;
  OIIO::Filesystem::IOVecOutput writer(bytes);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) return core::fail(ErrorCode::kInternal, OIIO::geterror());
  output->threads(1);
  if (!output->set_ioproxy(&writer) || !output->open("picture", spec) ||
      !output->write_image(spec.format, pixels) || !output->close()) {
    return core::fail(ErrorCode::kIo, "cannot be encoded: " + output->geterror());
  }
  return bytes;
}

core::Result<Bytes> encode_png(const Image& image) {
  OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 4,
                       OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return encode(spec, image.rgba.data());
}

core::Result<Bytes> encode_grey_png(const GreyImage& image) {
  const OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 1,
                             OIIO::TypeDesc::UINT16);
  return encode(spec, image.grey.data());
}

core::Result<Bytes> encode_exr(const FloatImage& image) {
  OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 1,
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Y"};
  spec.attribute("compression", "zip");
  return encode(spec, image.values.data(), "openexr");
}

}  // namespace
}  // namespace psygen::image

extern "C" __attribute__((visibility("default")))
const psygen::image::PictureCodec psygen_picture_codec = {
    psygen::image::decode, psygen::image::decode_grey, psygen::image::encode_png,
    psygen::image::encode_grey_png, psygen::image::encode_exr};
