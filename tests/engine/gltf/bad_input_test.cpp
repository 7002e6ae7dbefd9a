// Files that are damaged or state false sizes. Each is rejected with one printable message that
// begins with its path, without an allocation of the stated size.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/core/utf8.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/image/image_io.hpp"
#include "tests/engine/gltf/sample.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::gltf {
namespace {

using core::ErrorCode;
using testing::HasSubstr;

class BadGltf : public testing::Test {
 protected:
  core::Result<Model> read(std::string_view bytes, const Limits& limits = {}) {
    write_bytes(file_, bytes);
    auto model = read_file(file_, limits);
    if (model) return model;
    const std::string& message = model.error().message;
    EXPECT_TRUE(message.starts_with(file_.string() + ": ")) << message;
    EXPECT_EQ(core::shown(message), message) << "can be printed";
    EXPECT_LT(message.size(), file_.string().size() + 700) << message;
    return model;
  }
  void refuse(const Sample& sample, const char* sentence, ErrorCode code = ErrorCode::kParse,
              const Limits& limits = {}) {
    refuse_bytes(sample.glb(), sentence, code, limits);
  }
  void refuse_bytes(std::string_view bytes, const char* sentence,
                    ErrorCode code = ErrorCode::kParse, const Limits& limits = {}) {
    const auto model = read(bytes, limits);
    ASSERT_FALSE(model) << sentence;
    EXPECT_THAT(model.error().message, HasSubstr(sentence));
    EXPECT_EQ(model.error().code, code) << model.error().message;
  }
  // The accessor of an attribute of the only primitive.
  static nlohmann::json& accessor_of(Sample& sample, const char* attribute) {
    const auto& attributes = sample.json["meshes"][0]["primitives"][0]["attributes"];
    return sample.json["accessors"][attributes[attribute].get<std::size_t>()];
  }
  static nlohmann::json& primitive_of(Sample& sample) {
    return sample.json["meshes"][0]["primitives"][0];
  }
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "a.glb";
};

// Three times the count is 2 in 64 bits.
TEST_F(BadGltf, AStripOfSoManyIndicesThatTheirTrianglesOverflowIsRejected) {
  Sample sample = square();
  nlohmann::json& primitive = primitive_of(sample);
  primitive["mode"] = 5;
  nlohmann::json& indices = sample.json["accessors"][primitive["indices"].get<std::size_t>()];
  indices.erase("bufferView");
  indices["count"] = UINT64_MAX / 3 + 1;
  refuse(sample, "has more than 12582912 indices, the limit", ErrorCode::kOverBudget);
}

TEST_F(BadGltf, CutAtAnyByteIsRejected) {
  const std::string whole = square().glb();
  ASSERT_TRUE(read(whole));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read(std::string_view(whole).substr(0, size))) << size << " bytes";
  write_bytes(folder_ / "a.bin", square().binary);
  const std::string text = square().text("a.bin");
  ASSERT_TRUE(read(text));
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_FALSE(read(std::string_view(text).substr(0, size))) << size << " bytes";
}

TEST_F(BadGltf, WithAnyByteChangedIsReadOrRejectedWithAMessage) {
  const std::string whole = square().glb();
  std::mt19937 random(1);
  int taken = 0, refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
    ++(read(changed) ? taken : refused);
  }
  EXPECT_GT(taken, 50);
  EXPECT_GT(refused, 200);
}

TEST_F(BadGltf, OfOtherKindsIsRejected) {
  refuse_bytes("", "the file is empty");
  const std::string whole = square().glb();
  refuse_bytes(whole.substr(0, whole.size() - 1), "the file is cut short: ");
  refuse_bytes("hello, world", "not glTF");
  refuse_bytes("[1, 2, 3]", "not glTF");
  Sample sample = square();
  sample.json["asset"]["version"] = "1.0";
  sample.json["scene"] = "the names of version 1";
  refuse(sample, "version \"1.0\"");
  sample = square();
  sample.json["scenes"][0]["nodes"] = nlohmann::json::array();
  refuse(sample, "no triangles");
  EXPECT_FALSE(read_file(folder_ / "missing.glb"));
  EXPECT_FALSE(read_file(folder_.path()));
  EXPECT_FALSE(read_file("/dev/zero"));
}

TEST_F(BadGltf, WhoseJsonIsABombIsRejectedBeforeItIsParsed) {
  const std::string head = R"({"asset":{"version":"2.0"},"extras":)";
  refuse_bytes(head + std::string(1'000'000, '['), "nested", ErrorCode::kOverBudget);
  std::string wide = head + "[0";
  for (int i = 0; i < 1'100'000; ++i)
    wide += ",0";
  refuse_bytes(wide + "]}", "values", ErrorCode::kOverBudget);
}

TEST_F(BadGltf, LargerThanTheLimitsIsRejectedBeforeAnythingIsAllocated) {
  const Sample sample = square();
  Limits limits;
  limits.bytes = 100;
  refuse(sample, "at most 100", ErrorCode::kOverBudget, limits);
  limits = {};
  limits.vertices = 3;
  refuse(sample, "more than 3 vertices", ErrorCode::kOverBudget, limits);
  limits = {};
  limits.indices = 5;
  refuse(sample, "more than 5 indices", ErrorCode::kOverBudget, limits);
  limits = {};
  limits.keys = 4;
  refuse(sample, "more than 4 keys", ErrorCode::kOverBudget, limits);
  limits = {};
  limits.nodes = 0;
  refuse(sample, "more than 0 nodes", ErrorCode::kOverBudget, limits);
  // Many small items that refer to one large item.
  Sample many = square();
  for (int i = 0; i < 20'000; ++i)
    many.json["meshes"][0]["primitives"].push_back(nlohmann::json(primitive_of(many)));
  limits = {};
  limits.vertices = 50'000;
  refuse(many, "more than 50000 vertices", ErrorCode::kOverBudget, limits);
}

TEST_F(BadGltf, WithAccessorsOutOfTheirBufferIsRejected) {
  for (const std::uint64_t count :
       {std::uint64_t{5}, std::uint64_t{1} << 31, std::uint64_t{1} << 32, UINT64_MAX}) {
    Sample sample = square();
    accessor_of(sample, "POSITION")["count"] = count;
    refuse(sample, "POSITION of meshes[0].primitives[0]) has");
  }
  for (const std::uint64_t offset : {std::uint64_t{4}, std::uint64_t{1} << 31, UINT64_MAX}) {
    Sample sample = square();
    accessor_of(sample, "NORMAL")["byteOffset"] = offset;
    refuse(sample, "NORMAL of meshes[0].primitives[0]) has");
    sample = square();
    sample.json["bufferViews"][0]["byteLength"] = offset == 4 ? 10'000 : offset;
    refuse(sample, "bufferViews[0] has");
    sample = square();
    sample.json["bufferViews"][0]["byteOffset"] = offset == 4 ? 10'000 : offset;
    refuse(sample, "bufferViews[0] has");
  }
  Sample sample = square();
  accessor_of(sample, "POSITION")["bufferView"] = 99;
  refuse(sample, "bufferView of accessors[0]");
  sample = square();
  sample.json["bufferViews"][0]["buffer"] = -3;
  refuse(sample, "buffer of bufferViews[0] is -3");
  sample = square();
  sample.json["bufferViews"][0]["byteStride"] = 4;
  refuse(sample, "every 4");
  sample = square();
  primitive_of(sample)["attributes"]["POSITION"] = 77;
  refuse(sample, "POSITION of meshes[0].primitives[0] is 77");
  sample = square();
  accessor_of(sample, "POSITION")["componentType"] = 5130;
  refuse(sample, "component type 5130");
  sample = square();
  accessor_of(sample, "POSITION")["type"] = "VEC2";
  refuse(sample, "2 components");
  sample = square();
  accessor_of(sample, "NORMAL")["count"] = 3;
  refuse(sample, "3 elements for 4 vertices");
}

TEST_F(BadGltf, WithIndicesOutOfRangeIsRejected) {
  Sample sample = square();
  primitive_of(sample)["indices"] =
      sample.accessor(std::vector<std::uint32_t>{0, 1, 4'000'000'000U}, "SCALAR", kInts);
  refuse(sample, "indices[2] of a mesh is 4000000000");
  sample = square();
  primitive_of(sample)["indices"] = sample.accessor(std::vector<float>{0, 1, 2}, "SCALAR", kFloats);
  refuse(sample, "not unsigned integers");
  sample = square();
  primitive_of(sample)["indices"] =
      sample.accessor(std::vector<std::uint8_t>{0, 1, 2, 3}, "SCALAR", kBytes);
  refuse(sample, "three make a triangle");
  for (const auto& [what, sentence] :
       {std::pair{"/meshes/0/primitives/0/material", "primitives[0].material is 9"},
        {"/nodes/0/mesh", "nodes[0].mesh is 9"},
        {"/scenes/0/nodes/0", "a node of scenes[0] is 9"},
        {"/scene", "scene is 9"},
        {"/animations/0/channels/0/sampler", "channels[0].sampler is 9"},
        {"/animations/0/channels/0/target/node", "channels[0].node is 9"},
        {"/animations/0/samplers/0/output", "samplers[0].output is 9"},
        {"/meshes/0/primitives/0/mode", "has the mode 9"}}) {
    sample = square();
    sample.json[nlohmann::json::json_pointer(what)] = 9;
    refuse(sample, sentence);
  }
  sample = square();
  sample.json["materials"][0]["normalTexture"]["index"] = 2;
  refuse(sample, "materials[0].normalTexture is 2");
}

TEST_F(BadGltf, WithNonFiniteNumbersIsRejected) {
  for (const float bad : {NAN, INFINITY, -1e6F}) {
    Sample sample = square();
    std::memcpy(sample.binary.data() + 4, &bad, sizeof bad);
    refuse(sample, "positions[0] of a mesh is");
  }
  Sample sample = square();
  sample.json["nodes"][0]["translation"] = {1e30, 0, 0};
  refuse(sample, "nodes[0].translation has");
  sample = square();
  sample.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  refuse(sample, "nodes[0].rotation is zero");
  sample = square();
  sample.json["nodes"][0]["scale"] = {1, 1};
  refuse(sample, "nodes[0].scale has 2 numbers");
  sample = square();
  sample.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  refuse(sample, "nodes[0].matrix is skewed");
  sample = square();
  sample.json["materials"][0]["emissiveFactor"] = {-1, 0, 0};
  refuse(sample, "materials[0].emissiveFactor is -1");
  sample = square();
  const int times = sample.accessor(std::vector<float>{0, 2, 1}, "SCALAR", kFloats);
  sample.json["animations"][0]["samplers"][0]["input"] = times;
  refuse(sample, "animations[0].samplers[0].input: time 2");
  sample = square();
  sample.json["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
  refuse(sample, "9 of 3 are needed");
}

TEST_F(BadGltf, WhoseNodesFormACycleOrHaveTwoParentsIsRejected) {
  Sample sample = square();
  sample.json["nodes"] = parsed(R"([{"mesh": 0}, {"children": [2]}, {"children": [1]}])");
  refuse(sample, "cycle");
  sample.json["nodes"] = parsed(R"([{"mesh": 0, "children": [0]}])");
  refuse(sample, "cycle");
  sample.json["nodes"] = parsed(R"([{"mesh": 0}, {"children": [0]}, {"children": [0]}])");
  refuse(sample, "nodes[0] is a child of");
  sample.json["nodes"] = parsed(R"([{"mesh": 0, "children": [7]}])");
  refuse(sample, "a child of nodes[0] is 7");
}

TEST_F(BadGltf, OfADepthOf100000IsRejectedOrReadWithoutRecursion) {
  constexpr int kDepth = 100'000;
  Sample sample = square();
  std::string nodes = R"([{"mesh": 0})";
  for (int i = 1; i < kDepth; ++i)
    nodes += fmt::format(R"(,{{"children":[{}]}})", i - 1);
  sample.json["nodes"] = parsed(nodes + "]");
  sample.json["scenes"][0]["nodes"][0] = kDepth - 1;
  refuse(sample, "more than 65536 nodes", ErrorCode::kOverBudget);
  Limits limits;
  limits.nodes = kDepth;
  const auto model = read(sample.glb(), limits);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->nodes.size(), std::size_t{kDepth});
}

TEST_F(BadGltf, ThatRequiresUnsupportedFeaturesIsRejected) {
  Sample sample = square();
  sample.json["extensionsRequired"][0] = "KHR_texture_basisu";
  refuse(sample, "KHR_texture_basisu", ErrorCode::kInvalidArgument);
  sample = square();
  sample.json["asset"]["minVersion"] = "2.1";
  refuse(sample, "version \"2.1\"");
}

TEST_F(BadGltf, ThatNamesFilesOutsideOfItsFolderIsRejected) {
  std::filesystem::create_directories(folder_ / "inside");
  file_ = folder_ / "inside/a.gltf";
  const Sample sample = square();
  write_bytes(folder_ / "secret.bin", sample.binary);
  std::filesystem::create_symlink(folder_ / "secret.bin", folder_ / "inside/link.bin");
  std::filesystem::create_symlink(folder_.path(), folder_ / "inside/up");
  for (const std::string& name :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("link.bin"),
        std::string("up/secret.bin"), (folder_ / "secret.bin").string(),
        std::string("file:///etc/passwd"), std::string("x/../../secret.bin")})
    refuse_bytes(sample.text(name), "only files in its own folder", ErrorCode::kInvalidArgument);
  write_bytes(folder_ / "inside/own.bin", sample.binary);
  std::filesystem::create_symlink("own.bin", folder_ / "inside/near.bin");
  EXPECT_TRUE(read(sample.text("near.bin"))) << "a link within the folder";
}

TEST_F(BadGltf, WithoutItsBufferOrPictureIsRejected) {
  Sample sample = square();
  refuse_bytes(sample.text("missing.bin"), "missing.bin", ErrorCode::kIo);
  refuse_bytes(sample.text(), "no uri");
  write_bytes(folder_ / "short.bin", "abc");
  refuse_bytes(sample.text("short.bin"), "short.bin");
  sample.json["textures"][0]["source"] = 0;
  sample.json["materials"][0]["normalTexture"]["index"] = 0;
  write_bytes(folder_ / "text.png", "no picture");
  sample.json["images"][0]["uri"] = "text.png";
  refuse(sample, "images[0]: is not a PNG or JPEG image");
  sample.json["images"][0] = {{"bufferView", 99}, {"mimeType", "image/png"}};
  EXPECT_FALSE(read(sample.glb()));
  sample.json["textures"][0]["source"] = -2;
  refuse(sample, "source of textures[0] is -2");
  sample.json["textures"][0]["source"] = 0;
  sample.json["images"][0] = nlohmann::json::object();
  refuse(sample, "images[0] has neither");
}

TEST_F(BadGltf, WithTexturesOfAbsurdSizeIsRejected) {
  // The header of an image of 65,536 x 65,536 pixels.
  std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\1\0\0\0\1\0\0\x08\6\0\0\0....", 33);
  Sample sample = square();
  const int view = sample.view(png);
  sample.json["images"][0] = {{"bufferView", view}, {"mimeType", "image/png"}};
  sample.json["textures"][0]["source"] = 0;
  sample.json["materials"][0]["emissiveTexture"]["index"] = 0;
  refuse(sample, "images[0]: the image is 65536 x 65536", ErrorCode::kOverBudget);
  ASSERT_TRUE(image::write_png(folder_ / "b.png", image::make_image(64, 64)));
  sample.json["images"][0] = nlohmann::json::object({{"uri", "b.png"}});
  Limits limits;
  limits.pixel_bytes = 1000;
  refuse(sample, "more than 1000 bytes of pixels", ErrorCode::kOverBudget, limits);
}

}  // namespace
}  // namespace psygen::gltf
