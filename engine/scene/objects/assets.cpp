#include "engine/scene/objects/assets.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace psygen::scene {

using core::ErrorCode;

namespace {

// The owner of meshes that belong to no entity.
constexpr std::uint64_t kNoOwner = ecs::kNullEntity.index;

// The vertices and indices of a mesh, in bytes.
std::uint64_t bytes_of(const PackedMesh& mesh) {
  return mesh.vertices.size() * sizeof(mesh.vertices[0]) +
         mesh.indices.size() * sizeof(mesh.indices[0]);
}

// Those that the host keeps, of all levels.
std::uint64_t bytes_of(const ObjectSource& source) {
  std::uint64_t bytes = 0;
  for (const ObjectLevel& level : source.copied)
    bytes += bytes_of(level.mesh);
  return bytes;
}

}  // namespace

core::Result<void> Assets::open(models::Registry& registry, render::Renderer* renderer,
                                std::uint64_t budget_bytes) {
  budget_bytes_ = budget_bytes;
  sources_ = std::make_shared<ObjectSources>();
  renderer_ = renderer;
  registry_ = &registry;
  return add_types(registry);
}

core::Result<void> Assets::follow(models::Registry& registry) {
  const models::ModelIndex copied = copied_, synthesised = synthesised_;
  if (auto ok = add_types(registry); !ok) return ok;
  if (copied == copied_ && synthesised == synthesised_) return {};
  for (ObjectMesh& mesh : meshes_) {
    for (std::uint32_t i = 0; i < mesh.level_count; ++i) {
      ObjectMeshLevel& level = mesh.levels[i];
      removed_.push_back(level.key);  // the cache may have it under this key
      level.key.model = level.key.model == copied ? copied_ : synthesised_;
      level.handle = {};
      level.ready = level.failed = false;
    }
  }
  return {};
}

core::Result<void> Assets::add_types(models::Registry& registry) {
  const auto copied = registry.add(make_object_type(sources_, true));
  if (!copied) return tl::unexpected(copied.error());
  const auto synthesised = registry.add(make_object_type(sources_, false));
  if (!synthesised) return tl::unexpected(synthesised.error());
  copied_ = *copied;
  synthesised_ = *synthesised;
  return {};
}

core::Result<MeshId> Assets::add(ObjectSource source, models::ModelIndex type) {
  ObjectMesh mesh;
  mesh.box = source.box;
  mesh.level_count = static_cast<std::uint32_t>(source.level_count);
  const std::string name = source.name;
  const std::optional<std::uint32_t> added = sources_->add(std::move(source));
  if (!added) {
    return core::fail(
        ErrorCode::kOverBudget,
        fmt::format("{}: a scene has at most {} meshes of objects", name, ObjectSources::kMax));
  }
  mesh.id = {*added};
  mesh.parameters = object_parameters(*added);
  const models::ModelType& of = (*registry_)[type];
  for (std::uint32_t level = 0; level < mesh.level_count; ++level) {
    mesh.levels[level].key = {{},
                              *added,
                              type,
                              static_cast<std::uint16_t>(level),
                              models::parameters_hash(of, mesh.parameters)};
    mesh.levels[level].error_m =
        static_cast<float>(of.level_error_m(mesh.parameters, static_cast<int>(level)));
  }
  if (slot_of(mesh.id) == meshes_.size()) meshes_.emplace_back();
  meshes_[slot_of(mesh.id)] = mesh;
  ++count_;
  return mesh.id;
}

void Assets::remove_mesh(MeshId id) {
  if (!exists(id)) return;
  ObjectMesh& mesh = meshes_[slot_of(id)];
  for (std::uint32_t level = 0; level < mesh.level_count; ++level)
    removed_.push_back(mesh.levels[level].key);
  mesh = {};
  --count_;
  bytes_ -= bytes_of(*sources_->find(id.index));
  sources_->remove(id.index);
}

core::Result<void> Assets::check_budget(std::string_view name, std::uint64_t bytes) const {
  if (bytes <= budget_bytes_ - bytes_) return {};
  return core::fail(ErrorCode::kOverBudget,
                    fmt::format("{}: with it, the meshes of objects need at least {} bytes; "
                                "SceneSettings::object_budget_bytes allows {}",
                                name, bytes_ + bytes, budget_bytes_));
}

core::Result<MeshId> Assets::add_mesh(const core::MeshData& mesh, std::string name) {
  auto packed = pack(mesh);
  if (!packed)
    return core::fail(packed.error().code, fmt::format("{}: {}", name, packed.error().message));
  if (auto ok = check_budget(name, bytes_of(*packed)); !ok) return tl::unexpected(ok.error());
  ObjectSource source;
  source.name = std::move(name);
  source.box = packed->box;
  source.copied = object_levels(std::move(*packed), ObjectMesh::kMaxLevels);
  source.level_count = static_cast<int>(source.copied.size());
  const std::uint64_t bytes = bytes_of(source);
  if (auto ok = check_budget(source.name, bytes); !ok) return tl::unexpected(ok.error());
  auto added = add(std::move(source), copied_);
  if (added) bytes_ += bytes;
  return added;
}

core::Result<MeshId> Assets::add_model(std::string_view type, const models::Parameters& parameters,
                                       int first_level, int level_count) {
  const int found = registry_->find(type);
  if (found < 0 || found == copied_ || found == synthesised_) {
    return core::invalid_argument(fmt::format("there is no model type \"{}\" for objects", type));
  }
  const models::ModelType& model = (*registry_)[static_cast<models::ModelIndex>(found)];
  if (auto ok = models::validate(model, parameters); !ok) {
    return core::fail(ok.error().code, fmt::format("{}: {}", type, ok.error().message));
  }
  const int there_are = model.level_count_of(parameters);
  if (first_level < 0 || level_count < 0 || first_level + std::max(level_count, 1) > there_are) {
    return core::invalid_argument(
        fmt::format("{}: levels {} to {} are not among its {} levels", type, first_level,
                    first_level + std::max(level_count, 1) - 1, there_are));
  }
  if (model.mesh_size(parameters, first_level).layout != core::VertexLayout::kModel) {
    return core::invalid_argument(fmt::format("{} is ground, which is no mesh of an object", type));
  }
  ObjectSource source;
  source.name = std::string(type);
  source.type = &model;
  source.parameters = parameters;
  source.first_level = first_level;
  const int most = std::min(there_are - first_level, static_cast<int>(ObjectMesh::kMaxLevels));
  source.level_count = level_count == 0 ? most : std::min(level_count, most);
  source.box = model.bounds(parameters);
  return add(std::move(source), synthesised_);
}

core::Result<render::TextureId> Assets::add_texture(const image::Image& picture, bool colours) {
  if (renderer_ == nullptr) return ++textures_;
  return renderer_->add_texture({picture.width, picture.height, picture.rgba, colours});
}

core::Result<render::MaterialId> Assets::add_material(const render::Material& material) {
  if (renderer_ == nullptr) return ++materials_;
  return renderer_->add_material(material);
}

void Assets::want_all(synthesis::MeshSupply& meshes) const {
  using synthesis::Rank;
  using synthesis::RankGroup;
  for (const auto& [id, number] : used) {
    if (!exists(id)) continue;
    const ObjectMesh& mesh = meshes_[slot_of(id)];
    const ObjectMeshLevel& level = mesh.levels[number];
    if (level.ready || level.failed) continue;
    const RankGroup group = level.hole   ? RankGroup::kVisibleHole
                            : level.seen ? RankGroup::kVisibleCoarse
                                         : RankGroup::kPrefetch;
    meshes.want({level.key, &mesh.parameters, kNoOwner,
                 Rank(group, 0, level.hole ? level.hole_m : level.nearest_m), 0.0F, false});
  }
}

void Assets::forget_removed(synthesis::MeshSupply& meshes) {
  for (const synthesis::MeshKey& key : removed_) {
    meshes.forget(meshes.find(key));
    meshes.forget(meshes.find(synthesis::duplicate_of(key)));
  }
  removed_.clear();
}

}  // namespace psygen::scene
