#include "engine/amplify/block_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "engine/core/replace_file.hpp"
#include "engine/exchange/cut_short.hpp"
#include "engine/exchange/unpack.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/text_file.hpp"

namespace psygen::amplify {
namespace {

constexpr const char *kWorldFile = "world.toml", *kSampleFile = "sample.hash";

std::string name_of(core::BlockCoord block) {
  return fmt::format("block_{}_{}", block.x, block.z);
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

// Whether the file holds this text, which it gets where it does not exist.
core::Result<bool> same_or_written(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  if (std::filesystem::exists(file, error)) {
    return world::read_text_file(file).map([&text](const auto& theirs) { return theirs == text; });
  }
  return core::replace_file(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})
      .map([] { return true; });
}

tl::unexpected<core::Error> refusal(const std::filesystem::path& folder, const char* of_what,
                                    const char* file) {
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("{}: holds the blocks of {} ({}); choose another folder",
                                folder.string(), of_what, (folder / file).string()));
}

}  // namespace

core::Result<exchange::Document> block_document(const world::World& world,
                                                const models::Registry& registry,
                                                core::BlockCoord block, int level) {
  exchange::Document document{name_of(block), {}};
  Totals totals;
  std::optional<core::Error> error;
  BlockSynthesizer(world, registry, level).synthesise(block, totals, [&](const BlockMesh& mesh) {
    auto object = object_of(world, registry, mesh);
    if (object) document.objects.push_back(std::move(*object));
    if (!object && !error) error = object.error();
  });
  if (error) return tl::unexpected(*error);
  if (totals.failed > 0) return core::fail(core::ErrorCode::kSynthesisFailed, totals.first_failure);
  return document;
}

class BlockFolder::Sink final : public BlockSink {
 public:
  explicit Sink(BlockFolder& folder) : folder_(folder) {}

  bool wants(core::BlockCoord block) override {
    std::error_code error;
    const std::filesystem::path file = folder_.file_of(block);
    const bool there = std::filesystem::is_regular_file(file, error) &&
                       !exchange::is_cut_short(file, folder_.format_, name_of(block));
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
    const auto written =
        exchange::write_document(folder_.file_of(block), folder_.format_, document_);
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
  core::remove_stale_partials(opened->folder_);
  return opened;
}

// Leaves the world's file in the folder, or finds the same one there.
core::Result<void> BlockFolder::claim() const {
  const auto same = same_or_written(folder_ / kWorldFile, world::write_world(world_, registry_));
  if (!same) return tl::unexpected(same.error());
  if (!*same) return refusal(folder_, "another world", kWorldFile);
  return claim_version();
}

// The same with the hash of a few blocks. Where a model type fails they have none: its blocks get
// no files either.
core::Result<void> BlockFolder::claim_version() const {
  const std::optional<std::uint64_t> sample = sample_world_hash(world_, registry_, {0, 0});
  if (!sample) return {};
  const auto same = same_or_written(folder_ / kSampleFile, fmt::format("{:016x}\n", *sample));
  if (!same) return tl::unexpected(same.error());
  if (!*same) return refusal(folder_, "this world made by another version", kSampleFile);
  return {};
}

std::unique_ptr<BlockSink> BlockFolder::make_sink() {
  return std::make_unique<Sink>(*this);
}

std::filesystem::path BlockFolder::file_of(core::BlockCoord block) const {
  return folder_ / fmt::format("{}.{}", name_of(block), exchange::name_of(format_));
}

}  // namespace psygen::amplify
