// `psygen export`. Main thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/tiles/tile_tree.hpp"

namespace psygen::cli {

// The command.
class ExportCommand final : public Command {
 public:
  explicit ExportCommand(CLI::App& cli);
  int run() override;

 private:
  core::Result<exchange::Document> model_document(const models::Registry& registry,
                                                  const world::Palette& palette) const;
  core::Result<exchange::Document> block_document(const world::World& world,
                                                  const models::Registry& registry) const;
  int export_region(const world::World& world, const models::Registry& registry) const;
  int export_heightmap(const world::World& world, unsigned threads) const;

  std::string model_, world_ = kDefaultWorld, out_;
  std::vector<std::string> settings_;  // name=value
  std::optional<core::BlockCoord> block_;
  int level_ = 0;
  std::optional<amplify::Region> region_;
  std::string format_ = "3dtiles";  // of a region
  std::optional<tiles::NodeLevels> levels_;
  unsigned threads_ = 0;
};

}  // namespace psygen::cli
