#include "engine/gltf/draco.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#ifdef PSYGEN_DRACO
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
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
// bitstream 2.2, sections 3 to 6). Returns whether the triangles are compressed by EdgeBreaker.
core::Result<bool> check_counts(Source::View bytes, const Limits& limits, const std::string& name) {
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
  if (!edges && header.encoder_method != draco::MESH_SEQUENTIAL_ENCODING)
    return wrong(name + " is damaged or cut short");
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
  return edges;
}

constexpr int kMaxWidth = 4;  // components of an attribute

// A decoder that checks the attributes before it allocates memory for their values.
template <class Decoder>
class Bounded final : public Decoder {
 public:
  // Decodes into `mesh`, whose attributes may have `max_bytes` bytes together.
  core::Result<void> read(Source::View bytes, std::uint64_t max_bytes, const std::string& name,
                          draco::Mesh& mesh) {
    max_bytes_ = max_bytes;
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const bool ok = Decoder::Decode(draco::DecoderOptions(), &buffer, &mesh).ok();
    if (width_ > kMaxWidth)
      return wrong(fmt::format("{} has an attribute of {} components; at most {} are allowed", name,
                               width_, kMaxWidth));
    if (bytes_ > max_bytes)
      return core::fail(core::ErrorCode::kOverBudget,
                        fmt::format("{} has attributes of {} bytes; at most {} are allowed", name,
                                    bytes_, max_bytes));
    return ok ? core::Result<void>{} : wrong(name + " is damaged or cut short");
  }

 protected:
  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *cloud.attribute(i);
      width_ = std::max(width_, int{attribute.num_components()});
      bytes_ += static_cast<std::uint64_t>(attribute.byte_stride()) * cloud.num_points();
    }
    return width_ <= kMaxWidth && bytes_ <= max_bytes_ && Decoder::DecodeAllAttributes();
  }

 private:
  std::uint64_t max_bytes_ = 0, bytes_ = 0;
  int width_ = 0;  // of the widest attribute
};

template <class T>
void append(const draco::PointAttribute& from, draco::PointIndex point, int width,
            std::vector<std::uint8_t>& out) {
  T values[kMaxWidth] = {};
  from.ConvertValue<T>(from.mapped_index(point), static_cast<std::int8_t>(width), values);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
  out.insert(out.end(), bytes, bytes + sizeof(T) * static_cast<std::size_t>(width));
}

// Copies an attribute of all points with the types of its accessor.
core::Result<Unpacked::Attribute> copy(const draco::Mesh& mesh, const draco::PointAttribute& from,
                                       const AccessorJson& accessor, const std::string& what) {
  if (accessor.width < 1 || accessor.width > kMaxWidth || from.num_components() > kMaxWidth)
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
  const auto edges = check_counts(*bytes, reading.limits, what);
  if (!edges) return tl::unexpected(edges.error());
  draco::Mesh mesh;
  const std::uint64_t max_bytes = reading.limits.bytes;
  const auto ok = *edges
                      ? Bounded<draco::MeshEdgebreakerDecoder>().read(*bytes, max_bytes, what, mesh)
                      : Bounded<draco::MeshSequentialDecoder>().read(*bytes, max_bytes, what, mesh);
  if (!ok) return tl::unexpected(ok.error());
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
