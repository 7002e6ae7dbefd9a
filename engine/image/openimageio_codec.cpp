// The library that picture_codec() loads. It alone links OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "engine/core/utf8.hpp"
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

// Divides colours by their opacity.
void unmultiply(Bytes& rgba) {
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    const unsigned alpha = rgba[i / 4 * 4 + 3];
    if (i % 4 == 3 || alpha == 0) continue;
    rgba[i] = static_cast<std::uint8_t>(std::min((rgba[i] * 255U + alpha / 2) / alpha, 255U));
  }
}

using InputPtr = std::unique_ptr<OIIO::ImageInput>;

const char* name_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::kPng:
      return "png";
    case PictureFormat::kJpeg:
      return "jpeg";
    case PictureFormat::kExr:
      return "openexr";
    case PictureFormat::kTiff:
      return "tiff";
    case PictureFormat::kWebp:
      return "webp";
  }
  return "";
}

// "7 channels (A, B, …)", for messages.
std::string channel_names(const OIIO::ImageSpec& spec) {
  constexpr std::size_t kMost = 8, kMaxBytes = 20;
  std::string text = std::to_string(spec.nchannels) + " channels (";
  for (std::size_t i = 0; i < std::min(spec.channelnames.size(), kMost); ++i)
    text += (i > 0 ? ", " : "") + core::shown(spec.channelnames[i], kMaxBytes);
  return text + (spec.channelnames.size() > kMost ? ", …)" : ")");
}

// Opens an image whose size is that of its header.
core::Result<InputPtr> open(OIIO::Filesystem::IOMemReader& reader, const PictureHeader& header) {
  InputPtr input = OIIO::ImageInput::create(name_of(header.format));
  if (!input && header.format == PictureFormat::kWebp)
    return core::fail(ErrorCode::kParse, "is WebP, which this OpenImageIO cannot read");
  if (!input) return core::fail(ErrorCode::kInternal, OIIO::geterror());
  input->threads(1);
  OIIO::ImageSpec spec;
  OIIO::ImageSpec configuration;
  configuration.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->set_ioproxy(&reader) || !input->open("picture", spec, configuration))
    return core::fail(ErrorCode::kParse, "cannot be decoded: " + input->geterror());
  if (std::cmp_not_equal(spec.width, header.width) ||
      std::cmp_not_equal(spec.height, header.height))
    return core::fail(ErrorCode::kParse, "its headers contradict each other");
  if (spec.nchannels < 1 || spec.nchannels > 4) {
    return core::fail(ErrorCode::kParse,
                      "has " + channel_names(spec) + "; 1 to 4 channels can be read");
  }
  return input;
}

// The channels of all pixels, as many as the file has.
template <class Channel>
core::Result<std::vector<Channel>> channels_of(OIIO::ImageInput& input,
                                               OIIO::TypeDesc::BASETYPE type) {
  const OIIO::ImageSpec& spec = input.spec();
  const auto count = static_cast<std::size_t>(spec.nchannels);
  std::vector<Channel> values(static_cast<std::size_t>(spec.width) *
                              static_cast<std::size_t>(spec.height) * count);
  if (input.read_image(0, 0, 0, spec.nchannels, type, values.data())) return values;
  return core::fail(ErrorCode::kParse, "cannot be decoded: " + input.geterror());
}

// Turns an image from its orientation in the file (EXIF, TIFF: 1 … 8) to the upright one. Each
// pixel has `step` values.
template <class Picture, class Value>
void turn_upright(int orientation, Picture& picture, std::vector<Value>& values,
                  std::size_t step = 1) {
  if (orientation < 2 || orientation > 8 || values.empty()) return;
  const bool transposed = orientation >= 5;
  const std::size_t width = picture.width, height = picture.height;
  const std::size_t columns = transposed ? height : width, rows = transposed ? width : height;
  const bool from_right =
      orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_bottom =
      orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  std::vector<Value> turned;
  turned.reserve(values.size());
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t along = transposed ? y : x, down = transposed ? x : y;
      const std::size_t column = from_right ? width - 1 - along : along;
      const std::size_t row = from_bottom ? height - 1 - down : down;
      const auto first =
          values.begin() + static_cast<std::ptrdiff_t>((row * width + column) * step);
      turned.insert(turned.end(), first, first + static_cast<std::ptrdiff_t>(step));
    }
  }
  values = std::move(turned);
}

template <class Picture>
void swap_sides(int orientation, Picture& picture) {
  if (orientation >= 5 && orientation <= 8) std::swap(picture.width, picture.height);
}

int orientation_of(const OIIO::ImageInput& input) {
  return input.spec().get_int_attribute("Orientation", 1);
}

core::Result<Image> decode(std::span<const std::uint8_t> bytes, const PictureHeader& header) {
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto input = open(reader, header);
  if (!input) return tl::unexpected(input.error());
  const auto channels = channels_of<std::uint8_t>(**input, OIIO::TypeDesc::UINT8);
  if (!channels) return tl::unexpected(channels.error());
  Image image{header.width, header.height, Bytes(std::size_t{header.width} * header.height * 4)};
  expand_channels(*channels, static_cast<std::size_t>((*input)->spec().nchannels), image.rgba);
  // OpenImageIO's WebP ignores the request for plain colours.
  if (header.format == PictureFormat::kWebp &&
      (*input)->spec().get_int_attribute("oiio:UnassociatedAlpha") == 0)
    unmultiply(image.rgba);
  const int orientation = orientation_of(**input);
  turn_upright(orientation, image, image.rgba, 4);
  swap_sides(orientation, image);
  return image;
}

// The channels of an image that make its numbers: grey, or red, green and blue; and its alpha.
struct Roles {
  std::vector<std::size_t> colours;
  int alpha = -1;
};

core::Result<Roles> roles_of(const OIIO::ImageSpec& spec) {
  Roles roles{{}, spec.alpha_channel};
  for (int i = 0; i < spec.nchannels && roles.colours.size() < 3; ++i)
    if (i != roles.alpha) roles.colours.push_back(static_cast<std::size_t>(i));
  if (roles.colours.empty()) {  // alpha alone
    roles.colours.push_back(0);
    roles.alpha = -1;
  }
  if (roles.colours.size() != 2) return roles;
  return core::fail(ErrorCode::kParse,
                    "has " + channel_names(spec) + "; grey, grey and alpha, or RGB can be read");
}

// The means of the colours, and alpha in units of `opaque`.
template <class Channel, class Mean>
core::Result<void> take_channels(OIIO::ImageInput& input, OIIO::TypeDesc::BASETYPE type,
                                 const Mean& mean, double opaque, NumberImage& image) {
  const auto roles = roles_of(input.spec());
  if (!roles) return tl::unexpected(roles.error());
  const auto channels = channels_of<Channel>(input, type);
  if (!channels) return tl::unexpected(channels.error());
  const auto step = static_cast<std::size_t>(input.spec().nchannels);
  image.values.reserve(channels->size() / step);
  for (std::size_t i = 0; i < channels->size(); i += step) {
    const Channel first = (*channels)[i + roles->colours.front()];
    double sum = 0;
    for (const std::size_t c : roles->colours) {
      const Channel value = (*channels)[i + c];
      sum += static_cast<double>(value);
      const bool same = value == first || (value != value && first != first);
      image.is_coloured = image.is_coloured || !same;
    }
    image.values.push_back(
        static_cast<float>(mean(sum, static_cast<double>(roles->colours.size()))));
    if (roles->alpha < 0) continue;
    const auto alpha = static_cast<double>((*channels)[i + static_cast<std::size_t>(roles->alpha)]);
    image.alpha.push_back(static_cast<float>(std::clamp(alpha / opaque, 0.0, 1.0)));
  }
  return {};
}

core::Result<void> take_integers(OIIO::ImageInput& input, NumberImage& image) {
  constexpr double kWhite = 65535;
  const auto mean = [](double sum, double count) {
    return std::floor((sum + (count > 1 ? 1 : 0)) / count);
  };
  auto ok = take_channels<std::uint16_t>(input, OIIO::TypeDesc::UINT16, mean, kWhite, image);
  image.white = kWhite;
  if (!ok || image.is_coloured) return ok;
  const auto usual = static_cast<int>(8 * input.spec().format.size());
  const int bits = input.spec().get_int_attribute("oiio:BitsPerSample", usual);
  if (bits < 1 || bits >= 16) return ok;
  image.white = std::ldexp(1.0, bits) - 1;
  for (float& value : image.values)
    value = static_cast<float>(std::round(double{value} * image.white / kWhite));
  return ok;
}

core::Result<NumberImage> decode_numbers(std::span<const std::uint8_t> bytes,
                                         const PictureHeader& header) {
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto opened = open(reader, header);
  if (!opened) return tl::unexpected(opened.error());
  OIIO::ImageInput& input = **opened;
  NumberImage image;
  image.width = header.width, image.height = header.height;
  const auto mean = [](double sum, double count) { return sum / count; };
  const auto take = [&]() -> core::Result<void> {
    switch (const auto type = static_cast<OIIO::TypeDesc::BASETYPE>(input.spec().format.basetype)) {
      case OIIO::TypeDesc::UINT8:
      case OIIO::TypeDesc::UINT16:
        return take_integers(input, image);
      // Conversions to floats would divide these by their largest values.
      case OIIO::TypeDesc::INT8:
        return take_channels<std::int8_t>(input, type, mean, 127, image);
      case OIIO::TypeDesc::INT16:
        return take_channels<std::int16_t>(input, type, mean, 32767, image);
      case OIIO::TypeDesc::INT32:
        return take_channels<std::int32_t>(input, type, mean, 2147483647.0, image);
      case OIIO::TypeDesc::UINT32:
        return take_channels<std::uint32_t>(input, type, mean, 4294967295.0, image);
      default:
        return take_channels<float>(input, OIIO::TypeDesc::FLOAT, mean, 1, image);
    }
  };
  if (auto ok = take(); !ok) return tl::unexpected(ok.error());
  image.is_premultiplied = header.format == PictureFormat::kExr ||
                           (header.format == PictureFormat::kTiff &&
                            input.spec().get_int_attribute("oiio:UnassociatedAlpha", 0) == 0);
  const int orientation = orientation_of(input);
  turn_upright(orientation, image, image.values);
  turn_upright(orientation, image, image.alpha);
  swap_sides(orientation, image);
  return image;
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
    psygen::image::decode, psygen::image::decode_numbers, psygen::image::encode_png,
    psygen::image::encode_grey_png, psygen::image::encode_exr};
