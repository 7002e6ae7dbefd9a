#include "engine/handmade/files.hpp"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <tuple>

#include "engine/core/log.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/handmade/handmade_type.hpp"

namespace psygen::handmade {
namespace {

namespace fs = std::filesystem;

using ShapePtr = std::shared_ptr<const Shape>;

gltf::Limits limits() {
  gltf::Limits most;
  most.bytes = std::uint64_t{128} << 20;
  most.vertices = kMostVertices;
  most.indices = 6 * kMostVertices;
  most.images = {4096, 4096, std::uint64_t{64} << 20, std::uint64_t{32} << 20};
  return most;
}

core::Result<ShapePtr> read_shape(const fs::path& file, const world::HandmadeModel& how) {
  const auto model = gltf::read_file(file, limits());
  if (!model) return tl::unexpected(model.error());
  auto shape = shape_of(*model, how);
  if (!shape)
    return core::fail(shape.error().code,
                      fmt::format("{}: {}", file.string(), shape.error().message));
  for (const std::string& note : model->notes)
    core::log_warning(note);
  return shape;
}

// Shapes that are in use, by file, its time and size, and the settings.
class Shapes {
 public:
  core::Result<ShapePtr> read(const fs::path& file, const world::HandmadeModel& how) {
    std::error_code error;
    const auto time = fs::last_write_time(file, error);
    const std::uintmax_t bytes = error ? 0 : fs::file_size(file, error);
    // Other glTF files consist of several, which may change alone.
    if (error || file.extension() != ".glb") return read_shape(file, how);
    const Key key{fs::absolute(file, error).string(),
                  time.time_since_epoch().count(),
                  bytes,
                  how.size_m,
                  how.scale,
                  how.sink_m,
                  how.levels,
                  how.collider};
    if (ShapePtr known = find(key)) return known;
    auto shape = read_shape(file, how);
    if (shape) keep(key, *shape);
    return shape;
  }

 private:
  using Key = std::tuple<std::string, std::int64_t, std::uintmax_t, double, double, double,
                         std::int64_t, std::string>;
  ShapePtr find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = shapes_.find(key);
    return found == shapes_.end() ? nullptr : found->second.lock();
  }
  void keep(const Key& key, const ShapePtr& shape) {
    const std::lock_guard lock(mutex_);
    std::erase_if(shapes_, [](const auto& entry) { return entry.second.expired(); });
    shapes_[key] = shape;
  }

  std::mutex mutex_;
  std::map<Key, std::weak_ptr<const Shape>> shapes_;
};

class Files final : public world::FilesBeside {
 public:
  core::Result<std::unique_ptr<models::ModelType>> read_model(
      const fs::path& file, const world::HandmadeModel& model) const override {
    const auto shape = shapes_.read(file, model);
    if (!shape) return tl::unexpected(shape.error());
    return make_handmade_type(model.name,
                              fmt::format("handmade: {}, {} triangles", model.file,
                                          (*shape)->levels.front().indices.size() / 3),
                              *shape);
  }

 private:
  mutable Shapes shapes_;
};

}  // namespace

const world::FilesBeside& files() {
  static const Files reader;
  return reader;
}

}  // namespace psygen::handmade
