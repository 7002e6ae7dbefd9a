#include "engine/scene/objects/object_type.hpp"

#include <algorithm>
#include <cstring>

namespace psygen::scene {
namespace {

constexpr int kObjectLevels = 8;
constexpr double kMaxName = UINT32_MAX;
constexpr std::array kSchema{
    models::placed(models::integer_parameter("mesh", "", 0, models::HardRange{0, kMaxName},
                                             models::SoftRange{0, kMaxName}, "name of the mesh"))};

class ObjectType final : public models::ModelType {
 public:
  ObjectType(std::shared_ptr<const ObjectSources> sources, bool copied)
      : sources_(std::move(sources)), copied_(copied) {}

  std::string_view name() const override { return copied_ ? "object_mesh" : "object_model"; }
  std::string_view doc() const override { return "a mesh of an object of the game"; }
  std::span<const models::ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return kObjectLevels; }
  int level_count_of(const models::Parameters& p) const override { return of(p)->level_count; }
  double level_error_m(const models::Parameters& p, int level) const override {
    const auto source = of(p);
    return source->type == nullptr
               ? copied(*source, level).error_m
               : source->type->level_error_m(source->parameters, source->first_level + level);
  }
  core::Bounds bounds(const models::Parameters& p) const override { return of(p)->box; }

  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    const auto source = of(p);
    models::MeshSize size;
    if (source->type != nullptr) {
      size = source->type->mesh_size(source->parameters, source->first_level + level);
    } else {
      const PackedMesh& mesh = copied(*source, level).mesh;
      size.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
      size.index_count = static_cast<std::uint32_t>(mesh.indices.size());
    }
    size.shared_indices = 0;
    size.layout = core::VertexLayout::kObject;
    return size;
  }

  double complexity(const models::Parameters& p, int level) const override {
    const auto source = of(p);
    return source->type == nullptr
               ? vertices(*source, level)
               : source->type->complexity(source->parameters, source->first_level + level);
  }
  double steps(const models::Parameters& p, int level) const override {
    const auto source = of(p);
    return source->type == nullptr
               ? vertices(*source, level)
               : source->type->steps(source->parameters, source->first_level + level);
  }
  double step_seconds() const override { return copied_ ? 5e-9 : 20e-9; }
  double log2_cost(const models::Parameters&) const override { return 0; }
  bool is_seen_from_far() const override { return false; }
  bool may_run_on_main_thread() const override { return copied_; }

  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    const auto source = of(p);
    if (source->type != nullptr) return widen(*source, source->first_level + level, out);
    const PackedMesh& mesh = copied(*source, level).mesh;
    const std::size_t bytes = mesh.vertices.size() * sizeof(core::ObjectVertex);
    if (bytes == 0 || bytes != out.vertices.size()) return nothing(out);
    std::memcpy(out.vertices.data(), mesh.vertices.data(), bytes);
    std::ranges::copy(mesh.indices, out.indices.begin());
    return source->box;
  }

 private:
  static const ObjectLevel& copied(const ObjectSource& source, int level) {
    static const ObjectLevel none;
    const auto number = static_cast<std::size_t>(level);
    return number < source.copied.size() ? source.copied[number] : none;
  }

  static double vertices(const ObjectSource& source, int level) {
    return static_cast<double>(copied(source, level).mesh.vertices.size());
  }

  // A mesh that was removed after its request. The cache keeps it under a name that is not used any
  // more.
  static core::Bounds nothing(const models::MeshView& out) {
    std::ranges::fill(out.vertices, std::byte{0});
    std::ranges::fill(out.indices, std::uint16_t{0});
    return {};
  }

  std::shared_ptr<const ObjectSource> of(const models::Parameters& p) const {
    // An unknown or removed mesh has no vertices.
    static const auto none = std::make_shared<const ObjectSource>();
    auto source = sources_->find(static_cast<std::uint32_t>(p.integer(0)));
    return source ? source : none;
  }

  static core::Bounds widen(const ObjectSource& source, int level, const models::MeshView& out) {
    const models::MeshSize size = source.type->mesh_size(source.parameters, level);
    std::vector<core::ModelVertex> narrow(size.vertex_count);
    const bool shared = size.shared_indices != 0;
    const core::Bounds tight =
        source.type->synthesise(source.parameters, level,
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

std::optional<std::uint32_t> ObjectSources::add(ObjectSource source) {
  const std::scoped_lock lock(mutex_);
  if (free_.empty()) {
    if (slots_.size() == kMax) return std::nullopt;
    free_.push_back(static_cast<std::uint32_t>(slots_.size()));
    slots_.push_back({nullptr, free_.back()});
  }
  Slot& slot = slots_[free_.back()];
  free_.pop_back();
  slot.source = std::make_shared<const ObjectSource>(std::move(source));
  return slot.name;
}

void ObjectSources::remove(std::uint32_t name) {
  std::shared_ptr<const ObjectSource> gone;  // destroyed after the lock is
  const std::scoped_lock lock(mutex_);
  const std::uint32_t number = name % kMax;
  if (number >= slots_.size() || slots_[number].name != name) return;
  Slot& slot = slots_[number];
  if (slot.source == nullptr) return;
  gone.swap(slot.source);
  slot.name += kMax;
  // All names of the last round stay unused: one of them means "none".
  if (slot.name / kMax < kMax - 1) free_.push_back(number);
}

std::shared_ptr<const ObjectSource> ObjectSources::find(std::uint32_t name) const {
  const std::scoped_lock lock(mutex_);
  const std::uint32_t number = name % kMax;
  return number < slots_.size() && slots_[number].name == name ? slots_[number].source : nullptr;
}

std::unique_ptr<models::ModelType> make_object_type(std::shared_ptr<const ObjectSources> sources,
                                                    bool copied) {
  return std::make_unique<ObjectType>(std::move(sources), copied);
}

models::Parameters object_parameters(std::uint32_t name) {
  models::Parameters p;
  p.set_integer(0, name);
  return p;
}

}  // namespace psygen::scene
