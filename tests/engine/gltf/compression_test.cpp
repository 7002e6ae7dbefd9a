// Meshes compressed by meshoptimizer and Draco, which their own encoders write here.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "engine/core/bytes.hpp"
#include "engine/gltf/read_file.hpp"
#include "tests/engine/gltf/sample.hpp"
#include "tests/temporary_folder.hpp"

#ifdef PSYGEN_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

namespace psygen::gltf {
namespace {

using core::ErrorCode;
using core::MeshData;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

// A wavy grid of 17 x 17 vertices.
struct Grid {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<std::uint32_t> indices;
};

Grid grid() {
  constexpr std::uint32_t kSide = 17;
  Grid g;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide), z = static_cast<float>(i / kSide);
    g.positions.emplace_back(x, std::sin(x) * std::cos(z), z);
    g.normals.push_back(glm::normalize(glm::vec3(std::sin(x), 2, std::cos(z))));
    g.uvs.emplace_back(x / (kSide - 1), z / (kSide - 1));
    if (i % kSide == kSide - 1 || i / kSide == kSide - 1) continue;
    g.indices.insert(g.indices.end(), {i, i + kSide, i + 1, i + 1, i + kSide, i + kSide + 1});
  }
  return g;
}

class Compressed : public testing::Test {
 protected:
  core::Result<Model> read(const Sample& sample, const Limits& limits = {}) {
    write_bytes(folder_ / "a.glb", sample.glb());
    return read_file(folder_ / "a.glb", limits);
  }
  MeshData mesh(const Sample& sample) {
    const auto model = read(sample);
    EXPECT_TRUE(model) << model.error().message;
    if (!model) return {};
    EXPECT_THAT(model->notes, IsEmpty());
    return model->meshes[0].primitives[0].mesh;
  }
  void refuse(const Sample& sample, const char* sentence, ErrorCode code = ErrorCode::kParse,
              const Limits& limits = {}) {
    const auto model = read(sample, limits);
    ASSERT_FALSE(model) << sentence;
    EXPECT_THAT(model.error().message, AllOf(HasSubstr("a.glb: "), HasSubstr(sentence)));
    EXPECT_EQ(model.error().code, code) << model.error().message;
  }
  TemporaryFolder folder_;
};

std::string_view text_of(const std::vector<unsigned char>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Adds a view that EXT_meshopt_compression fills, and whose own buffer has no bytes.
template <class T>
int packed_view(Sample& sample, const std::vector<unsigned char>& bytes,
                const std::vector<T>& plain, const char* mode, const char* filter = "NONE") {
  const int source = sample.view(text_of(bytes));
  const nlohmann::json from = sample.json["bufferViews"][static_cast<std::size_t>(source)];
  nlohmann::json view = {{"buffer", 1}, {"byteLength", plain.size() * sizeof(T)}};
  view["extensions"]["EXT_meshopt_compression"] = {
      {"buffer", 0},     {"byteOffset", from["byteOffset"]}, {"byteLength", bytes.size()},
      {"mode", mode},    {"byteStride", sizeof(T)},          {"count", plain.size()},
      {"filter", filter}};
  return sample.add("bufferViews", view);
}

template <class T>
std::vector<unsigned char> encoded(const std::vector<T>& values) {
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(),
                                          sizeof(T)));
  return bytes;
}

Sample packed_by_meshopt(const Grid& g, bool as_triangles) {
  Sample s;
  std::vector<unsigned char> indices(
      as_triangles ? meshopt_encodeIndexBufferBound(g.indices.size(), g.positions.size())
                   : meshopt_encodeIndexSequenceBound(g.indices.size(), g.positions.size()));
  const std::size_t bytes = as_triangles
                                ? meshopt_encodeIndexBuffer(indices.data(), indices.size(),
                                                            g.indices.data(), g.indices.size())
                                : meshopt_encodeIndexSequence(indices.data(), indices.size(),
                                                              g.indices.data(), g.indices.size());
  indices.resize(bytes);
  const auto accessor = [&](int view, std::size_t count, const char* type, int component) {
    return s.add(
        "accessors",
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  };
  const std::size_t count = g.positions.size();
  const int index_view = packed_view(s, indices, g.indices, as_triangles ? "TRIANGLES" : "INDICES");
  const int places = packed_view(s, encoded(g.positions), g.positions, "ATTRIBUTES");
  // Normals as octahedra of 8 bits.
  std::vector<glm::vec4> directions;
  for (const glm::vec3& normal : g.normals)
    directions.emplace_back(normal, 0);
  std::vector<std::array<std::int8_t, 4>> octahedra(count);
  meshopt_encodeFilterOct(octahedra.data(), count, 4, 8, &directions[0].x);
  const int normals = packed_view(s, encoded(octahedra), octahedra, "ATTRIBUTES", "OCTAHEDRAL");
  // Texture coordinates as exponents and mantissas.
  std::vector<std::array<std::uint32_t, 2>> mantissas(count);
#if MESHOPTIMIZER_VERSION < 190
  meshopt_encodeFilterExp(mantissas.data(), count, 8, 20, &g.uvs[0].x);
#else
  meshopt_encodeFilterExp(mantissas.data(), count, 8, 20, &g.uvs[0].x,
                          meshopt_EncodeExpSharedVector);
#endif
  const int uvs = packed_view(s, encoded(mantissas), mantissas, "ATTRIBUTES", "EXPONENTIAL");
  nlohmann::json primitive = {{"indices", accessor(index_view, g.indices.size(), "SCALAR", kInts)}};
  primitive["attributes"] = {{"POSITION", accessor(places, count, "VEC3", kFloats)},
                             {"NORMAL", accessor(normals, count, "VEC3", 5120)},
                             {"TEXCOORD_0", accessor(uvs, count, "VEC2", kFloats)}};
  s.json["accessors"][2]["normalized"] = true;
  s.add("meshes", {{"primitives", list(primitive)}});
  s.add("nodes", parsed(R"({"mesh": 0})"));
  s.json["extensionsUsed"] = s.json["extensionsRequired"] =
      parsed(R"(["EXT_meshopt_compression", "KHR_mesh_quantization"])");
  s.json["buffers"][0]["byteLength"] = s.binary.size();
  s.json["buffers"][1] = parsed(
      R"({"byteLength": 100000, "extensions": {"EXT_meshopt_compression": {"fallback": true}}})");
  return s;
}

// The extension's object of a view that has it.
nlohmann::json& meshopt_of(Sample& sample, std::size_t number) {
  for (nlohmann::json& view : sample.json["bufferViews"]) {
    if (view.contains("extensions") && number-- == 0)
      return view["extensions"]["EXT_meshopt_compression"];
  }
  return sample.json;
}

TEST_F(Compressed, MeshoptGivesTheVerticesAndTrianglesThatWereEncoded) {
  const Grid g = grid();
  for (const bool as_triangles : {false, true}) {
    const MeshData read = mesh(packed_by_meshopt(g, as_triangles));
    EXPECT_EQ(read.positions, g.positions);
    ASSERT_EQ(read.normals.size(), g.normals.size());
    for (std::size_t i = 0; i < g.normals.size(); ++i) {
      EXPECT_LT(glm::length(read.normals[i] - g.normals[i]), 0.02F) << i;
      EXPECT_LT(glm::length(read.uvs[i] - g.uvs[i]), 1e-5F) << i;
    }
    ASSERT_EQ(read.indices.size(), g.indices.size());
    if (!as_triangles) {
      EXPECT_EQ(read.indices, g.indices);
    }
    // The encoder of triangles may start them at another corner.
    for (std::size_t i = 0; i < g.indices.size(); i += 3) {
      const auto sum = [&](const std::vector<std::uint32_t>& all) {
        return all[i] + all[i + 1] + all[i + 2];
      };
      EXPECT_EQ(sum(read.indices), sum(g.indices)) << i;
    }
  }
}

TEST_F(Compressed, MeshoptCutShortOrChangedIsRejectedOrRead) {
  const Sample whole = packed_by_meshopt(grid(), true);
  for (const std::size_t view : {0u, 1u, 2u, 3u}) {
    Sample sample = whole;
    const std::size_t bytes = meshopt_of(sample, view)["byteLength"];
    for (std::size_t left = 0; left < bytes; left += 1 + bytes / 40) {
      meshopt_of(sample, view)["byteLength"] = left;
      refuse(sample, "is damaged or cut short");
    }
  }
  std::mt19937 random(1);
  for (int i = 0; i < 400; ++i) {
    Sample sample = whole;
    sample.binary[random() % sample.binary.size()] = static_cast<char>(random());
    const auto model = read(sample);
    EXPECT_TRUE(model || !model.error().message.empty());
  }
}

TEST_F(Compressed, MeshoptWithHugeCountsOrOddElementsIsRejectedBeforeItIsDecoded) {
  const Sample whole = packed_by_meshopt(grid(), true);
  for (const std::uint64_t count : {std::uint64_t{3} << 33, UINT64_MAX / 12 * 3}) {
    Sample sample = whole;
    meshopt_of(sample, 0)["count"] = count;
    refuse(sample, "EXT_meshopt_compression of bufferViews", ErrorCode::kOverBudget);
  }
  for (const auto& [key, value] : {std::pair<const char*, nlohmann::json>{"byteStride", 0},
                                   {"byteStride", 6},
                                   {"byteStride", 260},
                                   {"mode", "OTHER"},
                                   {"filter", "QUATERNION"},
                                   {"filter", "OTHER"}}) {
    Sample sample = whole;
    meshopt_of(sample, 1)[key] = value;
    refuse(sample, "cannot have");
  }
  Sample sample = whole;
  meshopt_of(sample, 1)["byteOffset"] = 1 << 30;
  refuse(sample, "but its buffer has");
  sample = whole;
  meshopt_of(sample, 1)["buffer"] = 1;
  refuse(sample, "buffers[1] has no bytes");
}

#ifdef PSYGEN_DRACO

Sample packed_by_draco(const Grid& g, int method, draco::EncoderBuffer& buffer) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(g.indices.size() / 3));
  const auto add = [&](auto type, int width, auto kind, const auto& values) {
    const int id = builder.AddAttribute(kind, static_cast<std::int8_t>(width), type);
    for (std::size_t i = 0; i < g.indices.size(); i += 3)
      builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<std::uint32_t>(i / 3)),
                                        &values[g.indices[i]], &values[g.indices[i + 1]],
                                        &values[g.indices[i + 2]]);
    return id;
  };
  const std::vector<std::array<std::uint8_t, 4>> colours(g.positions.size(), {255, 51, 0, 255});
  const int position = add(draco::DT_FLOAT32, 3, draco::GeometryAttribute::POSITION, g.positions);
  const int uv = add(draco::DT_FLOAT32, 2, draco::GeometryAttribute::TEX_COORD, g.uvs);
  const int colour = add(draco::DT_UINT8, 4, draco::GeometryAttribute::COLOR, colours);
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  Sample s;
  const int view = s.view({buffer.data(), buffer.size()});
  const auto accessor = [&](std::size_t count, const char* type, int component) {
    return s.add("accessors", {{"componentType", component}, {"count", count}, {"type", type}});
  };
  nlohmann::json primitive = {{"indices", accessor(g.indices.size(), "SCALAR", kInts)}};
  primitive["attributes"] = {{"POSITION", accessor(mesh->num_points(), "VEC3", kFloats)},
                             {"TEXCOORD_0", accessor(mesh->num_points(), "VEC2", kFloats)},
                             {"COLOR_0", accessor(mesh->num_points(), "VEC4", kBytes)}};
  s.json["accessors"][3]["normalized"] = true;
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view},
      {"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}, {"COLOR_0", colour}}}};
  s.add("meshes", {{"primitives", list(primitive)}});
  s.add("nodes", parsed(R"({"mesh": 0})"));
  s.json["extensionsUsed"] = s.json["extensionsRequired"] = list("KHR_draco_mesh_compression");
  return s;
}

// The corners of all triangles, in an order that does not depend on that of the triangles.
std::vector<std::array<float, 5>> corners_of(const std::vector<glm::vec3>& positions,
                                             const std::vector<glm::vec2>& uvs,
                                             const std::vector<std::uint32_t>& indices) {
  std::vector<std::array<float, 5>> corners;
  for (const std::uint32_t i : indices)
    corners.push_back({positions[i].x, positions[i].y, positions[i].z, uvs[i].x, uvs[i].y});
  std::ranges::sort(corners);
  return corners;
}

TEST_F(Compressed, DracoGivesTheTrianglesThatWereEncoded) {
  const Grid g = grid();
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    draco::EncoderBuffer buffer;
    const MeshData read = mesh(packed_by_draco(g, method, buffer));
    EXPECT_EQ(corners_of(read.positions, read.uvs, read.indices),
              corners_of(g.positions, g.uvs, g.indices));
    ASSERT_FALSE(read.colours.empty());
    EXPECT_FLOAT_EQ(read.colours[5].y, 0.2F);
    EXPECT_EQ(read.normals.size(), read.indices.size()) << "flat, for there are none";
  }
}

TEST_F(Compressed, DracoCutShortOrChangedIsRejectedOrRead) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    draco::EncoderBuffer buffer;
    const Sample whole = packed_by_draco(grid(), method, buffer);
    for (std::size_t left = 0; left < buffer.size(); left += 1 + buffer.size() / 100) {
      Sample sample = whole;
      sample.json["bufferViews"][0]["byteLength"] = left;
      refuse(sample, "KHR_draco_mesh_compression of meshes[0].primitives[0]");
    }
    std::mt19937 random(2);
    for (int i = 0; i < 400; ++i) {
      Sample sample = whole;
      sample.binary[random() % sample.binary.size()] = static_cast<char>(random());
      const auto model = read(sample);
      EXPECT_TRUE(model || !model.error().message.empty());
    }
  }
}

TEST_F(Compressed, DracoWithHugeCountsOrOtherAttributesIsRejectedBeforeItIsDecoded) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    draco::EncoderBuffer buffer;
    Sample sample = packed_by_draco(grid(), method, buffer);
    // Header, type of the traversal, then the counts: 2^31 each.
    const std::size_t at = method == draco::MESH_EDGEBREAKER_ENCODING ? 12 : 11;
    sample.binary.replace(at, 10, "\x80\x80\x80\x80\x08\x80\x80\x80\x80\x08");
    refuse(sample, "2147483648 triangles", ErrorCode::kOverBudget);
  }
  draco::EncoderBuffer buffer;
  Sample sample = packed_by_draco(grid(), draco::MESH_EDGEBREAKER_ENCODING, buffer);
  nlohmann::json& primitive = sample.json["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 77;
  refuse(sample, "has no compressed attribute 77");
  primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("POSITION");
  refuse(sample, "POSITION is not among the compressed attributes");
}

// 1000 triangles of 3000 points and `attributes` of `width` doubles each, without their values.
Sample huge_by_draco(std::uint32_t attributes, std::uint8_t width) {
  draco::EncoderBuffer buffer;
  Sample s = packed_by_draco(grid(), draco::MESH_SEQUENTIAL_ENCODING, buffer);
  s.binary = std::string("DRACO\2\2\1\0\0\0", 11);
  core::put_varint(s.binary, 1000);
  core::put_varint(s.binary, 3000);
  core::put(s.binary, std::uint8_t{1});  // plain indices of 16 bits
  s.binary += std::string(std::size_t{2} * 3 * 1000, '\0');
  core::put(s.binary, std::uint8_t{1});  // decoder
  core::put_varint(s.binary, attributes);
  for (std::uint32_t i = 0; i < attributes; ++i)
    core::put(s.binary, std::uint8_t{draco::GeometryAttribute::POSITION},
              std::uint8_t{draco::DT_FLOAT64}, width, std::uint8_t{0}, std::uint8_t{0});
  s.binary += std::string(attributes, '\0');  // plain values
  s.json["bufferViews"][0]["byteLength"] = s.binary.size();
  return s;
}

TEST_F(Compressed, DracoWithHugeAttributesIsRejectedBeforeTheyAreAllocated) {
  refuse(huge_by_draco(1, 255), "has an attribute of 255 components; at most 4 are allowed");
  refuse(huge_by_draco(3000, 4), "has attributes of 288000000 bytes", ErrorCode::kOverBudget);
  refuse(huge_by_draco(1, 1), "is damaged or cut short");
}

#else

TEST_F(Compressed, DracoIsNamedByABuildWithoutIt) {
  Sample sample = square();
  sample.json["extensionsRequired"] = list("KHR_draco_mesh_compression");
  sample.json["accessors"][0].erase("bufferView");
  sample.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] =
      parsed(R"({"bufferView": 0, "attributes": {"POSITION": 0}})");
  refuse(sample, "was built without libdraco", ErrorCode::kInvalidArgument);
}

#endif

}  // namespace
}  // namespace psygen::gltf
