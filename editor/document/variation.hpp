// Other values for fields: at random, or one step further; and which fields stay as they are.
// Values are TOML for world::with_value(). It changes no text (document.hpp). Main thread.
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

// A value drawn from the soft range of a field, evenly on its scale, with three digits; any choice;
// any seed of 63 bits. Ranges get two values in order. Nothing for texts, pictures and the number
// of blocks. The same random numbers give the same value.
std::optional<std::string> random_value(const world::WorldField& field, std::mt19937_64& random);

// The value `steps` further, within the hard range: seeds and integers by ones, reals by hundredths
// of the soft range or, on a logarithmic scale, of its decades; choices and booleans around. Ranges
// move as a whole. Nothing for texts, pictures, colours and fields without a value.
std::optional<std::string> stepped_value(const world::WorldField& field, int steps);

// The fields that randomising leaves alone. State of the editor, kept beside the world file.
class FieldLocks {
 public:
  // Whether a field is locked, by itself or with a table that it is in.
  bool is_locked(const world::TextPath& path) const;
  void set_locked(const world::TextPath& path, bool locked);
  // An item of an array was removed, added or moved: locks go with their items.
  void note_removed(const world::TextPath& item);
  void note_inserted(const world::TextPath& item);
  void note_moved(const world::TextPath& item, std::size_t to);
  bool empty() const { return paths_.empty(); }

  // Keeps the locks of a world file in the state folder. Loading gives no locks where there are
  // none. Saving fails with kIo.
  static FieldLocks load(const std::filesystem::path& state_folder,
                         const std::filesystem::path& world_file);
  core::Result<void> save(const std::filesystem::path& state_folder,
                          const std::filesystem::path& world_file) const;
  friend bool operator==(const FieldLocks&, const FieldLocks&) = default;

 private:
  // Gives every lock in items of the array the index that `next` returns for its own; none: gone.
  void renumber(const world::TextPath& array,
                const std::function<std::optional<std::size_t>(std::size_t)>& next);
  std::set<std::string> paths_;  // as TextPath::text() writes them
};

}  // namespace psygen::editor
