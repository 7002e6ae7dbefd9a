// Compares the content of read files with the written values, and with another library.
#include "engine/gltf/read_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "engine/image/image_io.hpp"
#include "tests/engine/gltf/sample.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::gltf {
namespace {

using testing::HasSubstr;

class ReadFile : public testing::Test {
 protected:
  Model read(const Sample& sample) {
    write_bytes(folder_ / "a.glb", sample.glb());
    auto model = read_file(folder_ / "a.glb");
    EXPECT_TRUE(model) << model.error().message;
    return model ? std::move(*model) : Model{};
  }
  TemporaryFolder folder_;
};

void expect_square(const Model& model) {
  ASSERT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.meshes[0].primitives.size(), 1u);
  const Primitive& primitive = model.meshes[0].primitives[0];
  EXPECT_EQ(primitive.mesh.positions[2], glm::vec3(1, 1, 0));
  EXPECT_EQ(primitive.mesh.normals[3], glm::vec3(0, 0, 1));
  EXPECT_EQ(primitive.mesh.uvs[0], glm::vec2(0, 1));
  EXPECT_FLOAT_EQ(primitive.mesh.colours[1].z, 0.2F);
  EXPECT_THAT(primitive.mesh.indices, testing::ElementsAre(0, 1, 2, 0, 2, 3));
  EXPECT_EQ(primitive.material, 0u);
  ASSERT_EQ(model.nodes.size(), 1u);
  EXPECT_EQ(model.nodes[0].mesh, 0u);
  ASSERT_EQ(model.animations.size(), 1u);
  EXPECT_EQ(model.animations[0].name, "slide");
  EXPECT_EQ(model.animations[0].duration_s, 2.0F);
  EXPECT_EQ(model.animations[0].channels[0].values[2], glm::vec4(3, 0, 0, 0));
  EXPECT_THAT(model.notes, testing::IsEmpty());
}

TEST_F(ReadFile, ReadsMeshesMaterialsNodesAndAnimationsOfAGlb) {
  const Model model = read(square());
  expect_square(model);
  ASSERT_EQ(model.materials.size(), 1u);
  const Material& material = model.materials[0];
  EXPECT_EQ(material.base_colour, glm::vec3(0.5F, 0.25F, 0.125F));
  EXPECT_EQ(material.emissive, glm::vec3(0.5F, 0, 0));
  EXPECT_EQ(material.min_opacity, 0.25F);
  EXPECT_TRUE(material.two_sided);
}

TEST_F(ReadFile, ReadsABufferNextToAGltf) {
  const Sample sample = square();
  write_bytes(folder_ / "a b.bin", sample.binary);
  write_bytes(folder_ / "a.gltf", sample.text("a%20b.bin"));
  const auto beside = read_file(folder_ / "a.gltf");
  ASSERT_TRUE(beside) << beside.error().message;
  expect_square(*beside);
}

TEST_F(ReadFile, DecodesImagesInBuffersAndNextToTheFile) {
  ASSERT_TRUE(image::write_png(folder_ / "wood.png", image::make_image(4, 2, 9, 8, 7, 255)));
  std::ifstream stream(folder_ / "wood.png", std::ios::binary);
  const std::string png(std::istreambuf_iterator<char>(stream), {});
  Sample sample = square();
  const int view = sample.view(png);
  sample.json["images"][0]["uri"] = "wood.png";
  sample.json["images"][1] = {{"bufferView", view}, {"mimeType", "image/png"}};
  sample.json["textures"] = parsed(R"([{"source": 1}, {"source": 0}])");
  sample.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  sample.json["materials"][0]["normalTexture"] = {{"index", 1}, {"scale", 0.5}};
  sample.json["materials"][0]["emissiveTexture"]["index"] = 0;
  const Model model = read(sample);
  ASSERT_EQ(model.images.size(), 2u) << "a picture is decoded once";
  EXPECT_EQ(*model.images[1], image::make_image(4, 2, 9, 8, 7, 255));
  EXPECT_EQ(model.materials[0].base_texture, model.materials[0].emissive_texture);
  EXPECT_NE(model.materials[0].base_texture, model.materials[0].normal_texture);
  EXPECT_EQ(model.materials[0].normal_strength, 0.5F);
}

TEST_F(ReadFile, MakesTrianglesOfStripsAndFansAndFlatNormalsIfNoneAreGiven) {
  Sample sample = square();
  nlohmann::json& primitive = sample.json["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["attributes"].erase("NORMAL");
  primitive["mode"] = 6;
  Model model = read(sample);
  const core::MeshData& fan = model.meshes[0].primitives[0].mesh;
  ASSERT_EQ(fan.positions.size(), 6u);
  EXPECT_EQ(fan.positions[4], glm::vec3(1, 1, 0));
  for (const glm::vec3& normal : fan.normals)
    EXPECT_EQ(normal, glm::vec3(0, 0, 1));
  primitive["mode"] = 5;
  primitive["indices"] = sample.accessor(std::vector<std::uint8_t>{0, 1, 3, 2}, "SCALAR", kBytes);
  model = read(sample);
  const core::MeshData& strip = model.meshes[0].primitives[0].mesh;
  ASSERT_EQ(strip.normals.size(), 6u);
  for (const glm::vec3& normal : strip.normals)
    EXPECT_EQ(normal, glm::vec3(0, 0, 1)) << "every second triangle is turned";
}

TEST_F(ReadFile, OrdersNodesAndDecomposesMatrices) {
  Sample sample = square();
  sample.json["nodes"] = parsed(R"([
      {"mesh": 0, "name": "leaf", "scale": [2, 3, 4]},
      {"children": [0], "name": "root", "matrix": [0,2,0,0, -3,0,0,0, 0,0,4,0, 5,6,7,1]}])");
  sample.json["scenes"][0]["nodes"][0] = 1;
  const Model model = read(sample);
  ASSERT_EQ(model.nodes.size(), 2u);
  EXPECT_EQ(model.nodes[0].name, "root");
  EXPECT_EQ(model.nodes[1].parent, 0u);
  EXPECT_EQ(model.animations[0].channels[0].node, 1u);
  const Pose& pose = model.nodes[0].rest;
  EXPECT_EQ(pose.translation, glm::vec3(5, 6, 7));
  EXPECT_EQ(pose.scale, glm::vec3(2, 3, 4));
  EXPECT_LT(glm::length(pose.rotation * glm::vec3(1, 0, 0) - glm::vec3(0, 1, 0)), 1e-6F);
}

TEST_F(ReadFile, WarnsOfUnsupportedFeatures) {
  Sample sample = square();
  sample.json["extensionsUsed"][0] = "KHR_materials_clearcoat";
  sample.json["skins"] = parsed(R"([{"joints": [0]}])");
  sample.json["nodes"][0]["skin"] = 0;
  sample.json["materials"][0]["alphaMode"] = "BLEND";
  nlohmann::json& primitives = sample.json["meshes"][0]["primitives"];
  primitives[0]["targets"][0]["POSITION"] = 0;
  primitives.push_back(nlohmann::json(primitives[0]));
  primitives[1]["mode"] = 1;
  const Model model = read(sample);
  EXPECT_EQ(model.meshes[0].primitives.size(), 1u);
  ASSERT_EQ(model.notes.size(), 5u);
  for (const std::string& note : model.notes)
    EXPECT_THAT(note, HasSubstr("a.glb: "));
  const std::string all = testing::PrintToString(model.notes);
  for (const char* word : {"clearcoat", "skins", "blend", "morph", "points or lines"})
    EXPECT_THAT(all, HasSubstr(word));
}

void collect(const aiScene& scene, const aiNode& node, aiMatrix4x4 above,
             std::vector<glm::vec3>& out) {
  above = above * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      for (unsigned c = 0; c < 3; ++c) {
        const aiVector3D v = above * mesh.mVertices[mesh.mFaces[f].mIndices[c]];
        out.push_back({v.x, v.y, v.z});
      }
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    collect(scene, *node.mChildren[i], above, out);
}

std::vector<glm::vec3> corners_of(const Model& model) {
  std::vector<glm::vec3> out;
  for (const Node& start : model.nodes) {
    if (start.mesh == kNone) continue;
    for (const Primitive& primitive : model.meshes[start.mesh].primitives) {
      for (const std::uint32_t index : primitive.mesh.indices) {
        glm::vec3 p = primitive.mesh.positions[index];
        for (const Node* node = &start; node != nullptr;
             node = node->parent == kNone ? nullptr : &model.nodes[node->parent])
          p = node->rest.rotation * (node->rest.scale * p) + node->rest.translation;
        out.push_back(p);
      }
    }
  }
  return out;
}

TEST(ShippedModel, HasTheSameCornersInAnotherLibrary) {
  const std::string file = source_file("examples/09_gltf/windmill.glb");
  const auto model = read_file(file);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_THAT(model->notes, testing::IsEmpty());
  EXPECT_EQ(model->images.size(), 3u);
  EXPECT_EQ(model->animations.size(), 2u);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file, aiProcess_ValidateDataStructure);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  std::vector<glm::vec3> theirs, ours = corners_of(*model);
  collect(*scene, *scene->mRootNode, aiMatrix4x4(), theirs);
  ASSERT_EQ(ours.size(), theirs.size());
  const auto before = [](const glm::vec3& a, const glm::vec3& b) {
    const auto key = [](const glm::vec3& v) {
      return std::array{std::lround(v.x * 500), std::lround(v.y * 500), std::lround(v.z * 500)};
    };
    return key(a) < key(b);
  };
  std::ranges::sort(ours, before);
  std::ranges::sort(theirs, before);
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < ours.size(); ++i)
    sum += glm::abs(ours[i] - theirs[i]);
  EXPECT_LT(glm::length(sum) / static_cast<float>(ours.size()), 2e-3F);
}

}  // namespace
}  // namespace psygen::gltf
