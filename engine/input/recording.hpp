// A recording of actions: their states in every fixed step, as a compact file. Replaying gives the
// same states, bit by bit. Records no clock and nothing about the world: reproducing results from
// equal actions is up to the game. Plain values, one thread. Adding a step is linear in the
// actions; a step without changes takes no bytes.
//
// The file, little-endian: "psygenIN", u32 format, f64 seconds of a step, u32 actions, u64 steps,
// u64 bytes of changes; for each action u8 length and name; the changes; u64 hash of all bytes
// before. The changes of a step that has any: varint steps since the last such step, varint count,
// and for each change u8 action, u8 flags (1 held, 2 pressed, 4 released, 8 a new value follows),
// f32 value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/input/actions.hpp"

namespace psygen::input {

inline constexpr std::uint32_t kRecordingFormat = 1;

// The states of all actions in every step, and the names of the actions.
class Recording {
 public:
  static constexpr std::uint64_t kMaxBytes = 256ull << 20;
  static constexpr std::uint64_t kMaxSteps = 1ull << 40;

  // An empty recording of these actions, with the length of a fixed step in seconds, above 0.
  Recording(const Actions& actions, double step_s);

  // Appends the states of a step. Call it after Actions::step(), with the actions of the
  // constructor. Fails with kOverBudget, without adding, if the changes would exceed kMaxBytes.
  core::Result<void> add(std::span<const ActionState> states);

  // The names of the actions, in the order of the states.
  const std::vector<std::string>& actions() const { return names_; }
  // The length of a step in seconds.
  double step_s() const { return step_s_; }
  // The number of added steps.
  std::uint64_t steps() const { return steps_; }

  // Replaces the file as a whole. Fails with kIo.
  core::Result<void> save(const std::filesystem::path& file) const;
  // Fails with kIo, with kOverBudget for files that are too large, and with kParse for files that
  // are not recordings, of another format, cut short, or damaged in any byte.
  static core::Result<Recording> load(const std::filesystem::path& file);
  // The same from bytes; `name` is for messages.
  static core::Result<Recording> parse(std::string_view bytes, std::string_view name);
  // The bytes that save() writes. Linear in the changes.
  std::string bytes() const;

 private:
  friend class Replay;
  Recording() = default;

  std::vector<std::string> names_;
  double step_s_ = 0;
  std::uint64_t steps_ = 0;
  std::string changes_;
  std::vector<ActionState> last_;   // states of the last added step
  std::uint64_t last_changed_ = 0;  // number of the last step with changes, from 1
};

// Replays a recording: sets the states of actions step by step.
class Replay {
 public:
  // Prepares a replay for these actions, matched by name; actions that the recording does not have
  // stay at rest. Fails with kInvalidArgument for a recorded action that does not exist, and for a
  // fixed step of another length.
  static core::Result<Replay> create(Recording recording, const Actions& actions, double step_s);

  // Sets the states of the next step; call it instead of Actions::step(). After the last step it
  // returns false and sets all actions to rest.
  bool step(Actions& actions);
  // The number of steps that step() has not replayed yet.
  std::uint64_t steps_left() const { return recording_.steps_ - step_; }

 private:
  explicit Replay(Recording recording) : recording_(std::move(recording)) {}

  Recording recording_;
  std::vector<ActionId> ids_;        // ids of the recorded actions
  std::vector<ActionState> states_;  // states of all actions
  std::uint64_t step_ = 0, next_change_ = 0;
  std::size_t at_ = 0;  // offset in the changes
};

}  // namespace psygen::input
