// Random and stepped values for fields, and the locks that exclude fields from randomising. Values
// are TOML for world::with_value(). It changes no text (document.hpp). Main thread.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "engine/core/error.hpp"
#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

// Returns a random value: from the soft range of a field, uniformly on its scale, with three
// digits; any choice; any seed of 63 bits. Ranges get two sorted values. Returns nullopt for texts,
// images and the number of blocks. The same random numbers give the same value.
std::optional<std::string> random_value(const world::WorldField& field, std::mt19937_64& random);

// Returns the value `steps` further, within the hard range. A step is 1 for seeds and integers, a
// hundredth of the soft range for reals, or on a logarithmic scale a hundredth of its decades.
// Choices and booleans wrap around; both ends of a range move. Returns nullopt for texts, images,
// colours and fields without a value.
std::optional<std::string> stepped_value(const world::WorldField& field, int steps);

// The fields that are excluded from randomising. State of the editor, kept in its state folder.
class FieldLocks {
 public:
  // True if the field or a table that contains it is locked.
  bool is_locked(const world::TextPath& path) const;
  void set_locked(const world::TextPath& path, bool locked);
  // Adjusts the locks after an item of an array was removed, added or moved.
  void note_removed(const world::TextPath& item);
  void note_inserted(const world::TextPath& item);
  void note_moved(const world::TextPath& item, std::size_t to);
  bool empty() const { return paths_.empty(); }

  // Loads and saves the locks of a world file in the state folder. Without a file, load() returns
  // no locks. Saving fails with kIo.
  static FieldLocks load(const std::filesystem::path& state_folder,
                         const std::filesystem::path& world_file);
  core::Result<void> save(const std::filesystem::path& state_folder,
                          const std::filesystem::path& world_file) const;
  friend bool operator==(const FieldLocks&, const FieldLocks&) = default;

 private:
  // Replaces the index of every lock in items of the array by next(index); nullopt removes the
  // lock.
  void renumber(const world::TextPath& array,
                const std::function<std::optional<std::size_t>(std::size_t)>& next);
  std::set<std::string> paths_;  // as TextPath::text() writes them
};

}  // namespace psygen::editor
