// profile.json: the mean work of each system and function.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/core/read_file.hpp"
#include "engine/frametest/cause.hpp"

namespace psygen::frametest {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kSchema = "psygen.profile/1";
constexpr std::uint64_t kMaxProfileBytes = 16 << 20;

Json rows_of(std::span<const WorkChange> changes) {
  Json rows = Json::array();
  for (const WorkChange& change : changes) {
    Json row = {{"name", change.name}, {"mean", change.usual}};
    if (!change.system.empty()) row["system"] = change.system;
    rows.push_back(std::move(row));
  }
  return rows;
}

// Throws nlohmann::json::exception for values of other types.
std::vector<WorkChange> changes_of(const nlohmann::json& rows) {
  std::vector<WorkChange> changes;
  for (const nlohmann::json& row : rows)
    changes.push_back({.name = row.at("name").get<std::string>(),
                       .system = row.value("system", std::string()),
                       .usual = row.at("mean").get<double>()});
  return changes;
}

}  // namespace

std::string to_json(const ProfileSummary& summary) {
  const Json json = {{"schema", kSchema},
                     {"unit", telemetry::name_of(summary.unit)},
                     {"frames", summary.frames},
                     {"systems", rows_of(summary.systems)},
                     {"functions", rows_of(summary.functions)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

core::Result<ProfileSummary> parse_profile(std::string_view text, const std::string& file) {
  const auto refuse = [&](std::string_view reason) {
    return core::fail(core::ErrorCode::kParse, fmt::format("{}: {}", file, reason));
  };
  try {
    const auto json = nlohmann::json::parse(text);
    if (json.at("schema").get<std::string>() != kSchema)
      return refuse(fmt::format("its schema is not {}", kSchema));
    ProfileSummary summary;
    const auto unit = json.at("unit").get<std::string>();
    using enum telemetry::WorkUnit;
    if (unit != name_of(kInstructions) && unit != name_of(kProcessorTime))
      return refuse("its unit is unknown");
    summary.unit = unit == name_of(kInstructions) ? kInstructions : kProcessorTime;
    summary.frames = json.at("frames").get<std::uint64_t>();
    summary.systems = changes_of(json.at("systems"));
    summary.functions = changes_of(json.at("functions"));
    return summary;
  } catch (const nlohmann::json::exception& error) {
    return refuse(fmt::format("it is no profile: {}", error.what()));
  }
}

core::Result<ProfileSummary> read_profile(const std::filesystem::path& file) {
  const auto bytes = core::read_file(file, kMaxProfileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_profile({reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                       file.string());
}

}  // namespace psygen::frametest
