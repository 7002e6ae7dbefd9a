#include "engine/handmade/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/cancellation.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/log.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/processors.hpp"
#include "engine/core/read_file.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/handmade/handmade_type.hpp"
#include "engine/handmade/triangles.hpp"
#include "engine/image/image_cache.hpp"
#include "engine/image/image_io.hpp"

namespace psygen::handmade {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMaxGreySide = 4096;                        // pixels
constexpr std::uint64_t kMaxGreyBytes = std::uint64_t{64} << 20;    // of a file, and decoded
constexpr std::uint64_t kMaxShapeBytes = std::uint64_t{512} << 20;  // of all models of a world
constexpr unsigned kMaxReaders = 4;  // threads; each may need some hundred megabytes
constexpr std::uint64_t kMaxHashedBytes = std::uint64_t{1} << 30;

using ShapePtr = std::shared_ptr<const Shape>;

// The result of reading a file, and the other files that it uses, existing or not.
template <class Made>
struct Read {
  std::shared_ptr<const Made> made;
  std::vector<fs::path> named;
};

// Appends what the file has and the engine does not support to `notes`.
core::Result<Read<Shape>> read_shape(const world::ModelFile& wanted, image::ImageCache& shared,
                                     std::vector<std::string>& notes) {
  if (auto ok = core::check_cancelled(); !ok) return tl::unexpected(ok.error());
  auto model = gltf::read_file(wanted.path, gltf_limits(), &shared);
  if (!model) return tl::unexpected(model.error());
  auto shape = shape_of(*model, *wanted.model);
  if (!shape)
    return core::fail(shape.error().code,
                      fmt::format("{}: {}", wanted.path.string(), shape.error().message));
  std::ranges::move(model->notes, std::back_inserter(notes));
  std::ranges::move(model->missing, std::back_inserter(model->files));
  return Read<Shape>{*std::move(shape), std::move(model->files)};
}

using PicturePtr = std::shared_ptr<const world::GreyPicture>;

using HeightsPtr = std::shared_ptr<const world::HeightPicture>;

// `meaning` says what becomes of pixels that are NaN or infinite.
core::Result<image::NumberImage> read_numbers(const fs::path& file, std::string_view meaning) {
  const image::ImageLimits most{kMaxGreySide, kMaxGreySide, kMaxGreyBytes, kMaxGreyBytes};
  auto image = image::read_numbers(file, most);
  if (image && image->not_finite > 0)
    core::log_warning(fmt::format("{}: {} of {} pixels are NaN or infinite; {}", file.string(),
                                  image->not_finite, image->values.size(), meaning));
  return image;
}

core::Result<Read<world::HeightPicture>> read_height_picture(const fs::path& file) {
  auto image = read_numbers(file, "the ground stays as it is there");
  if (!image) return tl::unexpected(image.error());
  for (std::size_t i = 0; i < image->alpha.size(); ++i) {
    if (image->alpha[i] <= 0)
      image->values[i] = std::numeric_limits<float>::quiet_NaN();
    else if (image->is_premultiplied)
      image->values[i] /= image->alpha[i];
  }
  auto picture =
      std::make_shared<world::HeightPicture>(world::finished({.width = image->width,
                                                              .height = image->height,
                                                              .values = std::move(image->values),
                                                              .wholes = {},
                                                              .white = image->white,
                                                              .is_coloured = image->is_coloured}));
  return Read<world::HeightPicture>{std::move(picture), {}};
}

core::Result<Read<world::GreyPicture>> read_picture(const fs::path& file) {
  auto image = read_numbers(file, "they count as black");
  if (!image) return tl::unexpected(image.error());
  const image::NumberRange range = image::range_of(image->values);
  if (range.least < 0 || double{range.largest} > image->white)
    core::log_warning(
        fmt::format("{}: the numbers are {:g} to {:g}; below 0 they count as black, above {:g} as "
                    "white",
                    file.string(), range.least, range.largest, image->white));
  image::GreyImage grey = image::grey_of(*image);
  auto picture = std::make_shared<world::GreyPicture>();
  picture->width = grey.width, picture->height = grey.height;
  picture->pixels = std::move(grey.grey);
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

// The results of reading files that are still in use. Makes each result in one thread.
template <class Key, class Made>
class InUse {
 public:
  // The known result for a key, else the result of `make`, which is kept. Without a key nothing is
  // kept.
  template <class Make>
  core::Result<std::shared_ptr<const Made>> find_or(const std::optional<Key>& key,
                                                    const Make& make) {
    if (!key) return make().map([](const Read<Made>& read) { return read.made; });
    const std::shared_ptr<Entry> entry = entry_of(*key);
    const std::lock_guard making(entry->making);
    if (auto known = entry->made.lock(); known && entry->is_unchanged()) return known;
    auto read = make();
    if (!read) return tl::unexpected(read.error());
    entry->keep(*read);
    return read->made;
  }

 private:
  struct Entry {
    std::mutex making;  // guards the rest
    std::weak_ptr<const Made> made;
    std::vector<std::pair<fs::path, std::optional<FileState>>> named;

    bool is_unchanged() const {
      return std::ranges::all_of(
          named, [](const auto& file) { return state_of(file.first) == file.second; });
    }
    void keep(const Read<Made>& read) {
      made.reset();
      named.clear();
      for (const fs::path& file : read.named)
        named.emplace_back(file, state_of(file));
      made = read.made;
    }
  };

  // Finds or adds the entry of a key. Now and then drops entries that no thread has and whose
  // result is gone.
  std::shared_ptr<Entry> entry_of(const Key& key) {
    const std::lock_guard lock(mutex_);
    if (entries_.size() >= full_) {
      std::erase_if(entries_, [&key](const auto& known) {
        const auto& [at, entry] = known;
        if (at == key || entry.use_count() > 1) return false;
        const std::unique_lock making(entry->making, std::try_to_lock);
        return making && entry->made.expired();
      });
      full_ = std::max(kFewEntries, 2 * entries_.size());
    }
    std::shared_ptr<Entry>& entry = entries_[key];
    if (!entry) entry = std::make_shared<Entry>();
    return entry;
  }

  static constexpr std::size_t kFewEntries = 64;

  std::mutex mutex_;  // guards entries_ and full_, but not the entries' content
  std::map<Key, std::shared_ptr<Entry>> entries_;
  std::size_t full_ = kFewEntries;  // number of entries at which they are looked through
};

// The memory of the shapes of one world, each counted once.
class ShapeSum {
 public:
  // Counts a shape. Returns true while the sum is allowed.
  bool add(const ShapePtr& shape) {
    const std::lock_guard lock(mutex_);
    if (counted_.insert(shape).second) {
      for (const Level& level : shape->levels)
        bytes_ += level.vertices.size() * sizeof(Vertex) +
                  level.indices.size() * sizeof(level.indices[0]);
    }
    return bytes_ <= kMaxShapeBytes;
  }

 private:
  std::mutex mutex_;
  std::set<ShapePtr> counted_;
  std::uint64_t bytes_ = 0;
};

class Files final : public world::ResourceLoader {
 public:
  world::ModelTypes read_models(std::span<const world::ModelFile> wanted) const override {
    world::ModelTypes types;
    std::vector<Loaded> loaded = load(wanted);
    ShapeSum sum;
    image::ImageCache shared;
    for (std::size_t i = 0; i < loaded.size(); ++i) {
      auto& [shape, notes] = loaded[i];
      // load() may stop before this model although only later ones exceed the sum.
      if (!read_one(wanted[i], shared, sum, loaded[i]) && shape) shape = too_large(wanted[i].path);
      for (const std::string& note : notes)
        core::log_warning(note);
      types.push_back(shape.map([&](const ShapePtr& made) {
        const world::HandmadeModel& model = *wanted[i].model;
        return make_handmade_type(model.name,
                                  fmt::format("handmade: {}, {} triangles", model.file,
                                              made->levels.front().indices.size() / 3),
                                  made);
      }));
      if (!shape) break;
    }
    return types;
  }

  core::Result<PicturePtr> read_grey(const fs::path& file) const override {
    return pictures_.find_or(state_of(file), [&] { return read_picture(file); });
  }
  core::Result<HeightsPtr> read_heights(const fs::path& file) const override {
    return heights_.find_or(state_of(file), [&] { return read_height_picture(file); });
  }

 private:
  using ShapeKey =
      std::tuple<FileState, double, double, double, std::int64_t, std::string>;  // with settings

  struct Loaded {
    core::Result<ShapePtr> shape;
    std::vector<std::string> notes;
  };

  static core::Result<ShapePtr> too_large(const fs::path& file) {
    return core::fail(
        core::ErrorCode::kOverBudget,
        fmt::format("{}: the models up to this one together need more than the allowed {} MiB",
                    file.string(), kMaxShapeBytes >> 20));
  }

  // The shapes of all files, or of all up to the first that fails or exceeds kMaxShapeBytes; the
  // rest is null. Several threads; the result does not depend on their number.
  std::vector<Loaded> load(std::span<const world::ModelFile> wanted) const {
    std::vector<Loaded> loaded(wanted.size());
    image::ImageCache shared;
    std::atomic<std::size_t> next = 0, done = 0, failed = wanted.size();
    ShapeSum sum;
    const std::atomic<bool>* const cancelled = core::cancel_flag();
    const auto work = [&] {
      const core::CancelScope scope(cancelled);
      for (std::size_t i = next++; i < failed; i = next++) {
        const bool is_read = read_one(wanted[i], shared, sum, loaded[i]);
        // Helper threads have no scope, so only the calling thread reports.
        core::report_progress(static_cast<double>(++done) / static_cast<double>(wanted.size()));
        if (is_read) continue;
        std::size_t before = failed;
        while (i < before && !failed.compare_exchange_weak(before, i)) {
        }
      }
    };
    const unsigned most = std::min(core::usable_processors(), kMaxReaders);
    core::run_in_threads(std::min<std::size_t>(most, wanted.size()), work);
    core::report_progress(1);
    return loaded;
  }

  // Reads a model unless it is read already, and counts its shape. Returns false if it fails or
  // the sum is too large. Throws nothing.
  bool read_one(const world::ModelFile& wanted, image::ImageCache& shared, ShapeSum& sum,
                Loaded& out) const {
    try {
      if (out.shape && !*out.shape) out.shape = shape_from(wanted, shared, out.notes);
      return out.shape && sum.add(*out.shape);
    } catch (const std::bad_alloc&) {
      out.shape =
          core::fail(core::ErrorCode::kOutOfMemory, core::out_of_memory(wanted.path.string()));
      return false;
    }
  }

  core::Result<ShapePtr> shape_from(const world::ModelFile& wanted, image::ImageCache& shared,
                                    std::vector<std::string>& notes) const {
    const world::HandmadeModel& how = *wanted.model;
    std::optional<ShapeKey> key;
    if (auto state = state_of(wanted.path))
      key = {*std::move(state), how.size_m, how.scale, how.sink_m, how.levels, how.collider};
    return shapes_.find_or(key, [&] { return read_shape(wanted, shared, notes); });
  }

  mutable InUse<ShapeKey, Shape> shapes_;
  mutable InUse<FileState, world::GreyPicture> pictures_;
  mutable InUse<FileState, world::HeightPicture> heights_;
};

class FilesWithPictures final : public world::ResourceLoader {
 public:
  FilesWithPictures(const fs::path& world_file, MemoryPicturesPtr pictures)
      : folder_(world_file.parent_path()), pictures_(std::move(pictures)) {}

  world::ModelTypes read_models(std::span<const world::ModelFile> wanted) const override {
    return files().read_models(wanted);
  }
  core::Result<PicturePtr> read_grey(const fs::path& file) const override {
    if (auto found = find(pictures_->in_place, file)) return found;
    auto read = files().read_grey(file);
    if (read) return read;
    if (auto found = find(pictures_->fallbacks, file)) return found;
    return read;
  }
  core::Result<HeightsPtr> read_heights(const fs::path& file) const override {
    const bool in_place = find(pictures_->in_place, file) != nullptr;
    auto read = in_place ? ResourceLoader::read_heights(file) : files().read_heights(file);
    const bool is_lost = !read && find(pictures_->fallbacks, file) != nullptr;
    return is_lost ? ResourceLoader::read_heights(file) : read;
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
  std::set<fs::path> known, models;
  const auto note = [&](const fs::path& name) {
    if (!name.empty() && known.insert(name).second) names.push_back(name);
  };
  image::ImageCache shared;
  for (const world::HandmadeModel& model : world.models) {
    note(model.file);
    if (!models.insert(model.file).second) continue;
    const fs::path file = world_file.parent_path() / model.file;
    const auto read = gltf::read_file(file, gltf_limits(), &shared);
    if (!read) return tl::unexpected(read.error());
    for (const fs::path& named : read->files)
      note(fs::path(model.file).parent_path() / named.lexically_relative(file.parent_path()));
  }
  for (const world::Scatter& scatter : world.scatter)
    note(scatter.mask.image);
  for (const world::Stamp& stamp : world.shaped.stamps) {
    note(stamp.image);
    note(stamp.mask.image);
  }
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
