#include "ecs/commands.hpp"

#include <iterator>

namespace psygen::ecs {

void Commands::apply(World& world) {
  std::vector<std::unique_ptr<List>> lists = std::exchange(lists_, {});
  for (auto list = lists.begin(); list != lists.end(); ++list) {
    try {
      (*list)->apply(world);
    } catch (...) {
      lists_.insert(lists_.end(), std::move_iterator(list + 1), std::move_iterator(lists.end()));
      throw;
    }
  }
}

}  // namespace psygen::ecs
