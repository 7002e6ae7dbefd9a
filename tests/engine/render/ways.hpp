// The ways of drawing that a test is run for. Sanitizers see the first and the last of them: what
// the others have of their own is in shaders, and the pictures themselves are held in release.
#pragma once

#include <gtest/gtest.h>

#include <vector>

namespace psygen::render {

template <class Way>
auto in_ways(std::vector<Way> ways) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  if (ways.size() > 2) ways.erase(ways.begin() + 1, ways.end() - 1);
#endif
  return testing::ValuesIn(ways);
}

}  // namespace psygen::render
