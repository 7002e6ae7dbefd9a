// The JSON of a glTF file as plain values, with the names and defaults of the specification (glTF
// 2.0). Numbers have the kind that the specification asks for; indices and sizes are not checked.
// nlohmann::json parses it: TinyGLTF reads all images before anything is known to use them, and
// refuses files that the specification allows. Private to engine/gltf.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::gltf {

// Of an index: the file has none.
inline constexpr int kAbsent = -1;

// Types of a component, and modes of a primitive.
inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                     kUnsignedInt = 5125, kFloat = 5126;
inline constexpr int kPoints = 0, kTriangles = 4, kTriangleFan = 6;

struct BufferJson {
  std::string uri;
  std::uint64_t bytes = 0;
};
// EXT_meshopt_compression of a view.
struct PackedJson {
  int buffer = kAbsent;
  std::uint64_t offset = 0, bytes = 0, stride = 0, count = 0;
  std::string mode, filter;
};
struct ViewJson {
  int buffer = kAbsent;
  std::uint64_t offset = 0, bytes = 0, stride = 0;
  std::optional<PackedJson> packed;
};
struct SparseJson {
  std::uint64_t count = 0;
  int index_view = kAbsent, index_component = 0, value_view = kAbsent;
  std::uint64_t index_offset = 0, value_offset = 0;
};
struct AccessorJson {
  int view = kAbsent, component = 0, width = 0;  // width: components of an element; 0: unknown
  std::uint64_t offset = 0, count = 0;
  bool normalised = false;
  std::optional<SparseJson> sparse;
};
struct ImageJson {
  std::string uri;
  int view = kAbsent;
};
// Images by extension: the core's is "".
struct TextureJson {
  int source = kAbsent, webp = kAbsent, sampler = kAbsent;
  std::string other_extension;  // the last of its other extensions
};
// A texture of a material, with KHR_texture_transform.
struct TextureUseJson {
  int texture = kAbsent, set = 0;
  std::vector<double> offset, scale;
  double rotation = 0, strength = 1;  // radians; scale of a normal map
};
struct MaterialJson {
  std::string name, alpha_mode;
  std::vector<double> base_colour, emissive;  // empty: the default
  double emissive_strength = 1, alpha_cutoff = 0.5;
  TextureUseJson base, normal, light;
  bool two_sided = false;
};
using AttributesJson = std::map<std::string, int>;
// KHR_draco_mesh_compression of a primitive: attributes by their numbers in the compressed bytes.
struct DracoJson {
  int view = kAbsent;
  AttributesJson attributes;
};
struct PrimitiveJson {
  AttributesJson attributes;
  int indices = kAbsent, material = kAbsent, mode = kTriangles;
  bool morphs = false;
  std::optional<DracoJson> draco;
};
struct MeshJson {
  std::string name;
  std::vector<PrimitiveJson> primitives;
};
struct NodeJson {
  std::string name;
  int mesh = kAbsent, skin = kAbsent;
  std::vector<int> children;
  std::vector<double> matrix, translation, rotation, scale;  // empty: the default
};
struct ChannelJson {
  int sampler = kAbsent, node = kAbsent;
  std::string path;
  bool is_pointer = false;  // KHR_animation_pointer
};
struct SamplerJson {
  int input = kAbsent, output = kAbsent;
  std::string interpolation;
};
struct AnimationJson {
  std::string name;
  std::vector<ChannelJson> channels;
  std::vector<SamplerJson> samplers;
};

struct Document {
  std::string version, min_version;
  std::vector<std::string> extensions_used, extensions_required;
  std::vector<BufferJson> buffers;
  std::vector<ViewJson> views;
  std::vector<AccessorJson> accessors;
  std::vector<ImageJson> images;
  std::vector<TextureJson> textures;
  std::vector<bool> samplers;  // true: they repeat the image both ways
  std::vector<MaterialJson> materials;
  std::vector<MeshJson> meshes;
  std::vector<NodeJson> nodes;
  std::vector<std::vector<int>> scenes;  // the nodes of each
  std::vector<AnimationJson> animations;
  int scene = kAbsent;
};

// Of other versions than 2, only the version is read. Fails with kParse, naming the place, for
// values of a wrong kind; the message does not name the file. Throws nlohmann::json's exceptions
// for texts that are not JSON.
core::Result<Document> parse_document(std::string_view json);

// The bytes of a "data:" URI in base64; nothing if it is none. Fails with kParse.
std::optional<core::Result<std::vector<std::uint8_t>>> data_of(std::string_view uri);
// A URI with its %20 and the like replaced.
std::string plain_uri(std::string_view uri);

}  // namespace psygen::gltf
