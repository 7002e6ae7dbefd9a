// Copies of files beside a world that is saved in another folder. All of them are written under
// temporary names before the first gets its own, so that a full disk leaves nothing; what is new
// goes away again unless it is kept. Knows no world. One thread.
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

  // Copies a file under a temporary name and makes the folders that it needs. Fails with kIo; the
  // message starts with the file that cannot be read or written.
  core::Result<void> add(const std::filesystem::path& from, const std::filesystem::path& to);
  // A file that is about to be written by somebody else: it goes away too, if it is new. Makes the
  // folders that it needs.
  void expect(const std::filesystem::path& file);
  // Gives all of them their names; what was there is replaced. Fails with kIo.
  core::Result<void> commit();
  // They stay.
  void keep() { made_.clear(); }

 private:
  void make_folders(const std::filesystem::path& file);

  std::vector<std::unique_ptr<core::FileReplacement>> files_;
  std::vector<std::filesystem::path> targets_, made_;  // made: folders, and files that are new
};

// Whether two files have the same bytes; also where they are one file. False where one cannot be
// read.
bool same_content(const std::filesystem::path& a, const std::filesystem::path& b);
// Changes with a file that others write: of its size and its time.
std::uint64_t stamp_of(const std::filesystem::path& file);

}  // namespace psygen::editor
