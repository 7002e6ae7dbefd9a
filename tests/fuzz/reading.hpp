// The fuzz target: every reader of user files reads a text, and invariants that hold for any text
// are checked. A failed check aborts, so that fuzzer, sanitizers and tests notice it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace psygen::fuzz {

// A file in memory, for functions that need a path.
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

// Writes `text` to the file and reads it as a world, a camera path, action bindings, a frame test,
// an input recording, the stored edits of a block and glTF, and edits it as an editor does. Checks
// that an error is one printable line that names the file or the block and changes nothing; that
// accepted text survives a round trip; and that paths, replayed actions and edited ground have
// valid values. A recording with a wrong hash is read again with the right hash. Returns the number
// of readers that accepted the text.
int read_as_everything(std::string_view text, FileInMemory& file);

// Texts and bytes that read_as_everything() accepts as the named format.
std::string example_bindings();
std::string example_frame_test();
std::string example_recording();
std::string example_edits();
std::string example_gltf();
std::string example_world();

}  // namespace psygen::fuzz
