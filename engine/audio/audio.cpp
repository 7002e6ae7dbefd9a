#include "engine/audio/audio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <unordered_map>

#include "engine/audio/output.hpp"
#include "engine/audio/sound_file.hpp"
#include "engine/core/log.hpp"

namespace psygen::audio {
namespace {

constexpr double kRetrySeconds = 2;
constexpr std::size_t kPieces = 4;  // of a stream that are queued, each a quarter of a second

// A piece of a stream that OpenAL has.
struct Piece {
  ALuint buffer = 0;
  std::size_t frames = 0;
};

struct Sound {
  SoundId id = SoundId::kNone;
  std::shared_ptr<const Clip> clip;  // or
  std::optional<SoundFile> file;
  Play how;
  double frame = 0;  // of a clip without a voice, or of the stream's first piece
  bool ended = false;
  double gain = 0;  // as heard, in this update
  bool chosen = false;
  ALuint source = 0;  // 0: no voice
  std::deque<Piece> pieces;
  bool file_ended = false;

  double rate_hz() const { return clip ? clip->rate_hz : file->rate_hz(); }
  double frames() const {
    return static_cast<double>(clip ? clip->frames() : static_cast<std::size_t>(file->frames()));
  }
};

core::Result<void> check(const Play& how, std::uint32_t channels) {
  const auto refuse = [](std::string_view what) {
    return core::fail(core::ErrorCode::kInvalidArgument, fmt::format("a sound {}", what));
  };
  const auto in = [](double value, double low, double high) {  // false for NaN
    return value >= low && value <= high;
  };
  if (!in(how.gain, 0, 4)) return refuse(fmt::format("has gain {}; 0 to 4 are allowed", how.gain));
  if (!in(how.pitch, 0.25, 4))
    return refuse(fmt::format("has pitch {}; 0.25 to 4 are allowed", how.pitch));
  if (!in(how.range.near_m, 1e-3, 1e9) || !in(how.range.far_m, 1e-3, 1e9) ||
      how.range.near_m >= how.range.far_m)
    return refuse(fmt::format("has a range of {} to {} m; 0.001 to 10^9 m are allowed",
                              how.range.near_m, how.range.far_m));
  if (!how.at) return {};
  if (channels != 1) return refuse("with a place must have one channel (mono())");
  if (!core::is_valid({*how.at, 0, 0})) return refuse("has a place that is not in any world");
  return {};
}

}  // namespace

struct Audio::State {
  AudioOptions options;
  std::unique_ptr<Output> output;
  double retry_in_s = 0;
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
  void choose(const core::CameraPose& listener);
  void give_voice(Sound& sound);
  void take_voice(Sound& sound);
  void set_source(const Sound& sound, const core::CameraPose& listener) const;
  bool queue_piece(Sound& sound, ALuint buffer);
  void follow(Sound& sound);
  void pass_silently(Sound& sound, double dt_s) const;
  void drop_unused();
};

void Audio::State::open() {
  if (options.destination == Destination::kNowhere) return;
  output = Output::open(options.destination == Destination::kRendered);
  retry_in_s = kRetrySeconds;
  if (output == nullptr && !told) {
    told = true;
    core::log_warning("there is no sound device; the program goes on without sound");
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
    core::log_warning("the sound device is gone; the program goes on without sound");
    told = true;
    close();
  }
  retry_in_s -= dt_s;
  if (retry_in_s <= 0) open();
}

Sound* Audio::State::find(SoundId id) {
  const auto at = std::find_if(sounds.begin(), sounds.end(),
                               [&](const Sound& sound) { return sound.id == id; });
  return at == sounds.end() ? nullptr : &*at;
}

// The loudest get voices. One that has a voice keeps it against one that is hardly louder.
void Audio::State::choose(const core::CameraPose& listener) {
  std::vector<Sound*> order;
  for (Sound& sound : sounds) {
    const auto bus = static_cast<std::size_t>(sound.how.bus);
    sound.gain = sound.how.gain * volumes[bus] * master;
    sound.chosen = false;
    if (sound.how.at) {
      const core::WorldPosition& at = *sound.how.at;
      const glm::dvec3 corner = core::offset_m(at.block, listener.position, options.block_size_m);
      const glm::dvec3 place = corner + at.local;
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

// Fills a buffer with the next quarter of a second and queues it. False at the end.
bool Audio::State::queue_piece(Sound& sound, ALuint buffer) {
  const std::uint32_t channels = sound.file->channels();
  std::vector<std::int16_t> samples(std::size_t{sound.file->rate_hz()} / 4 * channels);
  std::size_t filled = 0;
  for (bool rewound = false; filled < samples.size();) {
    const std::size_t read = sound.file->read(std::span(samples).subspan(filled)) * channels;
    filled += read;
    if (read > 0) rewound = false;
    if (read > 0) continue;
    if (!sound.how.loop || rewound) break;
    sound.file->seek(0);
    rewound = true;
  }
  if (filled == 0) return false;
  alBufferData(buffer, channels == 2 ? AL_FORMAT_STEREO16 : AL_FORMAT_MONO16, samples.data(),
               static_cast<ALsizei>(filled * sizeof(std::int16_t)),
               static_cast<ALsizei>(sound.file->rate_hz()));
  alSourceQueueBuffers(sound.source, 1, &buffer);
  sound.pieces.push_back({buffer, filled / channels});
  return true;
}

void Audio::State::give_voice(Sound& sound) {
  alGetError();
  alGenSources(1, &sound.source);
  if (alGetError() != AL_NO_ERROR) {
    sound.source = 0;  // the device has fewer voices than were asked for
    return;
  }
  alSourcef(sound.source, AL_MAX_GAIN, 4);
  if (sound.clip) {
    Loaded& entry = loaded[sound.clip.get()];
    if (entry.buffer == 0)
      entry = {sound.clip,
               make_buffer(sound.clip->samples, sound.clip->channels, sound.clip->rate_hz)};
    alSourcei(sound.source, AL_BUFFER, static_cast<ALint>(entry.buffer));
    alSourcei(sound.source, AL_SAMPLE_OFFSET, static_cast<ALint>(sound.frame));
    return;
  }
  sound.file->seek(static_cast<std::uint64_t>(sound.frame));
  sound.file_ended = false;
  for (std::size_t i = 0; i < kPieces && !sound.file_ended; ++i) {
    ALuint buffer = 0;
    alGenBuffers(1, &buffer);
    sound.file_ended = !queue_piece(sound, buffer);
    if (sound.file_ended) alDeleteBuffers(1, &buffer);
  }
}

void Audio::State::take_voice(Sound& sound) {
  if (sound.source == 0) return;
  ALint offset = 0, state = AL_INITIAL;
  alGetSourcei(sound.source, AL_SAMPLE_OFFSET, &offset);
  alGetSourcei(sound.source, AL_SOURCE_STATE, &state);
  if (sound.clip && state == AL_STOPPED) sound.ended = true;  // since the last update
  sound.frame = sound.clip ? offset : sound.frame + offset;
  if (sound.how.loop && sound.frames() > 0) sound.frame = std::fmod(sound.frame, sound.frames());
  alSourceStop(sound.source);
  alSourcei(sound.source, AL_BUFFER, 0);
  alDeleteSources(1, &sound.source);
  for (const Piece& piece : sound.pieces)
    alDeleteBuffers(1, &piece.buffer);
  sound.pieces.clear();
  sound.source = 0;
}

void Audio::State::set_source(const Sound& sound, const core::CameraPose& listener) const {
  glm::vec3 place{0};
  if (sound.how.at)
    place = glm::vec3(core::offset_m(sound.how.at->block, listener.position, options.block_size_m) +
                      sound.how.at->local);
  alSource3f(sound.source, AL_POSITION, place.x, place.y, place.z);
  alSourcei(sound.source, AL_SOURCE_RELATIVE, sound.how.at ? AL_FALSE : AL_TRUE);
  alSourcef(sound.source, AL_GAIN, static_cast<float>(sound.gain));
  alSourcef(sound.source, AL_PITCH, static_cast<float>(sound.how.pitch));
  if (sound.clip) alSourcei(sound.source, AL_LOOPING, sound.how.loop ? AL_TRUE : AL_FALSE);
}

// Starts what has a new voice, feeds streams, notices ends.
void Audio::State::follow(Sound& sound) {
  if (sound.file) {
    ALint played = 0;
    for (alGetSourcei(sound.source, AL_BUFFERS_PROCESSED, &played); played > 0; --played) {
      ALuint buffer = 0;
      alSourceUnqueueBuffers(sound.source, 1, &buffer);
      sound.frame += static_cast<double>(sound.pieces.front().frames);
      sound.pieces.pop_front();
      if (!sound.file_ended) sound.file_ended = !queue_piece(sound, buffer);
      if (sound.file_ended) alDeleteBuffers(1, &buffer);
    }
  }
  ALint state = AL_INITIAL;
  alGetSourcei(sound.source, AL_SOURCE_STATE, &state);
  if (state == AL_PLAYING) return;
  if (state == AL_INITIAL || (sound.file && !sound.pieces.empty())) {
    alSourcePlay(sound.source);  // new, or a stream that was fed too late
  } else {
    sound.ended = true;
  }
}

void Audio::State::pass_silently(Sound& sound, double dt_s) const {
  if (paused[static_cast<std::size_t>(sound.how.bus)]) return;
  sound.frame += dt_s * sound.rate_hz() * sound.how.pitch;
  if (sound.frame < sound.frames()) return;
  sound.ended = !sound.how.loop || sound.frames() <= 0;
  if (!sound.ended) sound.frame = std::fmod(sound.frame, sound.frames());
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
    state_->take_voice(*sound);
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
  if (!core::is_valid(listener) || !(dt_s >= 0)) return;
  State& s = *state_;
  s.check_device(dt_s);
  if (s.output != nullptr) {
    s.choose(listener);
    const glm::mat4 view = core::view_rotation(listener);
    s.output->set_listener(core::forward_of(listener), {view[0][1], view[1][1], view[2][1]});
    for (Sound& sound : s.sounds)
      if (!sound.chosen) s.take_voice(sound);
  }
  for (Sound& sound : s.sounds) {
    if (s.output != nullptr && sound.chosen) {
      if (sound.source == 0) s.give_voice(sound);
    }
    if (sound.source == 0) {
      s.pass_silently(sound, dt_s);
    } else {
      s.set_source(sound, listener);
      s.follow(sound);
    }
  }
  s.drop_unused();
}

void Audio::set_destination(Destination destination) {
  state_->close();
  state_->options.destination = destination;
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
