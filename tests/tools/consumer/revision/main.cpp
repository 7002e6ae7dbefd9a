// Prints the revision of its source, and whether that had changed.
#include <cstdio>

#include "engine/telemetry/machine.hpp"

int main() {
  const auto build = psygen::telemetry::build_facts();
  if (!build.revision.has_value() || !build.clean.has_value()) return 1;
  std::printf("%s %s\n", (*build.revision).c_str(), *build.clean ? "clean" : "changed");
  return 0;
}
