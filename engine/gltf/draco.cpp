#include "engine/gltf/draco.hpp"

#include <fmt/format.h>

#include <utility>

#ifdef PSYGEN_DRACO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#pragma GCC diagnostic pop
#endif

namespace psygen::gltf {

core::Result<Elements> elements_of(const Unpacked& unpacked, const std::string& attribute) {
  const auto found = unpacked.attributes.find(attribute);
  if (found == unpacked.attributes.end())
    return wrong(attribute + " is not among the compressed attributes");
  Elements elements = found->second.elements;
  elements.first = found->second.bytes.data();
  return elements;
}

#ifdef PSYGEN_DRACO
namespace {

// Reads the counts at the beginning of the bytes, for which the decoder allocates memory (Draco
// bitstream 2.2, sections 3 to 6).
core::Result<void> check_counts(Source::View bytes, const Limits& limits, const std::string& name) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DracoHeader header{};
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok())
    return wrong(name + " is not compressed by Draco, or is cut short");
  if (header.version_major != 2 || header.version_minor != 2 ||
      header.encoder_type != draco::TRIANGULAR_MESH)
    return wrong(fmt::format("{} has Draco's version {}.{} and type {}; glTF has triangles of 2.2",
                             name, header.version_major, header.version_minor,
                             header.encoder_type));
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  draco::GeometryMetadata ignored;
  if ((header.flags & METADATA_FLAG_MASK) != 0 &&
      !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored))
    return wrong(name + " is damaged or cut short");
  const bool edges = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
  std::uint8_t traversal = 0;
  std::uint32_t first = 0, second = 0;
  if ((edges && !buffer.Decode(&traversal)) || !draco::DecodeVarint(&first, &buffer) ||
      !draco::DecodeVarint(&second, &buffer))
    return wrong(name + " is damaged or cut short");
  const std::uint64_t vertices = edges ? first : second, faces = edges ? second : first;
  if (vertices > limits.vertices || 3 * faces > limits.indices)
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("{} has {} vertices and {} triangles; at most {} and {} are "
                                  "allowed",
                                  name, vertices, faces, limits.vertices, limits.indices / 3));
  return {};
}

template <class T>
void append(const draco::PointAttribute& from, draco::PointIndex point, int width,
            std::vector<std::uint8_t>& out) {
  T values[4] = {};
  from.ConvertValue<T>(from.mapped_index(point), static_cast<std::int8_t>(width), values);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
  out.insert(out.end(), bytes, bytes + sizeof(T) * static_cast<std::size_t>(width));
}

// Copies an attribute of all points with the types of its accessor.
core::Result<Unpacked::Attribute> copy(const draco::Mesh& mesh, const draco::PointAttribute& from,
                                       const AccessorJson& accessor, const std::string& what) {
  if (accessor.width < 1 || accessor.width > 4 || from.num_components() > 4)
    return wrong(what + " has an unknown type");
  Unpacked::Attribute out;
  out.elements.component = accessor.component;
  out.elements.width = accessor.width;
  out.elements.normalised = accessor.normalised;
  out.elements.count = mesh.num_points();
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    switch (accessor.component) {
      case kByte:
        append<std::int8_t>(from, point, accessor.width, out.bytes);
        break;
      case kUnsignedByte:
        append<std::uint8_t>(from, point, accessor.width, out.bytes);
        break;
      case kShort:
        append<std::int16_t>(from, point, accessor.width, out.bytes);
        break;
      case kUnsignedShort:
        append<std::uint16_t>(from, point, accessor.width, out.bytes);
        break;
      case kFloat:
        append<float>(from, point, accessor.width, out.bytes);
        break;
      default:
        return wrong(fmt::format("{} has the component type {}", what, accessor.component));
    }
  }
  out.elements.stride_bytes = mesh.num_points() > 0 ? out.bytes.size() / mesh.num_points() : 0;
  return out;
}

}  // namespace

core::Result<Unpacked> unpack_draco(Reading& reading, const PrimitiveJson& primitive,
                                    const std::string& name) {
  const std::string what = "KHR_draco_mesh_compression of " + name;
  const auto bytes = reading.source.of_view(primitive.draco->view, what);
  if (!bytes) return tl::unexpected(bytes.error());
  if (auto ok = check_counts(*bytes, reading.limits, what); !ok) return tl::unexpected(ok.error());
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return wrong(what + " is damaged or cut short");
  const draco::Mesh& mesh = *decoded.value();
  if (mesh.num_points() > reading.limits.vertices)
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("{} has {} vertices; at most {} are allowed", what,
                                  mesh.num_points(), reading.limits.vertices));
  Unpacked out;
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
    for (const draco::PointIndex& corner : mesh.face(face))
      out.indices.push_back(corner.value());
  }
  for (const auto& [attribute, accessor] : primitive.attributes) {
    const auto id = primitive.draco->attributes.find(attribute);
    if (id == primitive.draco->attributes.end()) continue;
    const std::string of = fmt::format("{} of {}", attribute, name);
    const auto number = index_in(accessor, reading.file.accessors.size(), of);
    if (!number) return tl::unexpected(number.error());
    const draco::PointAttribute* from =
        id->second < 0 ? nullptr
                       : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id->second));
    if (from == nullptr)
      return wrong(fmt::format("{} has no compressed attribute {}", what, id->second));
    auto copied = copy(mesh, *from, reading.file.accessors[*number], of);
    if (!copied) return tl::unexpected(copied.error());
    out.attributes[attribute] = std::move(*copied);
  }
  return out;
}

#else

core::Result<Unpacked> unpack_draco(Reading&, const PrimitiveJson&, const std::string& name) {
  return core::invalid_argument(
      fmt::format("{} is compressed by KHR_draco_mesh_compression, which this build of psygen "
                  "cannot read: it was built without libdraco",
                  name));
}

#endif

}  // namespace psygen::gltf
