#include "engine/scene/objects/object_type.hpp"

#include <algorithm>
#include <cstring>

namespace psygen::scene {
namespace {

constexpr int kMostLevels = 8;
constexpr std::array kSchema{models::ParameterSpec{
    "mesh", models::ParameterType::kInteger, "", 0, 0, ObjectSources::kMost - 1.0, 0,
    ObjectSources::kMost - 1.0, "number of the mesh", models::ParameterSource::kPlaced}};

class ObjectType final : public models::ModelType {
 public:
  ObjectType(std::shared_ptr<const ObjectSources> sources, bool copied)
      : sources_(std::move(sources)), copied_(copied) {}

  std::string_view name() const override { return copied_ ? "object_mesh" : "object_model"; }
  std::string_view doc() const override { return "a mesh of an object of the game"; }
  std::span<const models::ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return kMostLevels; }
  int level_count_of(const models::Parameters& p) const override { return of(p).level_count; }
  double level_error_m(const models::Parameters& p, int level) const override {
    const ObjectSource& source = of(p);
    return source.type == nullptr
               ? copied(source, level).error_m
               : source.type->level_error_m(source.parameters, source.first_level + level);
  }
  core::Bounds bounds(const models::Parameters& p) const override { return of(p).box; }

  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    const ObjectSource& source = of(p);
    models::MeshSize size;
    if (source.type != nullptr) {
      size = source.type->mesh_size(source.parameters, source.first_level + level);
    } else {
      const PackedMesh& mesh = copied(source, level).mesh;
      size.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
      size.index_count = static_cast<std::uint32_t>(mesh.indices.size());
    }
    size.shared_indices = 0;
    size.layout = core::VertexLayout::kObject;
    return size;
  }

  double complexity(const models::Parameters& p, int level) const override {
    const ObjectSource& source = of(p);
    return source.type == nullptr
               ? static_cast<double>(copied(source, level).mesh.vertices.size())
               : source.type->complexity(source.parameters, source.first_level + level);
  }
  double steps(const models::Parameters& p, int level) const override {
    const ObjectSource& source = of(p);
    return source.type == nullptr
               ? static_cast<double>(copied(source, level).mesh.vertices.size())
               : source.type->steps(source.parameters, source.first_level + level);
  }
  double step_seconds() const override { return copied_ ? 5e-9 : 20e-9; }
  double log2_cost(const models::Parameters&) const override { return 0; }
  bool is_seen_from_far() const override { return false; }
  bool may_run_on_main_thread() const override { return copied_; }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}

  core::Bounds synthesize(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    const ObjectSource& source = of(p);
    if (source.type != nullptr) return widen(source, source.first_level + level, out);
    const PackedMesh& mesh = copied(source, level).mesh;
    std::memcpy(out.vertices.data(), mesh.vertices.data(), out.vertices.size());
    std::ranges::copy(mesh.indices, out.indices.begin());
    return source.box;
  }

 private:
  static const ObjectLevel& copied(const ObjectSource& source, int level) {
    static const ObjectLevel none;
    const auto number = static_cast<std::size_t>(level);
    return number < source.copied.size() ? source.copied[number] : none;
  }

  const ObjectSource& of(const models::Parameters& p) const {
    // Parameters of other code may name a mesh that there is not: it has no vertices.
    static const ObjectSource none;
    const auto index = static_cast<std::uint32_t>(p.integer(0));
    return index < sources_->count() ? (*sources_)[index] : none;
  }

  static core::Bounds widen(const ObjectSource& source, int level, const models::MeshView& out) {
    const models::MeshSize size = source.type->mesh_size(source.parameters, level);
    std::vector<core::ModelVertex> narrow(size.vertex_count);
    const bool shared = size.shared_indices != 0;
    const core::Bounds tight =
        source.type->synthesize(source.parameters, level,
                                {std::as_writable_bytes(std::span(narrow)),
                                 shared ? std::span<std::uint16_t>() : out.indices});
    if (shared) source.type->write_shared_indices(size.shared_indices, out.indices);
    std::byte* to = out.vertices.data();
    for (const core::ModelVertex& vertex : narrow) {
      const core::ObjectVertex wide{vertex, {0.0F, 0.0F}};
      std::memcpy(to, &wide, sizeof(wide));
      to += sizeof(wide);
    }
    return tight;
  }

  std::shared_ptr<const ObjectSources> sources_;
  bool copied_;
};

}  // namespace

std::uint32_t ObjectSources::add(ObjectSource source) {
  const std::uint32_t index = count_;
  if (index == kMost) return kMost;
  std::unique_ptr<Chunk>& chunk = chunks_[index / kChunk];
  if (!chunk) chunk = std::make_unique<Chunk>();
  chunk->at(index % kChunk) = std::make_unique<const ObjectSource>(std::move(source));
  count_ = index + 1;
  return index;
}

std::unique_ptr<models::ModelType> make_object_type(std::shared_ptr<const ObjectSources> sources,
                                                    bool copied) {
  return std::make_unique<ObjectType>(std::move(sources), copied);
}

models::Parameters object_parameters(std::uint32_t index) {
  models::Parameters p;
  p.set_integer(0, index);
  return p;
}

}  // namespace psygen::scene
