// Fells the nearest oak ahead for good: an edit of the world, visible from near and far, that a
// saved game keeps. Every run fells one more tree, saves, and writes an image.
//   example_felling game.save picture.png
#include <cstdio>

#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/data_file.hpp"
#include "engine/program/program.hpp"
#include "engine/query/world.hpp"
#include "engine/save/save_game.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/edits/edits.hpp"

using namespace psygen;

namespace {

// Saves the changed blocks and the number of felled trees in one transaction.
core::Result<void> store(save::SaveGame& save, const world::Edits& before,
                         const world::Edits& now) {
  if (auto ok = save.put_changes(before, now); !ok) return ok;
  const auto count = static_cast<std::int64_t>(now.counts().removed);
  return save.put_value("felled", count).and_then([&] { return save.save(); });
}

core::Result<void> fell(const char* save_file, const char* picture) {
  const auto world = core::data_file("worlds/five_species.toml");
  if (!world) return tl::unexpected(world.error());
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = true;
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  const scene::WorldFacts& facts = (*session)->scene().facts();

  // A later version of the world may have changed: trees that no longer exist are kept aside.
  auto save = save::SaveGame::open(save_file, facts.world, facts.registry,
                                   {.accept = save::Accept::kChangedWorld});
  if (!save) return tl::unexpected(save.error());
  for (const save::Misfit& misfit : save->misfits())
    std::printf("block %d, %d: %u edits no longer fit: %s\n", misfit.block.x, misfit.block.z,
                misfit.count, misfit.reason.c_str());
  const auto before = save->load_edits(facts.world, facts.registry);
  if (!before) return tl::unexpected(before.error());
  (*session)->scene().edit(*before);

  core::CameraPose pose = (*session)->home();
  pose.position.local.y -= 15;
  if (auto ok = (*session)->prepare(pose); !ok) return ok;

  // Finds existing models only; felled trees are gone.
  query::World query(facts.world, facts.registry);
  const auto oak = static_cast<models::ModelIndex>(facts.registry.find("oak"));
  core::WorldPosition ahead = pose.position;
  ahead.local += 50.0 * glm::dvec3(core::forward_of(pose));
  const auto tree = query.nearest(ahead, 300, {{oak}});
  if (!tree) return tl::unexpected(tree.error());
  if (!*tree) return core::fail(core::ErrorCode::kInvalidArgument, "no oak is left");
  world::Edits now = *before;
  if (auto ok = now.remove(facts.world, {(*tree)->block, (*tree)->index}); !ok) return ok;
  (*session)->scene().edit(now);
  if (auto ok = store(*save, *before, now); !ok) return ok;
  std::printf("felled oak %u of block %d, %d at %.1f m; %llu oaks in all\n", (*tree)->index,
              (*tree)->block.x, (*tree)->block.z, (*tree)->distance_m,
              static_cast<unsigned long long>(now.counts().removed));

  if (auto ok = (*session)->prepare(pose); !ok) return ok;
  if (auto ok = (*session)->tick(pose, 1.0 / 60); !ok) return ok;
  return (*session)->save_picture(picture);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: example_felling game.save picture.png\n");
    return 2;
  }
  return program::run("example_felling", [&] { return fell(argv[1], argv[2]); });
}
