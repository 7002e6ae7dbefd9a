#include "engine/synthesis/thread_priority.hpp"

#ifdef __linux__
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace psygen::synthesis {

void lower_priority_of_this_thread() {
#ifdef __linux__
  // Linux applies the nice value to a single thread if it is named by its thread id.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 19);
#endif
}

void name_this_thread([[maybe_unused]] const std::string& name) {
#ifdef __linux__
  pthread_setname_np(pthread_self(), name.substr(0, 15).c_str());
#endif
}

}  // namespace psygen::synthesis
