#include "engine/exchange/write_document.hpp"

#include <glm/common.hpp>

#include "tests/engine/exchange/read_back.hpp"
#include "tests/engine/exchange/synthesised.hpp"
#include "tests/full_disk.hpp"

namespace psygen::exchange {
namespace {

Document grove() {
  Document document{"grove",
                    {synthesised("terrain", 0), synthesised("tree", 0), synthesised("rock", 0),
                     synthesised("tree", 3)}};
  document.objects[1].position = {10, 20.5F, 30};
  document.objects[2].position = {-5, 1, 2};
  return document;
}

TEST(WriteDocument, AGlbReadByAnotherLibraryHasTheSameCounts) {
  const TemporaryFolder folder;
  const Document document = grove();
  ASSERT_TRUE(write_scene(folder / "grove.glb", Format::kGlb, document));
  EXPECT_EQ(folder.file_count(), 1u);
  const ReadBack back(folder / "grove.glb");
  ASSERT_NE(back.scene(), nullptr) << back.error();
  const Counts counts = counts_of(*back.scene());
  EXPECT_EQ(counts.vertices, document.vertex_count());
  EXPECT_EQ(counts.triangles, document.triangle_count());
  EXPECT_GT(counts.triangles, 10'000u);
  // Objects are nodes; bark, leaves and ground are materials (a reader may add its own).
  EXPECT_EQ(back.scene()->mRootNode->mNumChildren, 4u);
  EXPECT_GE(back.scene()->mNumMaterials, 3u);
}

TEST(WriteDocument, AGlbKeepsPlacesNormalsAndColours) {
  const TemporaryFolder folder;
  const Document document{"rock", {synthesised("rock", 0)}};
  ASSERT_TRUE(write_scene(folder / "rock.glb", Format::kGlb, document));
  const ReadBack back(folder / "rock.glb");
  ASSERT_NE(back.scene(), nullptr) << back.error();
  const aiMesh& mesh = *back.scene()->mMeshes[0];
  const Part& part = document.objects[0].parts[0];
  ASSERT_EQ(mesh.mNumVertices, part.positions.size());
  ASSERT_TRUE(mesh.HasNormals());
  ASSERT_TRUE(mesh.HasVertexColors(0));
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D p = mesh.mVertices[i], n = mesh.mNormals[i];
    EXPECT_EQ(glm::vec3(p.x, p.y, p.z), part.positions[i]);
    EXPECT_EQ(glm::vec3(n.x, n.y, n.z), part.normals[i]);
    const aiColor4D c = mesh.mColors[0][i];
    EXPECT_NEAR(c.r, part.colours[i].x, 1e-4F);
    EXPECT_NEAR(c.g, part.colours[i].y, 1e-4F);
    EXPECT_NEAR(c.b, part.colours[i].z, 1e-4F);
  }
}

TEST(WriteDocument, AnObjReadByAnotherLibraryHasTheSameTrianglesPlacesAndMaterials) {
  const TemporaryFolder folder;
  const Document document = grove();
  ASSERT_TRUE(write_scene(folder / "grove.obj", Format::kObj, document));
  EXPECT_EQ(folder.file_count(), 3u);  // with .mtl and .png
  const ReadBack back(folder / "grove.obj");
  ASSERT_NE(back.scene(), nullptr) << back.error();
  EXPECT_EQ(counts_of(*back.scene()).triangles, document.triangle_count());
  glm::vec3 low(1e9F), high(-1e9F), expected_low(1e9F), expected_high(-1e9F);
  std::set<std::string> names;
  for (unsigned i = 0; i < back.scene()->mNumMeshes; ++i) {
    const aiMesh& mesh = *back.scene()->mMeshes[i];
    EXPECT_TRUE(mesh.HasVertexColors(0));
    names.insert(back.scene()->mMaterials[mesh.mMaterialIndex]->GetName().C_Str());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = mesh.mVertices[v];
      low = glm::min(low, glm::vec3(p.x, p.y, p.z));
      high = glm::max(high, glm::vec3(p.x, p.y, p.z));
    }
  }
  for (const Object& object : document.objects) {
    for (const Part& part : object.parts) {
      for (const glm::vec3& p : part.positions) {
        expected_low = glm::min(expected_low, p + object.position);
        expected_high = glm::max(expected_high, p + object.position);
      }
    }
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(low[k], expected_low[k], 1e-4F);
    EXPECT_NEAR(high[k], expected_high[k], 1e-4F);
  }
  EXPECT_EQ(names, (std::set<std::string>{"ground", "leaf", "solid"}));
}

TEST(WriteDocument, NamesWithLineBreaksStayOneLineOfAnObj) {
  const TemporaryFolder folder;
  Document document = grove();
  document.name = "a\nf 1 2 3";
  document.objects[0].name = "b\nmtllib c";
  ASSERT_TRUE(write_scene(folder / "two\nlines.obj", Format::kObj, document));
  std::ifstream file(folder / "two\nlines.obj");
  std::string line;
  std::getline(file, line);
  EXPECT_TRUE(line.starts_with("# a\\nf 1 2 3: metres")) << line;
  std::getline(file, line);
  EXPECT_EQ(line, "mtllib two\\nlines.mtl");
  EXPECT_TRUE(std::filesystem::exists(folder / "two\\nlines.mtl"));
  EXPECT_TRUE(std::filesystem::exists(folder / "two\\nlines.colours.png"));
}

TEST(WriteDocument, AnObjHasOneLineForEveryVertexAndTriangle) {
  const Document document = grove();
  const auto text = obj_files(document, obj_names("a.obj"));
  ASSERT_TRUE(text);
  const auto lines = [&text](const std::string& start) {
    std::uint64_t count = 0;
    for (std::size_t at = 0; (at = text->obj.find("\n" + start + " ", at)) != std::string::npos;
         ++at)
      ++count;
    return count;
  };
  EXPECT_EQ(lines("v"), document.vertex_count());
  EXPECT_EQ(lines("vn"), document.vertex_count());
  EXPECT_EQ(lines("f"), document.triangle_count());
  EXPECT_EQ(lines("o"), 4u);
  EXPECT_NE(text->mtl.find("newmtl leaf"), std::string::npos);
}

TEST(WriteDocument, AnEmptyDocumentIsAFileThatOthersRead) {
  const auto bytes = glb_bytes({"nothing", {}});
  ASSERT_TRUE(bytes);
  EXPECT_GT(bytes->size(), 20u);
  EXPECT_EQ(std::string(bytes->begin(), bytes->begin() + 4), "glTF");
}

TEST(WriteDocument, MeshesBeyond16BitIndicesAreWrittenWhole) {
  Part part;
  for (std::uint32_t i = 0; i < 70'000; ++i) {
    part.positions.emplace_back(static_cast<float>(i), 0.0F, static_cast<float>(i % 7));
    part.normals.emplace_back(0, 1, 0);
    part.colours.emplace_back(0.5F);
  }
  for (std::uint32_t i = 0; i + 2 < 70'000; ++i)
    part.indices.insert(part.indices.end(), {i, i + 1, i + 2});
  const TemporaryFolder folder;
  ASSERT_TRUE(write_scene(folder / "a.glb", Format::kGlb, {"long", {{"long", {}, {part}}}}));
  const ReadBack back(folder / "a.glb");
  ASSERT_NE(back.scene(), nullptr) << back.error();
  EXPECT_EQ(counts_of(*back.scene()).triangles, 69'998u);
  const aiFace& last = back.scene()->mMeshes[0]->mFaces[69'997];
  EXPECT_EQ(last.mIndices[2], 69'999u);
}

TEST(WriteDocument, AFolderThatDoesNotExistIsNamed) {
  const auto written = write_scene("/nonexistent/a.glb", Format::kGlb, grove());
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/nonexistent/a.glb"), std::string::npos);
}

TEST(WriteDocument, OnAFullDiskEachFileIsWholeOrMissing) {
  const Document document{"rock", {synthesised("rock", 0)}};
  for (const Format format : {Format::kGlb, Format::kObj}) {
    expect_whole_files([&](const auto& folder) {
      return write_scene(folder / (format == Format::kGlb ? "a.glb" : "a.obj"), format, document);
    });
  }
}

TEST(WriteDocument, AnObjThatDoesNotFitKeepsTheOldMaterials) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_scene(folder / "a.obj", Format::kObj, {"rock", {synthesised("rock", 0)}}));
  const FileContents before = contents_of(folder.path());
  constexpr std::size_t kFirstFile = 6;  // three files are made, one is written, flushed and closed
  const FullDisk full(folder.path(), kFirstFile);
  EXPECT_FALSE(write_scene(folder / "a.obj", Format::kObj, {"tree", {synthesised("tree", 0)}}));
  EXPECT_EQ(contents_of(folder.path()), before);
}

}  // namespace
}  // namespace psygen::exchange
