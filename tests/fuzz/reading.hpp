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

// Puts `text` into the file and reads it as a world, as a camera path, as bindings of actions, as a
// frame test, as a recording of actions, as the stored edits of a block and as glTF, and edits it
// as an editor does. A refusal is one printable line that names the file or the block and changes
// nothing; what is taken reads back equal from what is written of it; paths, replayed actions and
// edited ground have valid values. A recording with a wrong hash is read once more with the right
// one. Returns how many readers took the text.
int read_as_everything(std::string_view text, FileInMemory& file);

// Texts and bytes that read_as_everything() takes as what they are called.
std::string example_bindings();
std::string example_frame_test();
std::string example_recording();
std::string example_edits();
std::string example_gltf();
std::string example_world();

}  // namespace psygen::fuzz
