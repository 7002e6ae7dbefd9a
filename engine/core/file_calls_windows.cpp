#include "engine/core/file_calls.hpp"

#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#include <windows.h>

#include <cerrno>

namespace psygen::core {

ExistingFile look_at(const std::filesystem::path& file) {
  const DWORD attributes = GetFileAttributesW(file.c_str());
  ExistingFile found;
  found.exists = attributes != INVALID_FILE_ATTRIBUTES;
  if (!found.exists) return found;
  if ((attributes & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_DEVICE)) != 0)
    found.refusal = "is not a regular file, and is not replaced";
  else if ((attributes & FILE_ATTRIBUTE_READONLY) != 0)
    found.refusal = "the file is read-only";
  return found;
}

// Only an attempt tells: Windows decides by lists of access.
bool can_create_in(const std::filesystem::path& folder) {
  const DWORD attributes = GetFileAttributesW(folder.c_str());
  if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0)
    return true;
  errno = ENOENT;
  return false;
}

int create_file(const std::filesystem::path& file) {
  int handle = -1;
  const errno_t failed =
      _wsopen_s(&handle, file.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT,
                _SH_DENYNO, _S_IREAD | _S_IWRITE);
  if (failed != 0) errno = failed;
  return failed == 0 ? handle : -1;
}

// A file inherits owner and permissions from its folder.
void keep_owner_and_mode(int, const ExistingFile&) {}

std::ptrdiff_t write_some(int file, std::string_view bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  return _write(file, bytes.data(), static_cast<unsigned>(bytes.substr(0, kMost).size()));
}

bool flush_file(int file) {
  return _commit(file) == 0;
}

bool close_file(int file) {
  return _close(file) == 0;
}

bool replace_name(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (MoveFileExW(from.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
    return true;
  errno = GetLastError() == ERROR_DISK_FULL ? ENOSPC : EACCES;
  return false;
}

// replace_name() writes through.
void flush_folder(const std::filesystem::path&) {}

std::string host_identity() {
  char name[MAX_COMPUTERNAME_LENGTH + 1] = "";
  DWORD length = sizeof name;
  return GetComputerNameA(name, &length) != 0 ? name : "";
}

std::int64_t this_process() {
  return GetCurrentProcessId();
}

bool is_running(std::int64_t process) {
  HANDLE handle = OpenProcess(SYNCHRONIZE, FALSE, static_cast<DWORD>(process));
  if (handle == nullptr) return GetLastError() == ERROR_ACCESS_DENIED;
  const bool running = WaitForSingleObject(handle, 0) == WAIT_TIMEOUT;
  CloseHandle(handle);
  return running;
}

}  // namespace psygen::core
