#include <tiny_gltf.h>

#include <array>
#include <glm/common.hpp>
#include <map>
#include <span>
#include <sstream>

#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/exchange/write_document.hpp"

namespace psygen::exchange {
namespace {

// The .glb header counts bytes in 32 bits. The rest is reserved for the JSON.
constexpr std::size_t kMaxBytes = (std::size_t{1} << 32) - (std::size_t{1} << 28);
// The library terminates the program if its JSON cannot allocate. So there must be enough memory
// first: for the JSON, and for copies of the bytes in its buffer, its stream and ours.
constexpr std::uint64_t kWriterBytes = std::uint64_t{8} << 20, kWriterCopies = 5;

enum View : std::size_t { kPositions, kNormals, kColours, kIndices, kViewCount };
constexpr std::array<std::size_t, kViewCount> kStrides{12, 12, 8, 0};

class GlbWriter {
 public:
  GlbWriter() {
    model_.asset.version = "2.0";
    model_.asset.generator = "psygen";
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
  }

  void add(const Object& object) {
    tinygltf::Mesh mesh;
    mesh.name = object.name;
    for (const Part& part : object.parts) {
      if (!part.indices.empty()) mesh.primitives.push_back(primitive_of(part));
    }
    if (mesh.primitives.empty()) return;  // a mesh without primitives is not allowed
    tinygltf::Node node;
    node.name = object.name;
    node.mesh = static_cast<int>(model_.meshes.size());
    const glm::dvec3 at(object.position);
    if (at != glm::dvec3(0.0)) node.translation = {at.x, at.y, at.z};
    model_.meshes.push_back(std::move(mesh));
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }

  // Moves everything below a new node at `origin`.
  void move_all_to(const glm::dvec3& origin) {
    if (origin == glm::dvec3(0.0) || model_.nodes.empty()) return;
    tinygltf::Node root;
    root.translation = {origin.x, origin.y, origin.z};
    root.children = std::move(model_.scenes[0].nodes);
    model_.scenes[0].nodes = {static_cast<int>(model_.nodes.size())};
    model_.nodes.push_back(std::move(root));
  }

  core::Result<std::vector<std::uint8_t>> finish(const std::string& name) {
    model_.scenes[0].name = name;
    std::size_t bytes = 0;
    for (const auto& view : views_)
      bytes += view.size();
    if (bytes > kMaxBytes)
      return core::fail(core::ErrorCode::kOverBudget,
                        name + " exceeds the size limit of .glb files");
    if (!core::memory_left(kWriterBytes + kWriterCopies * bytes))
      return core::fail(core::ErrorCode::kOutOfMemory, core::out_of_memory("writing " + name));
    if (bytes > 0) join_views();
    std::ostringstream stream;
    stream.exceptions(std::ios::badbit);  // rethrows std::bad_alloc, which streams swallow
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, stream, false, true))
      return core::fail(core::ErrorCode::kInternal, name + " cannot be written as glTF");
    const std::string text = std::move(stream).str();
    return std::vector<std::uint8_t>(text.begin(), text.end());
  }

 private:
  template <class T>
  int accessor(View view, std::span<const T> values, int type, int component, std::size_t count) {
    std::vector<unsigned char>& bytes = views_[view];
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(view);
    accessor.byteOffset = bytes.size();
    accessor.componentType = component;
    accessor.count = count;
    accessor.type = type;
    const auto raw = std::as_bytes(values);
    const auto* first = reinterpret_cast<const unsigned char*>(raw.data());
    bytes.insert(bytes.end(), first, first + raw.size());
    bytes.resize((bytes.size() + 3) / 4 * 4);
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  tinygltf::Primitive primitive_of(const Part& part) {
    const std::size_t count = part.positions.size();
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = material_of(part.material);
    const int positions = accessor<glm::vec3>(kPositions, part.positions, TINYGLTF_TYPE_VEC3,
                                              TINYGLTF_COMPONENT_TYPE_FLOAT, count);
    glm::vec3 low = part.positions.front(), high = low;
    for (const glm::vec3& p : part.positions) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    const glm::dvec3 least(low), most(high);
    auto& described = model_.accessors[static_cast<std::size_t>(positions)];
    described.minValues = {least.x, least.y, least.z};
    described.maxValues = {most.x, most.y, most.z};
    primitive.attributes["POSITION"] = positions;
    primitive.attributes["NORMAL"] = accessor<glm::vec3>(kNormals, part.normals, TINYGLTF_TYPE_VEC3,
                                                         TINYGLTF_COMPONENT_TYPE_FLOAT, count);
    std::vector<std::array<std::uint16_t, 4>> colours;
    colours.reserve(count);
    for (const glm::vec3& colour : part.colours) {
      const glm::vec3 c = glm::clamp(colour, 0.0F, 1.0F) * 65535.0F + 0.5F;
      colours.push_back({static_cast<std::uint16_t>(c.x), static_cast<std::uint16_t>(c.y),
                         static_cast<std::uint16_t>(c.z), 65535});
    }
    const int colour = accessor<std::array<std::uint16_t, 4>>(
        kColours, colours, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, count);
    model_.accessors[static_cast<std::size_t>(colour)].normalized = true;
    primitive.attributes["COLOR_0"] = colour;
    primitive.indices = indices_of(part);
    return primitive;
  }

  int indices_of(const Part& part) {
    if (part.positions.size() > 65535) {  // index 65535 would restart a primitive
      return accessor<std::uint32_t>(kIndices, part.indices, TINYGLTF_TYPE_SCALAR,
                                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, part.indices.size());
    }
    const std::vector<std::uint16_t> narrow(part.indices.begin(), part.indices.end());
    return accessor<std::uint16_t>(kIndices, narrow, TINYGLTF_TYPE_SCALAR,
                                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, narrow.size());
  }

  int material_of(std::uint8_t material) {
    const auto [found, is_new] = materials_.try_emplace(material, model_.materials.size());
    if (is_new) {
      tinygltf::Material described;
      described.name = material_name(material);
      described.doubleSided = material == kLeaf;
      described.pbrMetallicRoughness.metallicFactor = 0;
      described.pbrMetallicRoughness.roughnessFactor = 1;
      model_.materials.push_back(std::move(described));
    }
    return static_cast<int>(found->second);
  }

  void join_views() {
    tinygltf::Buffer buffer;
    for (std::size_t i = 0; i < kViewCount; ++i) {
      tinygltf::BufferView view;
      view.buffer = 0;
      view.byteOffset = buffer.data.size();
      view.byteLength = views_[i].size();
      view.byteStride = kStrides[i];
      view.target =
          i == kIndices ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER;
      model_.bufferViews.push_back(std::move(view));
      buffer.data.insert(buffer.data.end(), views_[i].begin(), views_[i].end());
    }
    model_.buffers.push_back(std::move(buffer));
  }

  tinygltf::Model model_;
  std::array<std::vector<unsigned char>, kViewCount> views_;
  std::map<std::uint8_t, std::size_t> materials_;
};

}  // namespace

core::Result<std::vector<std::uint8_t>> glb_bytes(const Document& document) {
  GlbWriter writer;
  for (const Object& object : document.objects)
    writer.add(object);
  writer.move_all_to(document.origin);
  return writer.finish(document.name);
}

}  // namespace psygen::exchange
