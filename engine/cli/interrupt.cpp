#include "engine/cli/interrupt.hpp"

#include <signal.h>

namespace psygen::cli {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void interrupt(int) {
  interrupted = true;
}

bool is_ignored(int signal_number) {
  struct sigaction action {};
  return sigaction(signal_number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void handle(int signal_number, int flags) {
  struct sigaction action {};
  action.sa_handler = interrupt;
  action.sa_flags = SA_RESTART | flags;
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

const std::atomic<bool>& stop_at_interrupt() {
  constexpr auto kOnce = static_cast<int>(SA_RESETHAND);
  // Users who press Ctrl+C twice do not want to wait. A closed terminal sends SIGHUP twice, from
  // the kernel and from the shell; under nohup it is ignored.
  handle(SIGINT, kOnce);
  handle(SIGTERM, kOnce);
  if (!is_ignored(SIGHUP)) handle(SIGHUP, 0);
  return interrupted;
}

}  // namespace psygen::cli
