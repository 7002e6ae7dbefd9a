#include "engine/cluster/meeting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <thread>

#include "engine/core/bytes.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::cluster {
namespace {

constexpr char kOk = '+', kError = '-';

std::string place_of(Peers& peers) {
  return fmt::format("rank {} ({}, {})", peers.rank(), peers.host(),
                     models::simd_targets().front());
}

// A network file system may cache for some seconds that a file does not exist.
constexpr int kLooks = 50;
constexpr std::chrono::milliseconds kBetweenLooks{100};

bool sees(const std::filesystem::path& file, const std::string& token) {
  for (int look = 0; look < kLooks; ++look) {
    if (look > 0) std::this_thread::sleep_for(kBetweenLooks);
    // Listing the folder makes such a file system refresh its cache.
    std::error_code error;
    for (std::filesystem::directory_iterator it(file.parent_path(), error), end;
         !error && it != end; it.increment(error)) {
    }
    const auto text = world::read_text_file(file);
    if (text && *text == token) return true;
    if (!std::filesystem::exists(file.parent_path(), error)) break;
  }
  return false;
}

TypeFingerprint known_type(const models::ModelType& type) {
  TypeFingerprint known{std::string(type.name()), type.identity(), type.level_count(), 0};
  const models::Parameters p = models::default_parameters(type);
  const int level = type.level_count() - 1;
  const auto mesh = synthesis::HeapDestination::make(type, p, level);
  if (!mesh) return known;
  const models::MeshView view = mesh->view();
  if (synthesis::synthesise_guarded(type, p, level, view).ok)
    known.sample_hash = core::combine(core::hash_bytes(view.vertices),
                                      core::hash_bytes(std::as_bytes(view.indices)));
  return known;
}

void put_text(std::string& out, const std::string& text) {
  core::put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

std::string text_from(core::ByteReader& in) {
  return std::string(in.get_text(in.get_count(1)));
}

// The version and the host come first, so that a rank of any version can read them.
struct Introduction {
  CompatibilityKey key;
  std::string host;
  unsigned threads = 0;
};

std::string bytes_of(const Introduction& mine) {
  std::string out;
  put_text(out, mine.key.version);
  put_text(out, mine.host);
  core::put(out, mine.threads);
  put_text(out, mine.key.world);
  core::put(out, mine.key.world_hash, static_cast<std::uint32_t>(mine.key.types.size()));
  for (const TypeFingerprint& type : mine.key.types) {
    put_text(out, type.name);
    core::put(out, type.identity, type.levels, type.sample_hash);
  }
  return out;
}

Introduction introduction_from(const std::string& bytes) {
  core::ByteReader in(bytes);
  Introduction other;
  other.key.version = text_from(in);
  other.host = text_from(in);
  in.read(other.threads);
  other.key.world = text_from(in);
  in.read(other.key.world_hash);
  const std::size_t types = in.get_count(1);
  for (std::size_t i = 0; i < types; ++i) {
    TypeFingerprint& type = other.key.types.emplace_back();
    type.name = text_from(in);
    in.read(type.identity, type.levels, type.sample_hash);
  }
  return other;
}

// Describes the first difference; empty if the keys are equal.
std::string difference(const CompatibilityKey& mine, const CompatibilityKey& theirs) {
  if (theirs.version != mine.version)
    return fmt::format("psygen {} instead of {}", theirs.version, mine.version);
  if (theirs.world_hash != mine.world_hash)
    return theirs.world == mine.world
               ? fmt::format("a different version of the world {}", mine.world)
               : fmt::format("the world {} instead of {}", theirs.world, mine.world);
  if (theirs.types.size() != mine.types.size())
    return fmt::format("{} model types instead of {}", theirs.types.size(), mine.types.size());
  for (std::size_t i = 0; i < mine.types.size(); ++i) {
    if (theirs.types[i].name != mine.types[i].name)
      return fmt::format("the model type {} instead of {}", theirs.types[i].name,
                         mine.types[i].name);
    if (theirs.types[i] != mine.types[i])
      return fmt::format("a different version of the model type {}, which makes other meshes",
                         mine.types[i].name);
  }
  return {};
}

}  // namespace

core::Result<void> agree(const core::Result<void>& mine, Peers& peers) {
  std::string text(1, kOk);
  if (!mine)
    text =
        fmt::format("{}{} {}", kError, static_cast<int>(mine.error().code), mine.error().message);
  const std::vector<std::string> all = peers.exchange(text);
  const bool is_everybodys = std::ranges::count(all, all.front()) == std::ssize(all);
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    const std::string& theirs = all[rank];
    if (theirs.empty() || theirs.front() == kOk) continue;
    int code = 0;
    const std::size_t space = theirs.find(' ');
    std::from_chars(theirs.data() + 1, theirs.data() + space, code);
    return core::fail(static_cast<core::ErrorCode>(code),
                      is_everybodys ? theirs.substr(space + 1)
                                    : fmt::format("rank {}: {}", rank, theirs.substr(space + 1)));
  }
  return {};
}

core::Result<void> check_same_job(const core::Result<amplify::JobKey>& mine, bool with_folder,
                                  Peers& peers) {
  if (auto ok = agree(mine, peers); !ok) return ok;
  const std::string place = place_of(peers);
  const std::vector<std::string> keys =
      peers.exchange(amplify::ledger_text({*mine, place, {}, {}, 0}));
  const auto first = amplify::parse_ledger(keys.front(), "rank 0");
  if (!first) return core::invalid_argument("rank 0 runs a different version of psygen");
  for (std::size_t rank = 1; rank < keys.size(); ++rank) {
    const auto other = amplify::parse_ledger(keys[rank], "rank");
    if (!other)
      return core::invalid_argument(
          fmt::format("rank {} runs a different version of psygen than rank 0", rank));
    const std::string different = amplify::difference(first->key, other->key);
    if (!different.empty())
      return core::invalid_argument(
          fmt::format("{} does not match {}: it has {}", other->part, first->part, different));
  }
  const std::vector<std::string> folders = peers.exchange(with_folder ? "1" : "0");
  for (std::size_t rank = 1; rank < folders.size(); ++rank) {
    if (folders[rank] != folders.front())
      return core::invalid_argument(fmt::format("rank {} has --out and rank {} has none",
                                                folders[rank] == "1" ? rank : 0,
                                                folders[rank] == "1" ? 0 : rank));
  }
  return {};
}

core::Result<void> check_folder(const std::filesystem::path& folder, Peers& peers) {
  const std::filesystem::path file = folder / ".psygen_shared";
  std::string token;
  core::Result<void> made{};
  if (peers.rank() == 0) {
    const auto now = std::chrono::system_clock::now().time_since_epoch().count();
    token = fmt::format("{} {}\n", peers.host(), now);
    made = telemetry::create_output_folder(folder);
    if (made) made = core::replace_file(file, token);
  }
  if (auto ok = agree(made, peers); !ok) return ok;
  token = peers.exchange(token).front();
  if (peers.rank() != 0 && !sees(file, token))
    made = core::invalid_argument(fmt::format(
        "{}: files that rank 0 writes there are not visible on {}; --out must be a folder "
        "that all ranks share",
        folder.string(), peers.host()));
  auto seen = agree(made, peers);
  if (peers.rank() == 0) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  return seen;
}

CompatibilityKey compatibility_key(const world::World& world, const models::Registry& registry,
                                   std::string_view version) {
  CompatibilityKey key{std::string(version), world.name, world::world_hash(world, registry), {}};
  for (models::ModelIndex i = 0; i < registry.size(); ++i)
    key.types.push_back(known_type(registry[i]));
  return key;
}

core::Result<std::vector<unsigned>> meet(const core::Result<CompatibilityKey>& mine,
                                         unsigned threads, Peers& peers) {
  if (auto ok = agree(mine, peers); !ok) return tl::unexpected(ok.error());
  const std::vector<std::string> all = peers.exchange(bytes_of({*mine, peers.host(), threads}));
  const Introduction first = introduction_from(all.front());
  std::vector<unsigned> threads_of;
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    const Introduction other = introduction_from(all[rank]);
    const std::string different = difference(first.key, other.key);
    if (!different.empty())
      return core::invalid_argument(
          fmt::format("rank {} ({}) does not match rank 0 ({}): it has {}", rank, other.host,
                      first.host, different));
    threads_of.push_back(other.threads);
  }
  return threads_of;
}

}  // namespace psygen::cluster
