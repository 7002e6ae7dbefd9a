// Reads a glTF or OBJ file with another library (assimp).
#pragma once

#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdint>
#include <filesystem>
#include <string>

namespace psygen::exchange {

struct Counts {
  std::uint64_t vertices = 0, triangles = 0;
};

inline Counts counts_of(const aiScene& scene) {
  Counts counts;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    counts.vertices += scene.mMeshes[i]->mNumVertices;
    counts.triangles += scene.mMeshes[i]->mNumFaces;
  }
  return counts;
}

// The whole content of the file; the scene is null if it cannot be read.
class ReadBack {
 public:
  explicit ReadBack(const std::filesystem::path& file)
      : scene_(importer_.ReadFile(file.string(), aiProcess_ValidateDataStructure)) {}
  const aiScene* scene() const { return scene_; }
  std::string error() const { return importer_.GetErrorString(); }

 private:
  Assimp::Importer importer_;
  const aiScene* scene_;
};

}  // namespace psygen::exchange
