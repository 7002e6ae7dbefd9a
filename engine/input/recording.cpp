#include "engine/input/recording.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <optional>

#include "engine/core/assert.hpp"
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

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

template <class Number>
void put(std::string& out, Number value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void put_varint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7)
    out += static_cast<char>(0x80 | (value & 0x7F));
  out += static_cast<char>(value);
}

// Takes numbers from bytes; nothing once they are too few.
struct Bytes {
  std::string_view rest;

  template <class Number>
  std::optional<Number> take() {
    if (rest.size() < sizeof(Number)) return std::nullopt;
    Number value;
    std::memcpy(&value, rest.data(), sizeof(value));
    rest.remove_prefix(sizeof(value));
    return value;
  }
  std::optional<std::string_view> take_text(std::size_t bytes) {
    if (rest.size() < bytes) return std::nullopt;
    const std::string_view text = rest.substr(0, bytes);
    rest.remove_prefix(bytes);
    return text;
  }
  std::optional<std::uint64_t> take_varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
      const auto byte = take<std::uint8_t>();
      if (!byte) return std::nullopt;
      value |= std::uint64_t{*byte & 0x7Fu} << shift;
      if (*byte < 0x80) return value;
    }
    return std::nullopt;
  }
};

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

// Reads a change on top of the states before it; false for one that cannot be.
bool take_change(Bytes& bytes, std::span<ActionState> states) {
  const auto action = bytes.take<std::uint8_t>();
  const auto flags = bytes.take<std::uint8_t>();
  if (!action || !flags || *action >= states.size()) return false;
  if ((*flags & ~(kHeld | kPressed | kReleased | kValue)) != 0) return false;
  ActionState& state = states[*action];
  if ((*flags & kValue) != 0) {
    const auto value = bytes.take<float>();
    if (!value || !std::isfinite(*value)) return false;
    state.value = *value;
  }
  state.held = (*flags & kHeld) != 0;
  state.pressed = (*flags & kPressed) != 0;
  state.released = (*flags & kReleased) != 0;
  return true;
}

// Whether all changes can be read, and belong to steps that there are.
bool are_whole(std::string_view changes, std::size_t actions, std::uint64_t steps) {
  Bytes bytes{changes};
  std::vector<ActionState> states(actions);
  std::uint64_t step = 0;
  while (!bytes.rest.empty()) {
    const auto skipped = bytes.take_varint(), count = bytes.take_varint();
    if (!skipped || !count || *skipped == 0 || *skipped > steps - step || *count == 0) return false;
    step += *skipped;
    for (std::uint64_t i = 0; i < *count; ++i)
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
  PSYGEN_ASSERT(step_s > 0 && step_s <= kLongestStepS, "a fixed step has a length");
  for (ActionId id = 0; id < actions.size(); ++id)
    names_.push_back(actions.name(id));
}

core::Result<void> Recording::add(std::span<const ActionState> states) {
  PSYGEN_ASSERT(states.size() == last_.size(), "states of other actions");
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
  if (changes_.size() + changed.size() > kMostBytes) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("a recording has at most {} MiB", kMostBytes >> 20));
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
  Bytes rest{bytes.substr(kMagic.size())};
  const auto format = rest.take<std::uint32_t>();
  if (format && *format != kRecordingFormat) {
    return refused(name, fmt::format("its format is {}; this program reads format {}", *format,
                                     kRecordingFormat));
  }
  const std::size_t most_bytes = bytes.size() - std::min(bytes.size(), kHashBytes);
  Bytes hash{bytes.substr(most_bytes)};
  if (!format || hash.take<std::uint64_t>() != hash_of(bytes.substr(0, most_bytes)))
    return refused(name, "the recording is damaged or cut short");
  const tl::unexpected<core::Error> wrong = refused(name, "the recording contradicts itself");
  rest.rest.remove_suffix(kHashBytes);
  Recording recording;
  const auto step_s = rest.take<double>();
  const auto actions = rest.take<std::uint32_t>();
  const auto steps = rest.take<std::uint64_t>();
  const auto changes = rest.take<std::uint64_t>();
  if (!changes || !(*step_s > 0 && *step_s <= kLongestStepS) || *actions > Actions::kMostActions ||
      *steps > kMostSteps)
    return wrong;
  for (std::uint32_t i = 0; i < *actions; ++i) {
    const auto length = rest.take<std::uint8_t>();
    const auto text = length ? rest.take_text(*length) : std::nullopt;
    if (!text) return wrong;
    recording.names_.emplace_back(*text);
  }
  if (rest.rest.size() != *changes || !are_whole(rest.rest, *actions, *steps)) return wrong;
  recording.step_s_ = *step_s;
  recording.steps_ = *steps;
  recording.changes_ = rest.rest;
  return recording;
}

core::Result<void> Recording::save(const std::filesystem::path& file) const {
  return core::replace_file(file, bytes());
}

core::Result<Recording> Recording::load(const std::filesystem::path& file) {
  const core::Result<std::string> bytes = world::read_text_file(file, 2 * kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse(*bytes, file.string());
}

core::Result<Replay> Replay::create(Recording recording, const Actions& actions, double step_s) {
  if (recording.step_s_ != step_s) {
    return core::fail(ErrorCode::kInvalidArgument,
                      fmt::format("the recording has {:.6g} steps a second, and this game {:.6g}",
                                  1 / recording.step_s_, 1 / step_s));
  }
  Replay replay(std::move(recording));
  for (const std::string& name : replay.recording_.names_) {
    const auto id = actions.find(name);
    if (!id) {
      return core::fail(ErrorCode::kInvalidArgument,
                        fmt::format("the recording has the action \"{}\", which this game has not",
                                    core::shown(name, Actions::kMostNameBytes)));
    }
    replay.ids_.push_back(*id);
  }
  replay.states_.resize(replay.ids_.size());
  Bytes bytes{replay.recording_.changes_};
  replay.next_change_ = bytes.take_varint().value_or(0);
  replay.at_ = replay.recording_.changes_.size() - bytes.rest.size();
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
    Bytes bytes{std::string_view(recording_.changes_).substr(at_)};
    for (std::uint64_t count = bytes.take_varint().value_or(0); count > 0; --count)
      take_change(bytes, states_);
    if (const auto skipped = bytes.take_varint()) next_change_ += *skipped;
    at_ = recording_.changes_.size() - bytes.rest.size();
  }
  for (std::size_t i = 0; i < ids_.size(); ++i)
    all[ids_[i]] = states_[i];
  actions.step_to(all);
  return true;
}

}  // namespace psygen::input
