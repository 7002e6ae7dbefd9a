// Calls of the operating system that replace_file.cpp needs and C++ lacks. Files are descriptors.
// Functions that fail set errno. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace psygen::core {

// A file as it is before its replacement.
struct ExistingFile {
  bool exists = false;
  unsigned mode = 0, owner = 0, group = 0;
  const char* refusal = nullptr;  // the reason not to replace it; null: none
};
ExistingFile look_at(const std::filesystem::path& file);
// True if this process may create files in the folder.
bool can_create_in(const std::filesystem::path& folder);

// Creates a file that does not exist and opens it for writing; -1 if that fails.
int create_file(const std::filesystem::path& file);
// Gives a new file the owner, if this user may, and the permissions of the one that it replaces.
void keep_owner_and_mode(int file, const ExistingFile& before);
// Writes some of the bytes and returns their number, or -1. Async-signal-safe.
std::ptrdiff_t write_some(int file, std::string_view bytes);
// Writes the system's buffers of the file to the disk.
bool flush_file(int file);
bool close_file(int file);
// Gives `from` the name `to` in one step, also if a file has that name.
bool replace_name(const std::filesystem::path& from, const std::filesystem::path& to);
// Writes the names in the folder to the disk.
void flush_folder(const std::filesystem::path& folder);

// Identifies the host and the container, within which the numbers of processes are unique.
std::string host_identity();
std::int64_t this_process();
// True if the process can still write. A zombie cannot: it has ended, but its parent has not read
// its status. The first process of a container may take seconds to do so, or never do it.
bool is_running(std::int64_t process);

}  // namespace psygen::core
