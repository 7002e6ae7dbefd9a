#include "game/play/saved.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/world/files/text_file.hpp"
#include "game/play/land.hpp"

namespace cairns {
namespace {

constexpr std::int64_t kFormat = 1;  // version of the values below
constexpr const char* kSuffix = ".cairns";
constexpr const char* kInvalid = "the save contains invalid numbers";
constexpr double kFarthestM = 1e9;  // grids of the game have 32-bit indices
constexpr const char* kTooFar =
    "a position in the save is not finite or farther than 1e9 m from the world's origin";
constexpr double kLongestS = 1e9;  // of a game and its fires
constexpr std::int64_t kMaxCarried = 1'000'000;
constexpr const char* kLast = "last.txt";  // holds the seed of the last opened save
constexpr std::uint64_t kMaxLastBytes = 64;

// Returns plain numbers as the bytes of one value.
template <class T>
save::Bytes bytes_of(const std::vector<T>& values) {
  save::Bytes bytes(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

struct Seen {
  std::uint64_t cell, kind;
};
struct Place {
  std::int32_t block_x, block_z;
  double x, y, z, until_s;
};
static_assert(std::is_trivially_copyable_v<Place> && sizeof(Place) == 40);

Place stored(const core::WorldPosition& at, double until_s = 0) {
  return {at.block.x, at.block.z, at.local.x, at.local.y, at.local.z, until_s};
}

// Reads values by name, and keeps the first error.
class Reader {
 public:
  explicit Reader(const save::SaveGame& save) : save_(save) {}
  template <class T>
  T get(const char* name) {
    const auto value = save_.value(name);
    if (!value && !error_) error_ = value.error();
    if (!value) return {};
    if (const T* found = std::get_if<T>(&*value)) return *found;
    refuse(std::string("the value \"") + name + "\" is missing");
    return {};
  }
  template <class T>
  std::vector<T> list(const char* name) {
    const auto bytes = get<save::Bytes>(name);
    if (bytes.size() % sizeof(T) != 0) refuse(std::string("\"") + name + "\" is truncated");
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
  }
  void refuse(const std::string& sentence) {
    if (!error_) error_ = {core::ErrorCode::kParse, save_.file().string() + ": " + sentence};
  }
  const std::optional<core::Error>& error() const { return error_; }

 private:
  const save::SaveGame& save_;
  std::optional<core::Error> error_;
};

Progress read_progress(Reader& in, double block_m) {
  const auto position = [&](const Place& place) {
    const core::WorldPosition at{{place.block_x, place.block_z}, {place.x, place.y, place.z}};
    const glm::dvec3 way = way_m({}, at, block_m);
    const auto is_near = [](double m) { return std::abs(m) <= kFarthestM; };  // false for NaN
    if (!is_near(way.x) || !is_near(way.y) || !is_near(way.z)) in.refuse(kTooFar);
    return at;
  };
  Progress p;
  if (in.get<std::int64_t>("format") > kFormat)
    in.refuse("a newer version of the game wrote this save");
  const auto feet = in.list<Place>("feet"), fires = in.list<Place>("fires"),
             waymarks = in.list<Place>("waymarks");
  if (feet.size() != 1) in.refuse("the position of the player is missing");
  if (!feet.empty()) p.feet = position(feet[0]);
  p.yaw = in.get<double>("yaw");
  p.time_s = in.get<double>("time_s");
  p.found = std::bitset<kCairns>(static_cast<std::uint64_t>(in.get<std::int64_t>("found")));
  const auto count = [&](const char* name) {
    const auto value = in.get<std::int64_t>(name);
    if (value < 0 || value > kMaxCarried) in.refuse(kInvalid);
    return static_cast<int>(value);
  };
  p.stock.stones = count("stones");
  p.stock.wood = count("wood");
  p.lantern = in.get<std::int64_t>("lantern") != 0;
  for (const Place& fire : fires) {
    p.fires.push_back({position(fire), fire.until_s});
    if (!(fire.until_s >= 0 && fire.until_s < kLongestS)) in.refuse(kInvalid);
  }
  for (const Place& mark : waymarks)
    p.waymarks.push_back(position(mark));
  for (const Seen& seen : in.list<Seen>("seen"))
    p.seen[seen.cell] = static_cast<std::uint8_t>(std::min<std::uint64_t>(seen.kind, kMapWater));
  if (!std::isfinite(p.yaw) || !(p.time_s >= 0 && p.time_s < kLongestS)) in.refuse(kInvalid);
  return p;
}

core::Result<void> put_progress(save::SaveGame& save, const Progress& p) {
  std::vector<Place> fires, waymarks;
  for (const Fire& fire : p.fires)
    fires.push_back(stored(fire.at, fire.until_s));
  for (const core::WorldPosition& at : p.waymarks)
    waymarks.push_back(stored(at));
  std::vector<Seen> seen;
  for (const auto& [cell, kind] : p.seen)
    seen.push_back({cell, kind});
  const std::pair<const char*, save::Value> values[] = {
      {"format", kFormat},
      {"feet", bytes_of(std::vector<Place>{stored(p.feet)})},
      {"yaw", p.yaw},
      {"time_s", p.time_s},
      {"found", static_cast<std::int64_t>(p.found.to_ullong())},
      {"stones", std::int64_t{p.stock.stones}},
      {"wood", std::int64_t{p.stock.wood}},
      {"lantern", std::int64_t{p.lantern}},
      {"fires", bytes_of(fires)},
      {"waymarks", bytes_of(waymarks)},
      {"seen", bytes_of(seen)}};
  for (const auto& [name, value] : values) {
    if (auto ok = save.put_value(name, value); !ok) return ok;
  }
  return {};
}

}  // namespace

std::filesystem::path save_file(const std::filesystem::path& folder, std::uint64_t seed) {
  return folder / (std::to_string(seed) + kSuffix);
}

// File times do not help here, because the system clock may have been set back.
std::optional<std::uint64_t> last_seed(const std::filesystem::path& folder) {
  const auto text = world::read_text_file(folder / kLast, kMaxLastBytes);
  if (!text) return std::nullopt;
  std::string name;
  if (!(std::istringstream(*text) >> name)) return std::nullopt;
  std::error_code error;
  const std::uint64_t seed = seed_of(name);
  if (!std::filesystem::exists(save_file(folder, seed), error)) return std::nullopt;
  return seed;
}

core::Result<Saved> Saved::open(const std::filesystem::path& file, Play& play) {
  auto save = save::SaveGame::open(file, play.world(), play.registry(),
                                   {.accept = save::Accept::kChangedWorld});
  if (!save) return tl::unexpected(save.error());
  if (auto ok = core::replace_file(file.parent_path() / kLast, file.stem().string()); !ok)
    core::log_warning(ok.error().message);  // "Continue" then opens an older game
  Saved saved(std::move(*save));
  const auto format = saved.save_->value("format");
  if (!format) return tl::unexpected(format.error());
  if (std::holds_alternative<std::monostate>(*format)) return saved;  // a new save
  if (auto ok = saved.resume(play); !ok) return tl::unexpected(ok.error());
  saved.note_changes();
  return saved;
}

void Saved::note_changes() {
  std::size_t count = 0;
  for (const save::Misfit& misfit : save_->misfits()) {
    count += misfit.count;
    core::log_warning(save_->file().string() + ": " + std::to_string(misfit.count) +
                      " of your changes in block (" + std::to_string(misfit.block.x) + ", " +
                      std::to_string(misfit.block.z) + ") no longer fit: " + misfit.reason);
  }
  const auto is_visible = [](const save::PartChange& change) {
    return change.kind != save::PartKind::kLooks;
  };
  if (count == 0 && std::ranges::none_of(save_->world_changes(), is_visible)) return;
  notice_ = {"The land has changed since your last visit.",
             count == 0
                 ? "Everything that you changed is still here."
                 : std::to_string(count) + " of your changes no longer fit. The save keeps them."};
}

core::Result<void> Saved::resume(Play& play) {
  Reader in(*save_);
  Progress progress = read_progress(in, play.block_m());
  if (in.error()) return tl::unexpected(*in.error());
  const auto edits = save_->load_edits(play.world(), play.registry());
  if (!edits) return tl::unexpected(edits.error());
  stored_ = *edits;
  return play.resume(std::move(progress), *edits);
}

core::Result<void> Saved::put(const Play& play) {
  (void)wait();  // this put() also writes what a failed write left out
  const world::Edits& now = play.edits();
  if (auto ok = save_->put_changes(stored_, now); !ok) return ok;
  if (auto ok = put_progress(*save_, play.progress()); !ok) return ok;
  stored_ = now;
  writing_ = std::async(std::launch::async, [save = save_.get()] { return save->save(); });
  return {};
}

core::Result<void> Saved::wait() {
  return writing_.valid() ? writing_.get() : core::Result<void>();
}

std::optional<core::Result<void>> Saved::outcome() {
  using namespace std::chrono_literals;
  if (!writing_.valid() || writing_.wait_for(0s) != std::future_status::ready) return std::nullopt;
  return writing_.get();
}

}  // namespace cairns
