#include "engine/input/recording.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/core/bytes.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::input {
namespace {

using core::ErrorCode;

constexpr std::string_view kMagic = "psygenIN";
constexpr std::uint8_t kHeld = 1, kPressed = 2, kReleased = 4, kValue = 8;
constexpr std::size_t kHashBytes = 8;
constexpr double kLongestStepS = 10;

using core::ByteReader;
using core::put;
using core::put_varint;

std::uint64_t hash_of(std::string_view bytes) {
  return core::hash_bytes(std::as_bytes(std::span(bytes.data(), bytes.size())));
}

void put_change(std::string& out, std::uint8_t action, const ActionState& before,
                const ActionState& now) {
  const bool value =
      std::bit_cast<std::uint32_t>(before.value) != std::bit_cast<std::uint32_t>(now.value);
  put(out, action);
  put(out, static_cast<std::uint8_t>((now.held ? kHeld : 0) | (now.pressed ? kPressed : 0) |
                                     (now.released ? kReleased : 0) | (value ? kValue : 0)));
  if (value) put(out, now.value);
}

// Reads a change relative to the previous states. Returns false for an impossible one.
bool take_change(ByteReader& bytes, std::span<ActionState> states) {
  const auto action = bytes.get<std::uint8_t>();
  const auto flags = bytes.get<std::uint8_t>();
  if (bytes.failed() || action >= states.size()) return false;
  if ((flags & ~(kHeld | kPressed | kReleased | kValue)) != 0) return false;
  ActionState& state = states[action];
  if ((flags & kValue) != 0) {
    const auto value = bytes.get<float>();
    if (bytes.failed() || !std::isfinite(value)) return false;
    state.value = value;
  }
  state.held = (flags & kHeld) != 0;
  state.pressed = (flags & kPressed) != 0;
  state.released = (flags & kReleased) != 0;
  return true;
}

// True if all changes can be read and belong to existing steps.
bool are_whole(std::string_view changes, std::size_t actions, std::uint64_t steps) {
  ByteReader bytes(changes);
  std::vector<ActionState> states(actions);
  std::uint64_t step = 0;
  while (bytes.left() > 0) {
    const std::uint64_t skipped = bytes.get_varint(), count = bytes.get_varint();
    if (skipped == 0 || skipped > steps - step || count == 0) return false;  // 0: or failed
    step += skipped;
    for (std::uint64_t i = 0; i < count; ++i)
      if (!take_change(bytes, states)) return false;
  }
  return true;
}

tl::unexpected<core::Error> refused(std::string_view name, std::string_view reason) {
  return core::fail(ErrorCode::kParse, fmt::format("{}: {}", name, reason));
}

bool same(const ActionState& a, const ActionState& b) {
  return a == b && std::bit_cast<std::uint32_t>(a.value) == std::bit_cast<std::uint32_t>(b.value);
}

}  // namespace

Recording::Recording(const Actions& actions, double step_s)
    : step_s_(step_s), last_(actions.size()) {
  PSYGEN_ASSERT(step_s > 0 && step_s <= kLongestStepS,
                "the length of a fixed step must be positive");
  for (ActionId id = 0; id < actions.size(); ++id)
    names_.push_back(actions.name(id));
}

core::Result<void> Recording::add(std::span<const ActionState> states) {
  PSYGEN_ASSERT(states.size() == last_.size(), "one state for each action");
  std::string changed;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (same(states[i], last_[i])) continue;
    put_change(changed, static_cast<std::uint8_t>(i), last_[i], states[i]);
    ++count;
  }
  if (count == 0) {
    ++steps_;
    return {};
  }
  if (changes_.size() + changed.size() > kMaxBytes) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("a recording may have at most {} MiB", kMaxBytes >> 20));
  }
  ++steps_;
  put_varint(changes_, steps_ - std::exchange(last_changed_, steps_));
  put_varint(changes_, count);
  changes_ += changed;
  last_.assign(states.begin(), states.end());
  return {};
}

std::string Recording::bytes() const {
  std::string out(kMagic);
  put(out, kRecordingFormat);
  put(out, step_s_);
  put(out, static_cast<std::uint32_t>(names_.size()));
  put(out, steps_);
  put(out, std::uint64_t{changes_.size()});
  for (const std::string& name : names_) {
    put(out, static_cast<std::uint8_t>(name.size()));
    out += name;
  }
  out += changes_;
  put(out, hash_of(out));
  return out;
}

core::Result<Recording> Recording::parse(std::string_view bytes, std::string_view name) {
  if (bytes.substr(0, kMagic.size()) != kMagic)
    return refused(name, "this is not a recording of input");
  const std::size_t max_bytes = bytes.size() - std::min(bytes.size(), kHashBytes);
  ByteReader rest(bytes.substr(kMagic.size()));
  const auto format = rest.get<std::uint32_t>();
  if (!rest.failed() && format != kRecordingFormat) {
    return refused(name, fmt::format("its format is {}; psygen {} reads format {}", format,
                                     core::version(), kRecordingFormat));
  }
  const auto hash = ByteReader(bytes.substr(max_bytes)).get<std::uint64_t>();
  if (rest.failed() || hash != hash_of(bytes.substr(0, max_bytes)))
    return refused(name, "the recording is damaged or cut short");
  const tl::unexpected<core::Error> wrong = refused(name, "the recording is inconsistent");
  Recording recording;
  const auto step_s = rest.get<double>();
  const auto actions = rest.get<std::uint32_t>();
  const auto steps = rest.get<std::uint64_t>();
  const auto changes = rest.get<std::uint64_t>();
  if (rest.failed() || !(step_s > 0 && step_s <= kLongestStepS) || actions > Actions::kMaxActions ||
      steps > kMaxSteps)
    return wrong;
  for (std::uint32_t i = 0; i < actions; ++i)
    recording.names_.emplace_back(rest.get_text(rest.get<std::uint8_t>()));
  if (rest.failed() || rest.left() < kHashBytes || rest.left() - kHashBytes != changes)
    return wrong;
  recording.changes_ = rest.get_text(changes);
  if (!are_whole(recording.changes_, actions, steps)) return wrong;
  recording.step_s_ = step_s;
  recording.steps_ = steps;
  return recording;
}

core::Result<void> Recording::save(const std::filesystem::path& file) const {
  return core::replace_file(file, bytes());
}

core::Result<Recording> Recording::load(const std::filesystem::path& file) {
  const core::Result<std::string> bytes = world::read_text_file(file, 2 * kMaxBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse(*bytes, file.string());
}

core::Result<Replay> Replay::create(Recording recording, const Actions& actions, double step_s) {
  if (recording.step_s_ != step_s) {
    return core::fail(
        ErrorCode::kInvalidArgument,
        fmt::format("the recording has {:.6g} steps per second, but this game has {:.6g}",
                    1 / recording.step_s_, 1 / step_s));
  }
  Replay replay(std::move(recording));
  for (const std::string& name : replay.recording_.names_) {
    const auto id = actions.find(name);
    if (!id) {
      return core::fail(ErrorCode::kInvalidArgument,
                        fmt::format("the recording has the action \"{}\", which this game lacks",
                                    core::shown(name, Actions::kMaxNameBytes)));
    }
    replay.ids_.push_back(*id);
  }
  replay.states_.resize(replay.ids_.size());
  ByteReader bytes(replay.recording_.changes_);
  replay.next_change_ = bytes.get_varint();  // 0: no change
  replay.at_ = replay.recording_.changes_.size() - bytes.left();
  return replay;
}

bool Replay::step(Actions& actions) {
  std::vector<ActionState> all(actions.size());
  if (step_ == recording_.steps_) {
    actions.step_to(all);
    return false;
  }
  ++step_;
  if (step_ == next_change_) {
    ByteReader bytes(std::string_view(recording_.changes_).substr(at_));
    for (std::uint64_t count = bytes.get_varint(); count > 0; --count)
      take_change(bytes, states_);
    next_change_ += bytes.get_varint();  // 0: that was the last one
    at_ = recording_.changes_.size() - bytes.left();
  }
  for (std::size_t i = 0; i < ids_.size(); ++i)
    all[ids_[i]] = states_[i];
  actions.step_to(all);
  return true;
}

}  // namespace psygen::input
