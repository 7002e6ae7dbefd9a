#include "engine/cluster/meeting.hpp"

#include <fmt/format.h>

#include "engine/cluster/agreement.hpp"
#include "engine/core/bytes.hpp"
#include "engine/core/hash.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::cluster {
namespace {

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
  core::put(out, std::uint32_t{mine.threads});
  put_text(out, mine.key.world);
  core::put(out, mine.key.world_hash);
  core::put(out, static_cast<std::uint32_t>(mine.key.types.size()));
  for (const TypeFingerprint& type : mine.key.types) {
    put_text(out, type.name);
    core::put(out, type.identity);
    core::put(out, static_cast<std::uint32_t>(type.levels));
    core::put(out, type.sample_hash);
  }
  return out;
}

Introduction introduction_from(const std::string& bytes) {
  core::ByteReader in(bytes);
  Introduction other;
  other.key.version = text_from(in);
  other.host = text_from(in);
  other.threads = in.get<std::uint32_t>();
  other.key.world = text_from(in);
  other.key.world_hash = in.get<std::uint64_t>();
  const std::size_t types = in.get_count(1);
  for (std::size_t i = 0; i < types; ++i) {
    TypeFingerprint& type = other.key.types.emplace_back();
    type.name = text_from(in);
    type.identity = in.get<std::uint64_t>();
    type.levels = static_cast<int>(in.get<std::uint32_t>());
    type.sample_hash = in.get<std::uint64_t>();
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
