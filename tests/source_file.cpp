#include "tests/source_file.hpp"

namespace psygen {

std::string source_file(std::string_view name) {
  return std::string(PSYGEN_SOURCE_DIR "/").append(name);
}

}  // namespace psygen
