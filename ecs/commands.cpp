#include "ecs/commands.hpp"

namespace psygen::ecs {

void Commands::apply(World& world) {
  std::vector<Batch> batches = std::exchange(batches_, {});
  struct KeepRest {
    std::vector<Batch>& from;
    std::vector<Batch>& to;
    std::size_t done = 0;
    ~KeepRest() {
      for (; done < from.size(); ++done)
        to.push_back(std::move(from[done]));
    }
  } rest{batches, batches_};
  while (rest.done < batches.size())
    batches[rest.done++].apply(world);
}

}  // namespace psygen::ecs
