// Colours of an OBJ as a program without vertex colours shows them: read with another library, and
// sampled from the image with bilinear filtering in linear colours, as graphics APIs do.
#include "engine/exchange/triangle_colours.hpp"

#include <assimp/material.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>
#include <set>
#include <tuple>

#include "engine/exchange/write_document.hpp"
#include "engine/image/image_io.hpp"
#include "tests/engine/exchange/read_back.hpp"
#include "tests/engine/exchange/synthesised.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::exchange {
namespace {

using Colours = std::array<glm::vec3, 3>;

float linear_of_srgb(float value) {
  return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

// The linear colour of an image at texture coordinates from its lower left corner.
class Sampler {
 public:
  explicit Sampler(const image::Image& image) : image_(image) {}
  glm::vec3 at(glm::dvec2 uv) const {
    const glm::dvec2 place(uv.x * image_.width - 0.5, (1.0 - uv.y) * image_.height - 0.5);
    const glm::dvec2 corner = glm::floor(place);
    const glm::vec2 share(place - corner);
    const glm::vec3 upper = glm::mix(texel(corner), texel(corner + glm::dvec2(1, 0)), share.x);
    const glm::vec3 lower =
        glm::mix(texel(corner + glm::dvec2(0, 1)), texel(corner + glm::dvec2(1, 1)), share.x);
    return glm::mix(upper, lower, share.y);
  }

 private:
  glm::vec3 texel(glm::dvec2 place) const {
    const auto x = static_cast<std::uint32_t>(glm::clamp(place.x, 0.0, image_.width - 1.0));
    const auto y = static_cast<std::uint32_t>(glm::clamp(place.y, 0.0, image_.height - 1.0));
    const auto pixel = image_.pixel(x, y);
    return {linear_of_srgb(static_cast<float>(pixel[0]) / 255.0F),
            linear_of_srgb(static_cast<float>(pixel[1]) / 255.0F),
            linear_of_srgb(static_cast<float>(pixel[2]) / 255.0F)};
  }
  const image::Image& image_;
};

// The largest difference of two linear colours in steps of sRGB bytes.
float steps(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 apart = glm::abs(srgb(a) - srgb(b)) * 255.0F;
  return std::max({apart.x, apart.y, apart.z});
}

Document grove() {
  Document document{"grove",
                    {synthesised("terrain", 2), synthesised("tree", 1), synthesised("rock", 1)}};
  document.objects[1].position = {10, 20.5F, 30};
  return document;
}

// The triangles of a part as linear colours.
std::vector<Colours> triangles_of(const Part& part) {
  std::vector<Colours> triangles;
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3)
    triangles.push_back({part.colours[part.indices[i]], part.colours[part.indices[i + 1]],
                         part.colours[part.indices[i + 2]]});
  return triangles;
}

std::vector<Colours> triangles_of(const Document& document) {
  std::vector<Colours> triangles;
  for (const Object& object : document.objects) {
    for (const Part& part : object.parts) {
      const auto more = triangles_of(part);
      triangles.insert(triangles.end(), more.begin(), more.end());
    }
  }
  return triangles;
}

// Expects that a file shows the document's triangles in their colours, at corners and in between.
void expect_shows(const aiScene& scene, const Sampler& sampler,
                  const std::vector<Colours>& expected) {
  std::size_t triangle = 0;
  float worst_corner = 0, worst_centre = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    ASSERT_TRUE(mesh.HasTextureCoords(0));
    for (unsigned f = 0; f < mesh.mNumFaces; ++f, ++triangle) {
      ASSERT_LT(triangle, expected.size());
      const Colours& colours = expected[triangle];
      glm::dvec2 centre(0.0);
      for (std::size_t k = 0; k < 3; ++k) {
        const aiVector3D at = mesh.mTextureCoords[0][mesh.mFaces[f].mIndices[k]];
        centre += glm::dvec2(at.x, at.y) / 3.0;
        worst_corner = std::max(worst_corner, steps(sampler.at({at.x, at.y}), colours[k]));
      }
      const glm::vec3 mean = (colours[0] + colours[1] + colours[2]) / 3.0F;
      worst_centre = std::max(worst_centre, steps(sampler.at(centre), mean));
    }
  }
  EXPECT_EQ(triangle, expected.size());
  EXPECT_LE(worst_corner, 0.6F);  // half a step of rounding
  EXPECT_LE(worst_centre, 1.2F);  // three roundings more
}

TEST(TriangleColours, OfAnObjAreThoseOfTheMeshInAProgramWithoutVertexColours) {
  const TemporaryFolder folder;
  const Document document = grove();
  ASSERT_TRUE(write_scene(folder / "grove.obj", Format::kObj, document));
  const ReadBack back(folder / "grove.obj");
  ASSERT_NE(back.scene(), nullptr) << back.error();
  std::set<std::string> images;
  for (unsigned i = 0; i < back.scene()->mNumMeshes; ++i) {
    const aiMaterial& material =
        *back.scene()->mMaterials[back.scene()->mMeshes[i]->mMaterialIndex];
    aiString name;
    ASSERT_EQ(material.GetTexture(aiTextureType_DIFFUSE, 0, &name), aiReturn_SUCCESS);
    images.insert(name.C_Str());
    aiColor3D white;
    ASSERT_EQ(material.Get(AI_MATKEY_COLOR_DIFFUSE, white), aiReturn_SUCCESS);
    EXPECT_EQ(white, aiColor3D(1, 1, 1));  // programs multiply it with the image
  }
  ASSERT_EQ(images, std::set<std::string>{"grove.colours.png"});
  const auto image = image::read_image(folder / "grove.colours.png");
  ASSERT_TRUE(image) << image.error().message;
  expect_shows(*back.scene(), Sampler(*image), triangles_of(document));
}

TEST(TriangleColours, EqualTrianglesShareABlock) {
  TriangleColours colours;
  const glm::vec3 red(1, 0, 0), green(0, 1, 0), grey(0.5F);
  const auto first = colours.add({red, green, grey});
  const auto turned = colours.add({grey, red, green});
  EXPECT_EQ(colours.block_count(), 1u);
  EXPECT_EQ(turned, (std::array{first[2], first[0], first[1]}));
  const auto plain = colours.add({red, red, red});
  EXPECT_EQ(plain, colours.add({red, red, red}));
  EXPECT_EQ(colours.block_count(), 2u);
}

TEST(TriangleColours, AreLinearBetweenAnyThreeColoursWhoseFourthIsAColour) {
  TriangleColours colours;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> share(0.3F, 0.6F);
  std::vector<std::pair<Colours, std::array<std::uint32_t, 3>>> triangles;
  for (int i = 0; i < 1000; ++i) {
    Colours corners;
    for (glm::vec3& corner : corners)
      corner = {share(random), share(random), share(random)};
    triangles.emplace_back(corners, colours.add(corners));
  }
  const image::Image image = colours.image();
  EXPECT_EQ(image.width, 64u);
  EXPECT_EQ(image.height, 64u);  // 32 × 32 blocks
  const Sampler sampler(image);
  for (const auto& [corners, indices] : triangles) {
    for (const glm::vec3 shares :
         {glm::vec3(1, 0, 0), glm::vec3(0.5F, 0.5F, 0), glm::vec3(0.2F, 0.3F, 0.5F)}) {
      glm::dvec2 uv(0.0);
      glm::vec3 expected(0.0F);
      for (int k = 0; k < 3; ++k) {
        uv += static_cast<double>(shares[k]) *
              colours.coordinates(indices[static_cast<std::size_t>(k)]);
        expected += shares[k] * corners[static_cast<std::size_t>(k)];
      }
      EXPECT_LE(steps(sampler.at(uv), expected), 1.2F);
    }
  }
}

TEST(TriangleColours, NearBlackAndWhiteStayExactAtTheirCorners) {
  TriangleColours colours;
  const Colours corners{glm::vec3(0), glm::vec3(1), glm::vec3(0, 1, 0)};
  const auto indices = colours.add(corners);
  const image::Image image = colours.image();
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(Sampler(image).at(colours.coordinates(indices[k])), corners[k]);
}

TEST(TriangleColours, AreRefusedBeyondTheLargestImage) {
  EXPECT_EQ(kMaxColourBlocks, 16'777'216u);
  TriangleColours colours(2);
  for (const float grey : {0.25F, 0.5F})
    std::ignore = colours.add({glm::vec3(grey), glm::vec3(grey), glm::vec3(0)});
  EXPECT_TRUE(colours.check());
  std::ignore = colours.add({glm::vec3(0), glm::vec3(1), glm::vec3(1)});
  const auto refused = colours.check();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kOverBudget);
  EXPECT_EQ(refused.error().message,
            "an .obj has at most 2 triangles of different colours, not 3; a .glb or a coarser "
            "level has room");
}

}  // namespace
}  // namespace psygen::exchange
