// Every model type and species of every world of the game, exported and read by another library.
#include "tests/engine/exchange/read_back.hpp"

#include <gtest/gtest.h>

#include <set>

#include "engine/exchange/write_document.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/exchange/synthesised.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::exchange {
namespace {

// All levels of a model, one object each.
Document levels_of(const models::ModelType& type) {
  const models::Parameters parameters = models::default_parameters(type);
  Document document{std::string(type.name()), {}};
  for (int level = 0; level < type.level_count_of(parameters); ++level)
    document.objects.push_back(synthesised(type, parameters, level));
  return document;
}

void expect_read_back(const Document& document, const TemporaryFolder& folder, Format format) {
  const auto file = folder / ("model." + std::string(name_of(format)));
  ASSERT_TRUE(write_scene(file, format, document));
  const ReadBack back(file);
  ASSERT_NE(back.scene(), nullptr) << back.error();
  const Counts counts = counts_of(*back.scene());
  EXPECT_EQ(counts.triangles, document.triangle_count());
  // For an .obj the library makes one vertex per corner.
  if (format == Format::kGlb) {
    EXPECT_EQ(counts.vertices, document.vertex_count());
  }
}

TEST(ReadBack, EveryModelAndSpeciesOfEveryWorldAtEveryLevelHasTheSameCounts) {
  const TemporaryFolder folder;
  std::set<std::string> seen;
  for (const auto& entry :
       std::filesystem::directory_iterator(world::testing::game_file("worlds"))) {
    models::Registry registry = models::make_standard_registry();
    ASSERT_TRUE(world::load_world(entry.path(), registry)) << entry.path();
    for (std::size_t i = 0; i < registry.size(); ++i) {
      const models::ModelType& type = registry[static_cast<models::ModelIndex>(i)];
      if (!seen.insert(std::string(type.name())).second) continue;
      SCOPED_TRACE(type.name());
      const Document document = levels_of(type);
      EXPECT_GT(document.triangle_count(), 0u);
      expect_read_back(document, folder, Format::kGlb);
      expect_read_back(document, folder, Format::kObj);
    }
  }
  for (const char* name : {"terrain", "tree", "rock", "grass", "oak"})
    EXPECT_TRUE(seen.contains(name)) << name;
  EXPECT_GE(seen.size(), 9u);  // with five species at least
}

}  // namespace
}  // namespace psygen::exchange
