#include "engine/amplify/block_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "engine/core/replace_file.hpp"
#include "engine/exchange/unpack.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/text_file.hpp"

namespace psygen::amplify {
namespace {

constexpr const char* kWorldFile = "world.toml";

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
    const bool there = std::filesystem::is_regular_file(folder_.file_of(block), error);
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
  const std::filesystem::path file = folder_ / kWorldFile;
  const std::string mine = world::write_world(world_, registry_);
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    return core::replace_file(file,
                              {reinterpret_cast<const std::uint8_t*>(mine.data()), mine.size()});
  }
  const auto theirs = world::read_text_file(file);
  if (!theirs) return tl::unexpected(theirs.error());
  if (*theirs == mine) return {};
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("{}: holds the blocks of another world ({}); choose another folder",
                                folder_.string(), file.string()));
}

std::unique_ptr<BlockSink> BlockFolder::make_sink() {
  return std::make_unique<Sink>(*this);
}

std::filesystem::path BlockFolder::file_of(core::BlockCoord block) const {
  return folder_ / fmt::format("{}.{}", name_of(block), exchange::name_of(format_));
}

}  // namespace psygen::amplify
