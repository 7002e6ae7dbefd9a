#include "engine/cluster/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <thread>

#include "engine/amplify/ledger.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/files/text_file.hpp"

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

}  // namespace psygen::cluster
