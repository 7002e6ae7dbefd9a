// What is fuzzed: a text is read by everything that reads files of people, and what must hold of
// any text is checked. A failed check aborts, so that fuzzer, sanitizers and tests see it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace psygen::fuzz {

// A file in memory, for functions that want one.
class FileInMemory {
 public:
  FileInMemory();
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;
  void write(std::string_view text);
  std::filesystem::path path() const;

 private:
  int descriptor_;
};

// Puts `text` into the file and reads it as a world, as a camera path and as bindings of actions. A
// refusal is one printable line that names the file and changes nothing; worlds and bindings read
// back equal from what is written of them; a path has valid poses. Returns how many readers took
// the text.
int read_as_everything(std::string_view text, FileInMemory& file);

// A text that read_as_everything() takes as bindings.
std::string example_bindings();

}  // namespace psygen::fuzz
