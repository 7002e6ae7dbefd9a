#include "ecs/commands.hpp"

namespace psygen::ecs {

void Commands::apply(World& world) {
  std::vector<Batch> batches = std::exchange(batches_, {});
  for (Batch& batch : batches)
    batch.apply(world);
}

}  // namespace psygen::ecs
