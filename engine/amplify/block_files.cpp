#include "engine/amplify/block_files.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <span>
#include <utility>

#include "engine/core/replace_file.hpp"
#include "engine/exchange/unpack.hpp"
#include "engine/exchange/water_object.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::amplify {
namespace {

constexpr const char* kWorldFile = "world.toml";

std::string name_of(core::BlockCoord block) {
  return fmt::format("block_{}_{}", block.x, block.z);
}

// The block of a file name that name_of() made.
std::optional<core::BlockCoord> block_of(std::string_view file) {
  constexpr std::string_view kBegin = "block_";
  if (!file.starts_with(kBegin)) return std::nullopt;
  core::BlockCoord block;
  const char* const end = file.data() + file.size();
  const auto x = std::from_chars(file.data() + kBegin.size(), end, block.x);
  if (x.ec != std::errc() || x.ptr == end || *x.ptr != '_') return std::nullopt;
  const auto z = std::from_chars(x.ptr + 1, end, block.z);
  if (z.ec != std::errc() || z.ptr == end || *z.ptr != '.') return std::nullopt;
  return block;
}

std::filesystem::path file_in(const std::filesystem::path& folder, core::BlockCoord block,
                              exchange::Format format) {
  return folder / fmt::format("{}.{}", name_of(block), exchange::name_of(format));
}

core::Result<exchange::Object> object_of(const world::World& world,
                                         const models::Registry& registry, const BlockMesh& mesh) {
  const world::Placement& placement = mesh.placement;
  auto object = exchange::unpack(registry[placement.model], placement.parameters, mesh.level,
                                 mesh.size, mesh.view, world::drawn_palette(world));
  if (object && placement.index != world::kTerrainIndex) {
    object->name += fmt::format("_{}", placement.index);
    object->position = placement.position;
  }
  return object;
}

void add_water(const world::World& world, core::BlockCoord block, exchange::Document& document) {
  if (auto water = exchange::water_object(world, block))
    document.objects.push_back(std::move(*water));
}

// This many bytes of a truncated text identify its origin.
constexpr std::size_t kTelling = 8;

// The hash of the file of a block in the middle of the world and of the meshes around it. Nothing
// if one of its models fails.
std::optional<std::uint64_t> sample_of(const world::World& world, const models::Registry& registry,
                                       exchange::Format format) {
  const core::BlockCoord middle{static_cast<std::int32_t>(world.blocks_x / 2),
                                static_cast<std::int32_t>(world.blocks_z / 2)};
  const auto meshes = sample_world_hash(world, registry, middle);
  const auto document = block_document(world, registry, middle, 0);
  if (!meshes || !document) return std::nullopt;
  if (format == exchange::Format::kGlb) {
    const auto bytes = exchange::glb_bytes(*document);
    if (!bytes) return std::nullopt;
    return core::hash_bytes(std::as_bytes(std::span(*bytes)), *meshes);
  }
  const auto files = exchange::obj_files(*document, exchange::obj_names("sample.obj"));
  if (!files) return std::nullopt;
  const std::uint64_t with_materials =
      core::hash_bytes(std::as_bytes(std::span(files->mtl)), *meshes);
  return core::hash_bytes(
      std::as_bytes(std::span(files->obj)),
      core::hash_bytes(std::as_bytes(std::span(files->colours.rgba)), with_materials));
}

}  // namespace

core::Result<exchange::Document> block_document(const world::World& world,
                                                const models::Registry& registry,
                                                core::BlockCoord block, int level) {
  exchange::Document document{name_of(block), {}};
  Totals totals;
  std::optional<core::Error> error;
  BlockSynthesiser(world, registry, level).synthesise(block, totals, [&](const BlockMesh& mesh) {
    auto object = object_of(world, registry, mesh);
    if (object) document.objects.push_back(std::move(*object));
    if (!object && !error) error = object.error();
  });
  if (error) return tl::unexpected(*error);
  if (totals.failed > 0) return core::fail(core::ErrorCode::kSynthesisFailed, totals.first_failure);
  add_water(world, block, document);
  return document;
}

bool has_block_file(const std::filesystem::path& folder, core::BlockCoord block,
                    exchange::Format format) {
  std::error_code error;
  const std::filesystem::path file = file_in(folder, block, format);
  return std::filesystem::is_regular_file(file, error) &&
         !exchange::is_cut_short(file, format, name_of(block));
}

void remove_partial_blocks(const std::filesystem::path& folder,
                           const std::function<bool(core::BlockCoord)>& is_ours) {
  core::remove_partials_of(folder, [&](const std::string& file) {
    const auto block = block_of(file);
    return block && is_ours(*block);
  });
}

class BlockFolder::Sink final : public BlockSink {
 public:
  explicit Sink(BlockFolder& folder) : folder_(folder) {}

  bool wants(core::BlockCoord block) override {
    const bool there = folder_.has(block);
    if (there) folder_.skipped_.fetch_add(1, std::memory_order_relaxed);
    return !there;
  }

  void add(core::BlockCoord, const BlockMesh& mesh) override {
    auto object = object_of(folder_.world_, folder_.registry_, mesh);
    if (object) document_.objects.push_back(std::move(*object));
    if (!object && !error_) error_ = object.error();
  }

  core::Result<void> finish(core::BlockCoord block) override {
    if (error_) return tl::unexpected(*error_);
    document_.name = name_of(block);
    add_water(folder_.world_, block, document_);
    const auto written = exchange::write_scene(folder_.file_of(block), folder_.format_, document_);
    document_.objects.clear();
    if (written) folder_.written_.fetch_add(1, std::memory_order_relaxed);
    return written;
  }

  void drop(core::BlockCoord) override {
    document_.objects.clear();
    error_.reset();
  }

 private:
  BlockFolder& folder_;
  exchange::Document document_;
  std::optional<core::Error> error_;
};

BlockFolder::BlockFolder(std::filesystem::path folder, const world::World& world,
                         const models::Registry& registry, exchange::Format format)
    : folder_(std::move(folder)), world_(world), registry_(registry), format_(format) {}

core::Result<std::unique_ptr<BlockFolder>> BlockFolder::open(std::filesystem::path folder,
                                                             const world::World& world,
                                                             const models::Registry& registry,
                                                             exchange::Format format) {
  if (auto ok = telemetry::create_output_folder(folder); !ok) return tl::unexpected(ok.error());
  std::unique_ptr<BlockFolder> opened(new BlockFolder(std::move(folder), world, registry, format));
  if (auto ok = opened->claim(); !ok) return tl::unexpected(ok.error());
  return opened;
}

// Writes a text into the folder, unless the same text exists; replaces a truncated text. Fails for
// another text, and for a missing text next to blocks, whose origin is then unknown.
core::Result<void> BlockFolder::claim(const char* file, const std::string& text,
                                      const char* others) const {
  const std::filesystem::path path = folder_ / file;
  std::string theirs;
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    auto read = world::read_text_file(path);
    if (!read) return tl::unexpected(read.error());
    theirs = std::move(*read);
  }
  if (theirs == text) return {};
  const auto refuse = [&](std::string_view why) {
    return core::invalid_argument(
        fmt::format("{}: {} ({}); choose another folder", folder_.string(), why, path.string()));
  };
  if (theirs.empty() && has_blocks()) return refuse("has blocks of unknown origin");
  const bool rest = theirs.size() >= kTelling && text.starts_with(theirs);
  if (!theirs.empty() && !rest) return refuse(fmt::format("has blocks of {}", others));
  return core::replace_file(path, text);
}

// True if the folder has blocks of this format.
bool BlockFolder::has_blocks() const {
  const std::string extension = fmt::format(".{}", exchange::name_of(format_));
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() == extension && path.filename().string().starts_with("block_"))
      return true;
  }
  return false;
}

core::Result<void> BlockFolder::claim() const {
  if (auto ok = claim(kWorldFile, world::write_world(world_, registry_), "another world"); !ok)
    return ok;
  if (world_.files_hash != 0) {
    const std::string hash = fmt::format("{:016x}\n", world_.files_hash);
    if (auto ok = claim("files.hash", hash, "this world with other files"); !ok) return ok;
  }
  const auto sample = sample_of(world_, registry_, format_);
  if (!sample) return {};  // a later run with a sample rejects these blocks
  return claim(format_ == exchange::Format::kGlb ? "sample_glb.hash" : "sample_obj.hash",
               fmt::format("{:016x}\n", *sample), "this world from another version");
}

std::unique_ptr<BlockSink> BlockFolder::make_sink() {
  return std::make_unique<Sink>(*this);
}

std::filesystem::path BlockFolder::file_of(core::BlockCoord block) const {
  return file_in(folder_, block, format_);
}

bool BlockFolder::has(core::BlockCoord block) const {
  return has_block_file(folder_, block, format_);
}

}  // namespace psygen::amplify
