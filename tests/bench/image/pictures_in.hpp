// Lists the images of psygen fly --images in a folder, sorted by name.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

namespace psygen::bench {

inline std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

}  // namespace psygen::bench
