// The versions of the libraries of this program: those that CMake found, and those that are loaded
// now, which may be others. For bug reports. Main thread.
#pragma once

#include <string>
#include <vector>

namespace psygen::cli {

// A library. `loaded` is its version, else the name of its file with the version; empty for headers
// and libraries that are part of the program.
struct LibraryVersion {
  std::string name, compiled, loaded;
};

// All packages of CMake, the C library and OpenImageIO, which this function loads. If it cannot be
// loaded, its `loaded` is a sentence with the reason.
std::vector<LibraryVersion> library_versions();

}  // namespace psygen::cli
