#include "engine/cluster/peers.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

namespace psygen::cluster {

bool is_rank() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
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
