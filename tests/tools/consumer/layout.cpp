// Passes a type with vectors of GLM to psygen::visibility. Built with link-time optimisation, both
// sides see one definition of it. Compiled with another layout of GLM's types, it is refused.
#include "engine/visibility/horizon.hpp"

int main() {
  psygen::visibility::Horizon horizon;
  horizon.reset();
  const auto box = psygen::core::Bounds::around(glm::vec3(0, 0, -50), glm::vec3(1));
  return !horizon.hides(box) && box.max.r == 1 ? 0 : 1;
}
