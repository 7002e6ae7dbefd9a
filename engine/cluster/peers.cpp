#include "engine/cluster/peers.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <cstring>

namespace psygen::cluster {

bool is_rank() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
}

unsigned copies_started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS", "PMI_SIZE"}) {
    const char* text = std::getenv(name);
    unsigned copies = 0;
    if (text == nullptr) continue;
    if (std::from_chars(text, text + std::strlen(text), copies).ec == std::errc()) return copies;
  }
  return 1;
}

core::Result<void> check_one_copy(std::string_view work) {
  const unsigned copies = copies_started();
  if (copies <= 1) return {};
  return core::invalid_argument(fmt::format(
      "{} copies of this program were started, and each would {}; start one (srun -n 1)", copies,
      work));
}

core::Result<std::unique_ptr<Peers>> join_communicator() {
  // RTLD_GLOBAL: plugins that MPI's libraries load need the symbols of those libraries.
  void* library = dlopen("libpsygen_mpi.so", RTLD_NOW | RTLD_GLOBAL);
  void* join = library != nullptr ? dlsym(library, "psygen_join_mpi") : nullptr;
  if (join == nullptr) {
    const char* reason = dlerror();
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("this process runs under mpirun, but MPI cannot be "
                                  "loaded: {}",
                                  reason != nullptr ? reason : "unknown"));
  }
  std::string error;
  std::unique_ptr<Peers> peers(reinterpret_cast<JoinMpi>(join)(error));
  if (!peers) return core::fail(core::ErrorCode::kInternal, error);
  return peers;
}

}  // namespace psygen::cluster
