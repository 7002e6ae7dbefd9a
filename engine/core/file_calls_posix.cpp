#include "engine/core/file_calls.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace psygen::core {

ExistingFile look_at(const std::filesystem::path& file) {
  struct statx status {};
  ExistingFile found;
  found.exists = statx(AT_FDCWD, file.c_str(), 0, STATX_TYPE | STATX_MODE | STATX_UID | STATX_GID,
                       &status) == 0;
  if (!found.exists)
    found.refusal = errno == ELOOP ? std::strerror(ELOOP) : nullptr;
  else if (!S_ISREG(status.stx_mode))
    found.refusal = "is not a regular file, and is not replaced";
  else if ((status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0)
    found.refusal = "is a mount point, and cannot be replaced";
  else if (access(file.c_str(), W_OK) != 0)
    found.refusal = "the file is read-only";
  found.mode = status.stx_mode & 07777U;
  found.owner = status.stx_uid;
  found.group = status.stx_gid;
  return found;
}

bool can_create_in(const std::filesystem::path& folder) {
  return access(folder.c_str(), W_OK | X_OK) == 0;
}

int create_file(const std::filesystem::path& file) {
  return open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

void keep_owner_and_mode(int file, const ExistingFile& before) {
  // The owner first, because a change of owner clears bits of the mode. Only root may change it.
  (void)!fchown(file, before.owner, before.group);
  (void)fchmod(file, before.mode);
}

std::ptrdiff_t write_some(int file, std::string_view bytes) {
  return write(file, bytes.data(), bytes.size());
}

bool flush_file(int file) {
  return fsync(file) == 0;
}

bool close_file(int file) {
  return close(file) == 0;
}

bool replace_name(const std::filesystem::path& from, const std::filesystem::path& to) {
  return std::rename(from.c_str(), to.c_str()) == 0;
}

void flush_folder(const std::filesystem::path& folder) {
  const int handle = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;
  fsync(handle);
  close(handle);
}

std::string host_identity() {
  char name[256] = "", space[64] = "";
  if (gethostname(name, sizeof(name) - 1) != 0) name[0] = '\0';
  if (readlink("/proc/self/ns/pid", space, sizeof(space) - 1) < 0) space[0] = '\0';
  return std::string(name) + space;
}

std::int64_t this_process() {
  return getpid();
}

bool is_running(std::int64_t process) {
  if (kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH) return false;
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string stat;  // process (name) state …; empty without /proc
  std::getline(file, stat);
  const std::size_t name_end = stat.rfind(") ");
  return name_end == std::string::npos || stat[name_end + 2] != 'Z';
}

}  // namespace psygen::core
