#include "engine/audio/audio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "engine/audio/voice.hpp"
#include "engine/core/log.hpp"

namespace psygen::audio {
namespace {

// Delay before the first search for a missing device; it doubles with each search. A search asks
// the system's sound server, which takes milliseconds.
constexpr double kFirstRetryS = 2, kLongestRetryS = 64;
constexpr double kMaxSecondsAtOnce = 60;

core::Result<void> check(const Play& how, std::uint32_t channels) {
  const auto refuse = [](std::string_view what) {
    return core::fail(core::ErrorCode::kInvalidArgument, fmt::format("a sound {}", what));
  };
  const auto in = [](double value, double low, double high) {  // false for NaN
    return value >= low && value <= high;
  };
  if (!in(how.gain, 0, 4)) return refuse(fmt::format("has gain {}; it must be 0 to 4", how.gain));
  if (!in(how.pitch, 0.25, 4))
    return refuse(fmt::format("has pitch {}; it must be 0.25 to 4", how.pitch));
  if (!in(how.range.near_m, 1e-3, 1e9) || !in(how.range.far_m, 1e-3, 1e9) ||
      how.range.near_m >= how.range.far_m)
    return refuse(fmt::format("has a range of {} to {} m; it must be within 0.001 to 10^9 m",
                              how.range.near_m, how.range.far_m));
  if (!how.at) return {};
  if (channels != 1) return refuse("with a position must have one channel (mono())");
  if (!core::is_valid({*how.at, 0, 0}))
    return refuse("has a position that is not finite or is out of range");
  return {};
}

}  // namespace

double attenuation(double distance_m, const Range& range) {
  if (distance_m <= range.near_m) return 1;
  if (!(distance_m < range.far_m)) return 0;
  return range.near_m / distance_m * (range.far_m - distance_m) / (range.far_m - range.near_m);
}

struct Audio::State {
  AudioOptions options;
  std::unique_ptr<Output> output;
  double retry_in_s = kFirstRetryS, next_retry_s = kFirstRetryS;
  core::CameraPose listener;  // the last valid pose
  bool told = false;
  std::uint64_t last_id = 0;
  std::vector<Sound> sounds;
  struct Loaded {
    std::shared_ptr<const Clip> clip;
    ALuint buffer = 0;
  };
  std::unordered_map<const Clip*, Loaded> loaded;
  std::array<double, 2> volumes{1, 1};
  std::array<bool, 2> paused{};
  double master = 1;

  void open();
  void close();
  void check_device(double dt_s);
  Sound* find(SoundId id);
  void choose();
  glm::vec3 place_of(const Sound& sound) const;
  ALuint buffer_of(const Sound& sound);
  void step(Sound& sound, double dt_s);
  void drop_unused();
};

void Audio::State::open() {
  if (options.destination == Destination::kNowhere) return;
  output = Output::open(options.destination == Destination::kRendered);
  if (output == nullptr && !told) {
    told = true;
    core::log_warning("no sound device was found; the program continues without sound");
  }
}

void Audio::State::close() {
  if (output == nullptr) return;
  output->use();
  for (Sound& sound : sounds)
    take_voice(sound);
  for (auto& [clip, entry] : loaded)
    alDeleteBuffers(1, &entry.buffer);
  loaded.clear();
  output.reset();
}

void Audio::State::check_device(double dt_s) {
  if (output != nullptr) {
    output->use();
    if (output->connected()) return;
    core::log_warning("the sound device was lost; the program continues without sound");
    told = true;
    close();
    retry_in_s = next_retry_s = kFirstRetryS;
  }
  retry_in_s -= dt_s;
  if (retry_in_s > 0) return;
  next_retry_s = std::min(2 * next_retry_s, kLongestRetryS);
  retry_in_s = next_retry_s;
  open();
}

Sound* Audio::State::find(SoundId id) {
  const auto at = std::find_if(sounds.begin(), sounds.end(),
                               [&](const Sound& sound) { return sound.id == id; });
  return at == sounds.end() ? nullptr : &*at;
}

// The position in metres from the listener; meaningless for a sound without a position.
glm::vec3 Audio::State::place_of(const Sound& sound) const {
  if (!sound.how.at) return glm::vec3(0);
  return glm::vec3(core::offset_m(sound.how.at->block, listener.position, options.block_size_m) +
                   sound.how.at->local);
}

// Gives voices to the loudest sounds. A sound keeps its voice against one that is hardly louder.
void Audio::State::choose() {
  std::vector<Sound*> order;
  for (Sound& sound : sounds) {
    const auto bus = static_cast<std::size_t>(sound.how.bus);
    sound.gain = sound.how.gain * volumes[bus] * master;
    sound.chosen = false;
    if (sound.how.at) {
      const glm::dvec3 place(place_of(sound));
      sound.gain *= attenuation(std::hypot(place.x, place.y, place.z), sound.how.range);
    }
    if (sound.gain > 0 && !paused[bus] && !sound.ended) order.push_back(&sound);
  }
  const auto weight = [](const Sound* s) { return s->gain * (s->source != 0 ? 1.1 : 1.0); };
  std::stable_sort(order.begin(), order.end(),
                   [&](const Sound* a, const Sound* b) { return weight(a) > weight(b); });
  if (order.size() > options.max_voices) order.resize(options.max_voices);
  for (Sound* sound : order)
    sound->chosen = true;
}

// The buffer with the samples of a clip; 0 for a stream.
ALuint Audio::State::buffer_of(const Sound& sound) {
  if (!sound.clip) return 0;
  Loaded& entry = loaded[sound.clip.get()];
  if (entry.buffer == 0)
    entry = {sound.clip,
             make_buffer(sound.clip->samples, sound.clip->channels, sound.clip->rate_hz)};
  return entry.buffer;
}

void Audio::State::step(Sound& sound, double dt_s) {
  if (output != nullptr && sound.chosen && sound.source == 0) give_voice(sound, buffer_of(sound));
  if (sound.source != 0) {
    set_source(sound, place_of(sound));
    follow(sound);
  } else if (!paused[static_cast<std::size_t>(sound.how.bus)]) {
    pass_silently(sound, dt_s);
  }
}

void Audio::State::drop_unused() {
  for (Sound& sound : sounds)
    if (sound.ended && output != nullptr) take_voice(sound);
  std::erase_if(sounds, [](const Sound& sound) { return sound.ended; });
  std::erase_if(loaded, [](auto& entry) {
    if (entry.second.clip.use_count() > 1) return false;
    alDeleteBuffers(1, &entry.second.buffer);
    return true;
  });
}

Audio::Audio(const AudioOptions& options) : state_(std::make_unique<State>()) {
  state_->options = options;
  state_->options.max_voices = std::clamp(options.max_voices, 1U, 256U);
  state_->open();
}

Audio::~Audio() {
  state_->close();
}

core::Result<SoundId> Audio::play(std::shared_ptr<const Clip> clip, const Play& how) {
  if (clip == nullptr) return core::fail(core::ErrorCode::kInvalidArgument, "a sound has no clip");
  if (auto ok = check_clip(*clip); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(how, clip->channels); !ok) return tl::unexpected(ok.error());
  Sound& sound = state_->sounds.emplace_back();
  sound.id = static_cast<SoundId>(++state_->last_id);
  sound.clip = std::move(clip);
  sound.how = how;
  return sound.id;
}

core::Result<SoundId> Audio::stream(const std::filesystem::path& file, const Play& how) {
  auto opened = SoundFile::open(file);
  if (!opened) return tl::unexpected(opened.error());
  if (auto ok = check(how, opened->channels()); !ok) return tl::unexpected(ok.error());
  Sound& sound = state_->sounds.emplace_back();
  sound.id = static_cast<SoundId>(++state_->last_id);
  sound.file = std::move(*opened);
  sound.how = how;
  return sound.id;
}

core::Result<void> Audio::change(SoundId id, const Play& how) {
  Sound* sound = state_->find(id);
  if (sound == nullptr) return {};
  if (auto ok = check(how, sound->clip ? sound->clip->channels : sound->file->channels()); !ok)
    return ok;
  sound->how = how;
  return {};
}

void Audio::stop(SoundId id) {
  Sound* sound = state_->find(id);
  if (sound == nullptr) return;
  if (state_->output != nullptr) {
    state_->output->use();
    take_voice(*sound);
  }
  state_->sounds.erase(state_->sounds.begin() + (sound - state_->sounds.data()));
}

bool Audio::plays(SoundId sound) const {
  return state_->find(sound) != nullptr;
}

std::size_t Audio::playing() const {
  return state_->sounds.size();
}

std::size_t Audio::heard() const {
  return static_cast<std::size_t>(
      std::count_if(state_->sounds.begin(), state_->sounds.end(),
                    [](const Sound& sound) { return sound.source != 0; }));
}

void Audio::set_master_volume(double volume) {
  state_->master = volume > 0 ? std::min(volume, 1.0) : 0;
}

void Audio::set_volume(Bus bus, double volume) {
  state_->volumes[static_cast<std::size_t>(bus)] = volume > 0 ? std::min(volume, 1.0) : 0;
}

void Audio::set_paused(Bus bus, bool paused) {
  state_->paused[static_cast<std::size_t>(bus)] = paused;
}

void Audio::update(const core::CameraPose& listener, double dt_s) {
  State& s = *state_;
  if (core::is_valid(listener)) s.listener = listener;
  dt_s = dt_s > 0 ? std::min(dt_s, kMaxSecondsAtOnce) : 0;
  s.check_device(dt_s);
  if (s.output != nullptr) {
    s.choose();
    const glm::mat4 view = core::view_rotation(s.listener);
    s.output->set_listener(core::forward_of(s.listener), {view[0][1], view[1][1], view[2][1]});
    for (Sound& sound : s.sounds)
      if (!sound.chosen) take_voice(sound);
  }
  for (Sound& sound : s.sounds)
    s.step(sound, dt_s);
  s.drop_unused();
}

void Audio::set_destination(Destination destination) {
  state_->close();
  state_->options.destination = destination;
  state_->retry_in_s = state_->next_retry_s = kFirstRetryS;
  state_->open();
}

bool Audio::has_output() const {
  return state_->output != nullptr;
}

std::vector<float> Audio::render(std::size_t frames) {
  frames = std::min(frames, std::size_t{1} << 20);
  if (state_->output == nullptr) return std::vector<float>(frames * 2);
  state_->output->use();
  return state_->output->render(frames);
}

}  // namespace psygen::audio
