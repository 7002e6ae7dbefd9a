#include "tests/engine/save/file_faults.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace psygen::save::testing {
namespace {

Fault fault_now = Fault::kKill;
long left = 0;

// Returns true if the call must fail with ENOSPC. If the process is to be killed, it first calls
// `half` and does not return.
template <class Half>
bool meets(const Half& half) {
  if (left-- > 0) return false;
  if (fault_now == Fault::kFullDisk) {
    errno = ENOSPC;
    return true;
  }
  if (fault_now == Fault::kKillHalf) half();
  kill(getpid(), SIGKILL);
  return true;
}
constexpr auto kNothing = [] {};

ssize_t faulty_write(int file, const void* bytes, size_t count) {
  const auto half = [&] { (void)!::write(file, bytes, count / 2); };
  return meets(half) ? -1 : ::write(file, bytes, count);
}
ssize_t faulty_pwrite(int file, const void* bytes, size_t count, off_t at) {
  const auto half = [&] { (void)!::pwrite(file, bytes, count / 2, at); };
  return meets(half) ? -1 : ::pwrite(file, bytes, count, at);
}
int faulty_truncate(int file, off_t size) {
  return meets(kNothing) ? -1 : ::ftruncate(file, size);
}
int faulty_unlink(const char* path) {
  return meets(kNothing) ? -1 : ::unlink(path);
}
int faulty_open(const char* path, int flags, int mode) {
  if ((flags & O_CREAT) != 0 && meets(kNothing)) return -1;
  return ::open(path, flags | O_CLOEXEC, mode);
}

template <class Function>
void replace(const char* name, Function* function) {
  sqlite3_vfs* vfs = sqlite3_vfs_find(nullptr);
  vfs->xSetSystemCall(vfs, name, reinterpret_cast<sqlite3_syscall_ptr>(function));
}

}  // namespace

FileFaults::FileFaults(Fault fault, std::size_t calls_left) {
  fault_now = fault;
  left = static_cast<long>(calls_left);
  replace("open", faulty_open);
  replace("write", faulty_write);
  replace("pwrite", faulty_pwrite);
  replace("pwrite64", faulty_pwrite);
  replace("ftruncate", faulty_truncate);
  replace("unlink", faulty_unlink);
}

FileFaults::~FileFaults() {
  sqlite3_vfs* vfs = sqlite3_vfs_find(nullptr);
  vfs->xSetSystemCall(vfs, nullptr, nullptr);
}

bool FileFaults::was_met() const {
  return left < 0;
}

}  // namespace psygen::save::testing
