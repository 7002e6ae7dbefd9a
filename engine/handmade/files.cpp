#include "engine/handmade/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/core/log.hpp"
#include "engine/core/read_file.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/handmade/handmade_type.hpp"
#include "engine/handmade/triangles.hpp"
#include "engine/image/image_io.hpp"

namespace psygen::handmade {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxHashedBytes = std::uint64_t{1} << 30;

using ShapePtr = std::shared_ptr<const Shape>;

// The result of reading a file, and the other files that it names.
template <class Made>
struct Read {
  std::shared_ptr<const Made> made;
  std::vector<fs::path> named;
};

core::Result<Read<Shape>> read_shape(const fs::path& file, const world::HandmadeModel& how) {
  const auto model = gltf::read_file(file, gltf_limits());
  if (!model) return tl::unexpected(model.error());
  auto shape = shape_of(*model, how);
  if (!shape)
    return core::fail(shape.error().code,
                      fmt::format("{}: {}", file.string(), shape.error().message));
  for (const std::string& note : model->notes)
    core::log_warning(note);
  return Read<Shape>{*std::move(shape), model->files};
}

using PicturePtr = std::shared_ptr<const world::GreyPicture>;

core::Result<Read<world::GreyPicture>> read_picture(const fs::path& file) {
  const image::ImageLimits most{4096, 4096, std::uint64_t{64} << 20, std::uint64_t{64} << 20};
  auto image = image::read_grey(file, most);
  if (!image) return tl::unexpected(image.error());
  auto picture = std::make_shared<world::GreyPicture>();
  picture->width = image->width, picture->height = image->height;
  picture->pixels = std::move(image->grey);
  picture->hash = world::content_hash(*picture);
  return Read<world::GreyPicture>{std::move(picture), {}};
}

// The state of a file: its path, its time and its size.
using FileState = std::tuple<std::string, std::int64_t, std::uintmax_t>;

std::optional<FileState> state_of(const fs::path& file) {
  std::error_code error;
  const auto time = fs::last_write_time(file, error);
  const std::uintmax_t bytes = error ? 0 : fs::file_size(file, error);
  if (error) return std::nullopt;
  return FileState{fs::absolute(file, error).string(), time.time_since_epoch().count(), bytes};
}

// The results of reading files that are still in use.
template <class Key, class Made>
class InUse {
 public:
  // The known result for a key, else the result of `make`, which is kept. Without a key nothing is
  // kept.
  template <class Make>
  core::Result<std::shared_ptr<const Made>> find_or(const std::optional<Key>& key,
                                                    const Make& make) {
    if (auto known = key ? find(*key) : nullptr) return known;
    auto read = make();
    if (!read) return tl::unexpected(read.error());
    if (key) keep(*key, *read);
    return read->made;
  }

 private:
  struct Entry {
    std::weak_ptr<const Made> made;
    std::vector<std::pair<fs::path, std::optional<FileState>>> named;
  };

  std::shared_ptr<const Made> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = made_.find(key);
    if (found == made_.end()) return nullptr;
    const bool same = std::ranges::all_of(
        found->second.named, [](const auto& file) { return state_of(file.first) == file.second; });
    return same ? found->second.made.lock() : nullptr;
  }
  void keep(const Key& key, const Read<Made>& read) {
    Entry entry{read.made, {}};
    for (const fs::path& file : read.named)
      entry.named.emplace_back(file, state_of(file));
    const std::lock_guard lock(mutex_);
    std::erase_if(made_, [](const auto& known) { return known.second.made.expired(); });
    made_[key] = std::move(entry);
  }

  std::mutex mutex_;
  std::map<Key, Entry> made_;
};

class Files final : public world::ResourceLoader {
 public:
  core::Result<std::unique_ptr<models::ModelType>> read_model(
      const fs::path& file, const world::HandmadeModel& model) const override {
    const auto shape = shape_from(file, model);
    if (!shape) return tl::unexpected(shape.error());
    return make_handmade_type(model.name,
                              fmt::format("handmade: {}, {} triangles", model.file,
                                          (*shape)->levels.front().indices.size() / 3),
                              *shape);
  }

  core::Result<PicturePtr> read_grey(const fs::path& file) const override {
    return pictures_.find_or(state_of(file), [&] { return read_picture(file); });
  }

 private:
  using ShapeKey =
      std::tuple<FileState, double, double, double, std::int64_t, std::string>;  // with settings

  core::Result<ShapePtr> shape_from(const fs::path& file, const world::HandmadeModel& how) const {
    std::optional<ShapeKey> key;
    if (auto state = state_of(file))
      key = {*std::move(state), how.size_m, how.scale, how.sink_m, how.levels, how.collider};
    return shapes_.find_or(key, [&] { return read_shape(file, how); });
  }

  mutable InUse<ShapeKey, Shape> shapes_;
  mutable InUse<FileState, world::GreyPicture> pictures_;
};

class FilesWithPictures final : public world::ResourceLoader {
 public:
  FilesWithPictures(const fs::path& world_file, MemoryPicturesPtr pictures)
      : folder_(world_file.parent_path()), pictures_(std::move(pictures)) {}

  core::Result<std::unique_ptr<models::ModelType>> read_model(
      const fs::path& file, const world::HandmadeModel& model) const override {
    return files().read_model(file, model);
  }
  core::Result<PicturePtr> read_grey(const fs::path& file) const override {
    if (auto found = find(pictures_->in_place, file)) return found;
    auto read = files().read_grey(file);
    if (read) return read;
    if (auto found = find(pictures_->fallbacks, file)) return found;
    return read;
  }

 private:
  PicturePtr find(const NamedPictures& pictures, const fs::path& file) const {
    for (const auto& [name, picture] : pictures) {
      if (folder_ / name == file) return picture;
    }
    return nullptr;
  }

  fs::path folder_;
  MemoryPicturesPtr pictures_;
};

}  // namespace

const world::ResourceLoader& files() {
  static const Files reader;
  return reader;
}

FilesPtr files_with(const fs::path& world_file, MemoryPicturesPtr pictures) {
  if (!pictures) return {&files(), [](const world::ResourceLoader*) {}};
  return std::make_shared<FilesWithPictures>(world_file, std::move(pictures));
}

core::Result<std::vector<fs::path>> files_named_by(const world::World& world,
                                                   const fs::path& world_file) {
  std::vector<fs::path> names;
  const auto note = [&names](const fs::path& name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const world::HandmadeModel& model : world.models) {
    note(model.file);
    const fs::path file = world_file.parent_path() / model.file;
    const auto read = gltf::read_file(file, gltf_limits());
    if (!read) return tl::unexpected(read.error());
    for (const fs::path& named : read->files)
      note(fs::path(model.file).parent_path() / named.lexically_relative(file.parent_path()));
  }
  for (const world::Scatter& scatter : world.scatter)
    note(scatter.mask.image);
  for (const world::Stamp& stamp : world.shaped.stamps)
    note(stamp.image);
  for (const std::string& image : world.palette.images)
    note(image);
  return names;
}

core::Result<std::uint64_t> hash_of_files(const world::World& world, const fs::path& world_file) {
  const auto names = files_named_by(world, world_file);
  if (!names) return tl::unexpected(names.error());
  std::uint64_t hash = 0;
  for (const fs::path& name : *names) {
    const auto bytes = core::read_file(world_file.parent_path() / name, kMaxHashedBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    hash = core::hash_bytes(std::as_bytes(std::span(*bytes)), hash);
  }
  return hash;
}

}  // namespace psygen::handmade
