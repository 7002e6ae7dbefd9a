// Copies the files that a world references when it is saved in another folder. Writes all copies
// under temporary names before it renames the first one, so that a full disk leaves no files.
// Removes new files and folders again unless keep() is called. Knows no world. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/replace_file.hpp"

namespace psygen::editor {

class FileCopies {
 public:
  FileCopies() = default;
  // Removes the new files and folders, unless keep() was called.
  ~FileCopies();
  FileCopies(const FileCopies&) = delete;
  FileCopies& operator=(const FileCopies&) = delete;

  // Copies a file under a temporary name and creates its folders. Fails with kIo; the message
  // starts with the file that cannot be read or written.
  core::Result<void> add(const std::filesystem::path& from, const std::filesystem::path& to);
  // Registers a file that the caller will write, and creates its folders. The destructor removes it
  // too, if it is new.
  void expect(const std::filesystem::path& file);
  // Renames all copies to their final names and replaces existing files. Fails with kIo.
  core::Result<void> commit();
  // Keeps all new files and folders.
  void keep() { made_.clear(); }

 private:
  void make_folders(const std::filesystem::path& file);

  std::vector<std::unique_ptr<core::FileReplacement>> files_;
  std::vector<std::filesystem::path> targets_, made_;  // made_: new folders and new files
};

// True if two paths name the same file, or files with the same bytes. False if one is unreadable.
bool same_content(const std::filesystem::path& a, const std::filesystem::path& b);
// A hash of the size and the modification time of a file, which changes when the file is written.
std::uint64_t stamp_of(const std::filesystem::path& file);

}  // namespace psygen::editor
