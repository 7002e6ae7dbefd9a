// What exporters write beyond the plainest files: each is read with its values, or left out with a
// note that names it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/gltf/read_file.hpp"
#include "engine/image/image_io.hpp"
#include "tests/engine/gltf/sample.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::gltf {
namespace {

using core::MeshData;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Features : public testing::Test {
 protected:
  core::Result<Model> result(const Sample& sample) {
    write_bytes(folder_ / "a.glb", sample.glb());
    return read_file(folder_ / "a.glb");
  }
  Model read(const Sample& sample) {
    auto model = result(sample);
    EXPECT_TRUE(model) << model.error().message;
    return model ? std::move(*model) : Model{};
  }
  std::string error_of(const Sample& sample) {
    const auto model = result(sample);
    return model ? "it was read" : model.error().message;
  }
  MeshData mesh(const Sample& sample) {
    const Model model = read(sample);
    const bool has_mesh = !model.meshes.empty() && !model.meshes[0].primitives.empty();
    return has_mesh ? model.meshes[0].primitives[0].mesh : MeshData{};
  }
  // The square with an image as its base colour.
  Sample textured() {
    EXPECT_TRUE(image::write_png(folder_ / "wood.png", image::make_image(4, 2, 9, 8, 7, 255)));
    Sample sample = square();
    sample.json["images"][0]["uri"] = "wood.png";
    sample.json["textures"][0]["source"] = 0;
    base_of(sample)["index"] = 0;
    return sample;
  }
  static nlohmann::json& base_of(Sample& sample) {
    return sample.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  }
  static nlohmann::json& accessor_of(Sample& sample, const char* attribute) {
    const auto& attributes = sample.json["meshes"][0]["primitives"][0]["attributes"];
    return sample.json["accessors"][attributes[attribute].get<std::size_t>()];
  }
  TemporaryFolder folder_;
};

void expect_near(const std::vector<glm::vec2>& values, const std::vector<glm::vec2>& wanted) {
  ASSERT_EQ(values.size(), wanted.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_LT(glm::length(values[i] - wanted[i]), 1e-6F) << i;
}

TEST_F(Features, TextureTransformsScaleThenTurnThenMoveCoordinates) {
  Sample sample = textured();
  sample.json["extensionsUsed"][0] = sample.json["extensionsRequired"][0] = "KHR_texture_transform";
  nlohmann::json& transform = base_of(sample)["extensions"]["KHR_texture_transform"];
  transform = {{"offset", {0.25, 0.5}}, {"scale", {2, 0.5}}};
  // The square has (0, 1), (1, 1), (1, 0), (0, 0).
  expect_near(mesh(sample).uvs, {{0.25F, 1}, {2.25F, 1}, {2.25F, 0.5F}, {0.25F, 0.5F}});
  transform["rotation"] = std::numbers::pi / 2;  // (1, 0) goes to (0, -1): upwards
  expect_near(mesh(sample).uvs, {{0.75F, 0.5F}, {0.75F, -1.5F}, {0.25F, -1.5F}, {0.25F, 0.5F}});
  EXPECT_THAT(read(sample).notes, IsEmpty());
}

TEST_F(Features, TextureTransformsOfOneMaterialMayChooseOtherCoordinates) {
  Sample sample = textured();
  const int other = sample.accessor(
      std::vector<std::array<std::uint16_t, 2>>{{0, 0}, {65535, 0}, {0, 65535}, {13107, 26214}},
      "VEC2", kShorts);
  sample.json["accessors"][static_cast<std::size_t>(other)]["normalized"] = true;
  sample.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = other;
  base_of(sample)["extensions"]["KHR_texture_transform"] = {{"texCoord", 1}, {"scale", {0.5, 1}}};
  expect_near(mesh(sample).uvs, {{0, 0}, {0.5F, 0}, {0, 1}, {0.1F, 0.4F}});
  EXPECT_THAT(read(sample).notes, IsEmpty());
  sample.json["materials"][0]["normalTexture"]["index"] = 0;
  EXPECT_THAT(read(sample).notes, ElementsAre(HasSubstr("different coordinates")));
  expect_near(mesh(sample).uvs, {{0, 0}, {0.5F, 0}, {0, 1}, {0.1F, 0.4F}});
}

TEST_F(Features, IdentityTextureTransformsChangeNothingAndAreNotNoted) {
  Sample sample = textured();
  const MeshData plain = mesh(sample);
  sample.json["extensionsUsed"][0] = "KHR_texture_transform";
  base_of(sample)["extensions"]["KHR_texture_transform"] = {
      {"offset", {0, 0}}, {"rotation", 0}, {"scale", {1, 1}}};
  EXPECT_EQ(mesh(sample).uvs, plain.uvs);
  EXPECT_THAT(read(sample).notes, IsEmpty());
}

TEST_F(Features, TextureTransformsWithoutFiniteNumbersAreRejected) {
  for (const char* text : {R"({"offset": [1e30, 0]})", R"({"scale": [1]})",
                           R"({"rotation": -1e300})", R"({"texCoord": -4})"}) {
    Sample sample = textured();
    base_of(sample)["extensions"]["KHR_texture_transform"] = parsed(text);
    EXPECT_THAT(error_of(sample), HasSubstr("materials[0].baseColorTexture")) << text;
  }
}

TEST_F(Features, TexturesThatDoNotRepeatAreNotedWhereItShows) {
  Sample sample = textured();
  sample.json["textures"][0]["sampler"] = 0;
  for (const int mode : {33071, 33648, 10497}) {
    sample.json["samplers"][0] = {{"wrapT", mode}, {"magFilter", 9728}};
    base_of(sample).erase("extensions");
    EXPECT_THAT(read(sample).notes, IsEmpty()) << "all coordinates are within the image";
    base_of(sample)["extensions"]["KHR_texture_transform"]["scale"] = {1, 2};
    EXPECT_EQ(read(sample).notes.size(), mode == 10497 ? 0u : 1u);
  }
  sample.json["textures"][0]["sampler"] = 7;
  EXPECT_THAT(error_of(sample), HasSubstr("sampler of materials[0].baseColorTexture is 7"));
}

TEST_F(Features, MatricesOfAScaleOfZeroAreRead) {
  Sample sample = square();
  sample.json["animations"].clear();
  sample.json["nodes"][0] = {{"mesh", 0},
                             {"matrix", {0, 0, -2, 0, 0, 0, 0, 0, 3, 0, 0, 0, 4, 5, 6, 1}}};
  const Pose pose = read(sample).nodes[0].rest;
  EXPECT_EQ(pose.scale, glm::vec3(2, 0, 3));
  EXPECT_EQ(pose.translation, glm::vec3(4, 5, 6));
  EXPECT_LT(glm::length(pose.rotation * glm::vec3(1, 0, 0) - glm::vec3(0, 0, -1)), 1e-6F);
  EXPECT_LT(glm::length(pose.rotation * glm::vec3(0, 0, 1) - glm::vec3(1, 0, 0)), 1e-6F);
  sample.json["nodes"][0]["matrix"] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  EXPECT_EQ(read(sample).nodes[0].rest.scale, glm::vec3(0));
}

TEST_F(Features, ChannelsWithoutANodeAreLeftOut) {
  for (const bool is_pointer : {false, true}) {
    Sample sample = square();
    nlohmann::json& animation = sample.json["animations"][0];
    animation["channels"].push_back(nlohmann::json(animation["channels"][0]));
    nlohmann::json& target = animation["channels"][1]["target"];
    target.erase("node");
    if (is_pointer) {
      target["path"] = "pointer";
      target["extensions"]["KHR_animation_pointer"]["pointer"] = "/materials/0/alphaCutoff";
    }
    const Model model = read(sample);
    ASSERT_EQ(model.animations.size(), 1u);
    ASSERT_EQ(model.animations[0].channels.size(), 1u);
    EXPECT_EQ(model.animations[0].channels[0].values[2], glm::vec4(3, 0, 0, 0));
    EXPECT_THAT(model.notes,
                ElementsAre(HasSubstr(is_pointer ? "KHR_animation_pointer" : "without a node")));
  }
}

// Adds a sparse accessor of these elements to the positions of the square.
template <class Index>
void replace_positions(Sample& sample, const std::vector<Index>& indices, int component) {
  const std::vector<glm::vec3> places(indices.size(), glm::vec3(0.5F, 7, 2));
  const auto view = [&](const auto& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return sample.view({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  const int index_view = view(indices), value_view = view(places);
  sample.json["accessors"][0]["sparse"] = {
      {"count", indices.size()},
      {"indices", {{"bufferView", index_view}, {"componentType", component}}},
      {"values", {{"bufferView", value_view}}}};
}

TEST_F(Features, SparseAccessorsReplaceTheirElements) {
  const std::vector<glm::vec3> wanted{{0, 0, 0}, {0.5F, 7, 2}, {1, 1, 0}, {0.5F, 7, 2}};
  Sample bytes = square(), shorts = square(), ints = square();
  replace_positions(bytes, std::vector<std::uint8_t>{1, 3}, kBytes);
  replace_positions(shorts, std::vector<std::uint16_t>{1, 3}, kShorts);
  replace_positions(ints, std::vector<std::uint32_t>{1, 3}, kInts);
  for (const Sample& sample : {bytes, shorts, ints})
    EXPECT_EQ(mesh(sample).positions, wanted);
  bytes.json["accessors"][0].erase("bufferView");
  EXPECT_THAT(mesh(bytes).positions, ElementsAre(glm::vec3(0), wanted[1], glm::vec3(0), wanted[3]));
}

TEST_F(Features, SparseAccessorsOutOfRangeAreRejected) {
  for (const std::vector<std::uint32_t>& indices :
       std::vector<std::vector<std::uint32_t>>{{4}, {UINT32_MAX}, {3, 1}, {2, 2}}) {
    Sample sample = square();
    replace_positions(sample, indices, kInts);
    EXPECT_THAT(error_of(sample),
                AllOf(HasSubstr("accessors[0] (POSITION of meshes[0].primitives[0])"),
                      HasSubstr("must ascend and be below 4")));
  }
  for (const char* text :
       {R"({"count": 1000000000000})", R"({"indices": {"bufferView": 0, "componentType": 5126}})",
        R"({"indices": {"bufferView": 99, "componentType": 5121}})",
        R"({"values": {"bufferView": 99}})",
        R"({"values": {"bufferView": 0, "byteOffset": 47}})"}) {
    Sample sample = square();
    replace_positions(sample, std::vector<std::uint8_t>{1, 3}, kBytes);
    sample.json["accessors"][0]["sparse"].update(parsed(text));
    EXPECT_THAT(error_of(sample), HasSubstr("of accessors[0]")) << text;
  }
}

TEST_F(Features, AccessorsWithoutABufferViewAreZero) {
  Sample sample = square();
  accessor_of(sample, "TEXCOORD_0").erase("bufferView");
  accessor_of(sample, "COLOR_0").erase("bufferView");
  const MeshData read = mesh(sample);
  EXPECT_EQ(read.uvs, std::vector<glm::vec2>(4, glm::vec2(0)));
  EXPECT_EQ(read.colours.size(), 4u);
  EXPECT_EQ(read.positions[2], glm::vec3(1, 1, 0));
  accessor_of(sample, "TEXCOORD_0")["count"] = UINT64_MAX;
  EXPECT_THAT(error_of(sample), HasSubstr("elements for 4 vertices"));
  sample = square();
  accessor_of(sample, "POSITION").erase("bufferView");
  accessor_of(sample, "POSITION")["count"] = UINT64_MAX;
  EXPECT_THAT(error_of(sample), HasSubstr("vertices, the limit"));
}

TEST_F(Features, TexturesWithoutAnImageAreLeftOutWithANote) {
  Sample sample = textured();
  sample.json["textures"][0] = nlohmann::json::object();
  Model model = read(sample);
  EXPECT_EQ(model.materials[0].base_texture, kNone);
  EXPECT_EQ(model.materials[0].base_colour, glm::vec3(0.5F, 0.25F, 0.125F));
  EXPECT_THAT(model.notes, ElementsAre(AllOf(HasSubstr("materials[0] \"red\""),
                                             HasSubstr("textures[0] has no image"))));
  sample.json["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 0;
  model = read(sample);
  EXPECT_EQ(model.materials[0].base_texture, kNone);
  EXPECT_THAT(model.notes, ElementsAre(HasSubstr("KHR_texture_basisu")));
  sample.json["textures"][0]["source"] = 0;
  model = read(sample);
  EXPECT_EQ(model.materials[0].base_texture, 0u) << "the core's image is read";
  EXPECT_THAT(model.notes, IsEmpty());
}

TEST_F(Features, WebpThatCannotBeReadLeavesTheCoresImageOrNone) {
  Sample sample = textured();
  sample.json["extensionsUsed"][0] = "EXT_texture_webp";
  const int view = sample.view(std::string("RIFF \0\0\0WEBPVP8 ", 16) + std::string(20, '\0'));
  sample.json["images"][1] = {{"bufferView", view}, {"mimeType", "image/webp"}};
  sample.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  Model model = read(sample);
  ASSERT_EQ(model.materials[0].base_texture, 0u);
  EXPECT_EQ(*model.images[0], image::make_image(4, 2, 9, 8, 7, 255));
  EXPECT_THAT(model.notes, IsEmpty());
  sample.json["textures"][0].erase("source");
  model = read(sample);
  EXPECT_EQ(model.materials[0].base_texture, kNone);
  EXPECT_THAT(model.notes, ElementsAre(AllOf(HasSubstr("materials[0] \"red\""),
                                             HasSubstr("EXT_texture_webp: images[1]"))));
  EXPECT_THAT(model.images, IsEmpty());
}

// 8 x 4 pixels of one colour, written by libwebp without loss.
constexpr std::string_view kWebp(
    "RIFF\036\0\0\0WEBPVP8L\021\0\0\0/\007\300\0\020\007P\262\"W\246\200\201\210\350\177\0\0", 38);

TEST_F(Features, WebpIsReadInsteadOfTheCoresImage) {
  Sample sample = textured();
  sample.json["extensionsUsed"][0] = sample.json["extensionsRequired"][0] = "EXT_texture_webp";
  const int view = sample.view(kWebp);
  sample.json["images"][1] = {{"bufferView", view}, {"mimeType", "image/webp"}};
  sample.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  const Model model = read(sample);
  ASSERT_EQ(model.images.size(), 1u);
  EXPECT_EQ(model.images[0]->width, 8u);
  EXPECT_NEAR(model.images[0]->rgba[0], 200, 1);
  EXPECT_EQ(model.images[0]->rgba[3], 128);
  EXPECT_THAT(model.notes, IsEmpty());
}

TEST_F(Features, ThousandsOfNotesAreCutOff) {
  Sample sample = textured();
  sample.json["images"][0]["uri"] = "no.png";
  for (int i = 0; i < 3000; ++i)
    sample.json["materials"].push_back(nlohmann::json(sample.json["materials"][0]));
  const Model model = read(sample);
  EXPECT_EQ(model.notes.size(), 64u);
  EXPECT_THAT(model.notes.back(), HasSubstr("not listed"));
  EXPECT_EQ(model.missing.size(), 1u) << "it is looked for once";
}

TEST_F(Features, SpecularGlossinessGivesItsDiffuseColourAndTexture) {
  Sample sample = textured();
  nlohmann::json& material = sample.json["materials"][0];
  material.erase("pbrMetallicRoughness");
  const char* name = "KHR_materials_pbrSpecularGlossiness";
  sample.json["extensionsUsed"][0] = sample.json["extensionsRequired"][0] = name;
  material["extensions"][name] = parsed(R"({"diffuseFactor": [0.125, 0.5, 1, 0.75],
      "diffuseTexture": {"index": 0}, "glossinessFactor": 0.5})");
  const Model model = read(sample);
  EXPECT_EQ(model.materials[0].base_colour, glm::vec3(0.125F, 0.5F, 1));
  EXPECT_EQ(model.materials[0].opacity, 0.75F);
  ASSERT_EQ(model.materials[0].base_texture, 0u);
  EXPECT_EQ(*model.images[0], image::make_image(4, 2, 9, 8, 7, 255));
  EXPECT_THAT(model.notes, ElementsAre(HasSubstr(name)));
}

TEST_F(Features, FilesThatNothingUsesMayBeMissing) {
  Sample sample = textured();
  const Model plain = read(sample);
  sample.json["images"][1]["uri"] = "../no.png";
  sample.json["images"][2]["uri"] = "no.png";
  sample.json["textures"][1]["source"] = 2;
  sample.json["materials"][0]["occlusionTexture"]["index"] = 1;
  sample.json["buffers"] = parsed(R"([{}, {"byteLength": 9, "uri": "no.bin"}])");
  sample.json["buffers"][0]["byteLength"] = sample.binary.size();
  const Model model = read(sample);
  EXPECT_EQ(model.meshes[0].primitives[0].mesh.positions,
            plain.meshes[0].primitives[0].mesh.positions);
  EXPECT_EQ(model.images.size(), 1u);
  EXPECT_THAT(model.notes, ElementsAre(HasSubstr("\"../no.png\", which is missing"),
                                       HasSubstr("\"no.png\", which is missing; nothing uses it"),
                                       HasSubstr("\"no.bin\", which is missing")));
  EXPECT_THAT(model.files, ElementsAre(folder_ / "wood.png"));
  EXPECT_THAT(model.missing, IsEmpty());
}

TEST_F(Features, MaterialsWhoseImageIsMissingAreDrawnWithoutIt) {
  Sample sample = textured();
  sample.json["images"][0]["uri"] = "no.png";
  sample.json["materials"].push_back(nlohmann::json(sample.json["materials"][0]));
  const Model model = read(sample);
  EXPECT_THAT(model.images, IsEmpty());
  EXPECT_EQ(model.materials[0].base_texture, kNone);
  EXPECT_THAT(model.notes,
              ElementsAre(AllOf(HasSubstr("materials[0] \"red\""), HasSubstr("no.png")),
                          HasSubstr("materials[1] \"red\"")));
  EXPECT_THAT(model.missing, testing::Contains(folder_ / "no.png"));
  EXPECT_THAT(model.files, IsEmpty());
}

TEST_F(Features, AnImageThatExistsButCannotBeReadIsAnError) {
  Sample sample = textured();
  sample.json["images"][0]["uri"] = "no.png";
  std::filesystem::create_directory(folder_ / "no.png");
  const auto refused = result(sample);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kIo);
}

TEST_F(Features, NormalsWithoutADirectionComeFromTheTriangles) {
  for (const glm::vec3& bad : {glm::vec3(0), glm::vec3(NAN, 0, 0), glm::vec3(0, INFINITY, 0)}) {
    Sample sample = square();
    const std::vector<glm::vec3> normals{{1, 0, 0}, bad, bad, {0, 1, 0}};
    const int accessor = sample.accessor(normals, "VEC3", kFloats);
    sample.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = accessor;
    EXPECT_THAT(mesh(sample).normals, ElementsAre(glm::vec3(1, 0, 0), glm::vec3(0, 0, 1),
                                                  glm::vec3(0, 0, 1), glm::vec3(0, 1, 0)));
    EXPECT_THAT(read(sample).notes, ElementsAre(HasSubstr("normals")));
  }
}

TEST_F(Features, RequiredExtensionsOfLightAreLeftOutWithANote) {
  Sample sample = square();
  const MeshData plain = mesh(sample);
  sample.json["extensionsUsed"] = sample.json["extensionsRequired"] =
      parsed(R"(["KHR_materials_unlit", "KHR_lights_punctual"])");
  sample.json["materials"][0]["extensions"]["KHR_materials_unlit"] = nlohmann::json::object();
  sample.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "point";
  sample.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const Model model = read(sample);
  EXPECT_EQ(model.meshes[0].primitives[0].mesh.positions, plain.positions);
  EXPECT_THAT(model.notes,
              ElementsAre(HasSubstr("KHR_materials_unlit"), HasSubstr("KHR_lights_punctual")));
}

TEST_F(Features, BuffersAndImagesMayBeInTheJson) {
  Sample sample = square();
  sample.binary = "abc";
  write_bytes(folder_ / "a.gltf", R"({"asset": {"version": "2.0"}, "meshes": [{"primitives": [
      {"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const auto model = read_file(folder_ / "a.gltf");
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_THAT(model->meshes[0].primitives[0].mesh.positions,
              ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  write_bytes(folder_ / "a.gltf",
              R"({"asset": {"version": "2.0"}, "meshes": [{"primitives": [
      {"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "data:text/plain;base64,AA*A"}]})");
  const auto bad = read_file(folder_ / "a.gltf");
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("buffers[0]: its \"data:\" URI is not base64"));
}

TEST_F(Features, ValuesOfAWrongKindAreRejectedWithTheirPlace) {
  for (const auto& [place, sentence] : {std::pair{"/nodes/0/mesh", "nodes[0].mesh must be"},
                                        {"/accessors/0/count", "accessors[0].count must be"},
                                        {"/materials/0/name", "materials[0].name must be"},
                                        {"/scenes", "scenes must be"},
                                        {"/meshes/0/primitives/0", "primitives[0] must be"}}) {
    Sample sample = square();
    sample.json[nlohmann::json::json_pointer(place)] = -0.5;
    EXPECT_THAT(error_of(sample), HasSubstr(sentence));
  }
}

}  // namespace
}  // namespace psygen::gltf
