// Reads [flight] and the budgets. The keys of [flight] are the options of `psygen fly`.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/data_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/frametest/budget_fields.hpp"
#include "engine/frametest/budget_limit.hpp"
#include "engine/frametest/frame_test.hpp"
#include "engine/frametest/judge.hpp"
#include "engine/render/preset.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/world/files/document.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::frametest {
namespace {

using world::Limits;
using world::Node;
using world::Problems;
using world::TableReader;

constexpr std::size_t kMaxNameBytes = 64, kMaxFileNameBytes = 4096;

// Reads a text with a parser that returns a core::Result.
template <class Parse, class Value>
void read_word(TableReader& reader, std::string_view key, const Parse& parse, Value& value) {
  std::string text;
  if (!reader.read(key, text, kMaxNameBytes)) return;
  if (const auto parsed = parse(text)) {
    value = *parsed;
  } else {
    reader.problem(reader.find(key)->value.line, key, parsed.error().message);
  }
}

template <class Value>
void read_count(TableReader& reader, std::string_view key, Limits limits, Value& value) {
  std::int64_t number = 0;
  if (reader.read(key, number, limits)) value = static_cast<Value>(number);
}

void read_file_name(TableReader& reader, std::string_view key, std::filesystem::path& file) {
  std::string text;
  if (reader.read(key, text, kMaxFileNameBytes)) file = text;
}

core::Result<bool> virtual_clock_from(const std::string& text) {
  if (text == "wall" || text == "virtual") return text == "virtual";
  return core::fail(core::ErrorCode::kParse, "it must be \"wall\" or \"virtual\"");
}

core::Result<synthesis::Policy> policy_from(const std::string& text) {
  if (const auto policy = synthesis::policy_from(text)) return *policy;
  return core::fail(core::ErrorCode::kParse, "it must be fifo, plp, shortest, longest or deadline");
}

void read_scene(TableReader& reader, scene::SceneSettings& scene) {
  read_word(reader, "clock", virtual_clock_from, scene.virtual_time);
  read_word(reader, "paradigm", scene::paradigm_from, scene.paradigm);
  read_word(reader, "policy", policy_from, scene.policy);
  read_word(reader, "plp", scene::plp_mode_from, scene.plp_mode);
  read_count(reader, "modelers", {0, 256}, scene.modelers);
  if (std::int64_t mib = 0; reader.read("budget_mib", mib, {4, 1 << 20}))
    scene.budget_bytes = static_cast<std::uint64_t>(mib) << 20;
  reader.read("view_distance", scene.view_distance_m, {32, 65536});
  reader.read("error", scene.max_error_pixels, {0.1, 1000});
  reader.read("min_resolution", scene.min_resolution, {0.25, 1});
  reader.read("fade", scene.fade_seconds, {0, 60});
  reader.read("lod", scene.levels_of_detail);
  reader.read("occlusion", scene.occlusion);
}

void read_session(TableReader& reader, app::SessionOptions& session) {
  read_file_name(reader, "world", session.world_file);
  std::int64_t size[2] = {session.size.width, session.size.height};
  if (reader.read_pair("size", size, {1, 16384}))
    session.size = {static_cast<std::uint32_t>(size[0]), static_cast<std::uint32_t>(size[1])};
  read_word(reader, "preset", render::preset_from, session.preset);
  read_word(reader, "render_path", render::render_path_from, session.render_path);
  if (double hour = 0; reader.read("hour", hour, {0, 24})) session.start_hour = hour;
  if (double hz = 0; reader.read("target_fps", hz, {0, 1000})) session.target_hz = hz;
  reader.read("prefill", session.prefill);
  if (bool passes = false; reader.read("pass_times", passes)) session.pass_times = passes;
  read_scene(reader, session.scene);
}

void read_flight(TableReader& reader, app::FlightOptions& flight) {
  read_file_name(reader, "path", flight.path_file);
  reader.read("seconds", flight.seconds, {0, 86400});
  reader.read("warmup", flight.warmup_seconds, {0, 3600});
  read_count(reader, "frames", {0, 1e9}, flight.frames);
  read_count(reader, "images", {0, 1e9}, flight.images_every);
  reader.read("fixed_step", flight.fixed_step_hz, {1, 1000});
  reader.read("loop", flight.loop);
  read_session(reader, flight.session);
  reader.finish();
  if (flight.loop && flight.seconds == 0 && flight.frames == 0)
    reader.problem(reader.line(), "loop", "a repeated path needs seconds or frames");
}

// [test]: how often the test flies. The base is a folder beside the file.
void read_test(TableReader& reader, const std::filesystem::path& file, FrameTest& test) {
  read_count(reader, "runs", {1, kMaxRuns}, test.runs);
  read_count(reader, "retries", {0, kMaxRetries}, test.retries);
  if (test.runs > 1) test.flight.reference_load = true;  // somebody wants to compare them
  reader.read("reference", test.flight.reference_load);
  std::filesystem::path base;
  read_file_name(reader, "base", base);
  if (!base.empty()) test.base = file.parent_path() / base;
  reader.finish();
}

// True if other programs can change the value of a budget. Then the reference load is measured
// unless the file says otherwise.
bool can_change_by_load(const FrameTest& test) {
  const bool is_virtual = test.flight.session.scene.virtual_time;
  return std::ranges::any_of(test.budgets, [is_virtual](const Budget& budget) {
    return depends_on_load(budget.field, is_virtual);
  });
}

// What all budgets of a file share.
struct BudgetReader {
  const KnownFields& known;
  Problems& problems;
  FrameTest& test;
};

// Dotted keys are nested tables: "frame_ms.p99 = 25".
void read_budgets(const Node& table, const std::string& prefix, Relation relation,
                  const BudgetReader& reader) {
  Problems& problems = reader.problems;
  for (const world::Member& member : table.members) {
    const std::string field = prefix.empty() ? member.key : prefix + "." + member.key;
    const Node& value = member.value;
    const std::string where = fmt::format("{}.{}", name_of(relation), field);
    if (!is_limit(value)) {
      read_budgets(value, field, relation, reader);
      continue;
    }
    Budget budget{field, relation, 0.0, member.line};
    if (!read_limit(value, where, problems, budget)) continue;
    const std::string problem = reader.known.problem(budget, reader.test.flight.sections);
    if (!problem.empty()) problems.add(member.line, where, problem);
    reader.test.budgets.push_back(std::move(budget));
  }
}

constexpr std::array kRelations{Relation::kAtMost, Relation::kAtLeast, Relation::kEqual};

constexpr const char* kNameRule =
    "it must be 1 to 64 of a-z, 0-9 and _, with single dots between, and not \"end\"";

bool is_mark(std::string_view name) {
  return telemetry::is_own_name(name) && name != telemetry::kEndOfRun;
}

// [marks]: names with the time of the flight at which they are set.
void read_marks(TableReader& reader, std::vector<app::TimedMark>& marks) {
  for (const world::Member& member : reader.node().members) {
    app::TimedMark mark{member.key, 0};
    if (!is_mark(mark.name)) reader.problem(member.line, mark.name, kNameRule);
    if (reader.read(mark.name, mark.time_s, {0, 86400})) marks.push_back(std::move(mark));
  }
  std::ranges::stable_sort(marks, {}, &app::TimedMark::time_s);
}

// [sections.NAME]: the range alone. Its budgets are read when all sections are known.
void read_ranges(TableReader& reader, std::vector<telemetry::SectionRange>& sections) {
  for (const world::Member& member : reader.node().members) {
    telemetry::SectionRange section{.name = member.key, .from = member.key};
    auto table = reader.table(section.name);
    if (!table) continue;
    table->read("from", section.from, kMaxNameBytes);
    table->read("to", section.to, kMaxNameBytes);
    // Budgets name sections in dotted keys.
    if (!is_mark(section.name) || section.name.find('.') != std::string::npos)
      reader.problem(member.line, section.name,
                     "the name must be 1 to 64 of a-z, 0-9 and _, and not \"end\"");
    if (!is_mark(section.from)) table->problem("from", kNameRule);
    if (section.to != telemetry::kEndOfRun && !is_mark(section.to)) table->problem("to", kNameRule);
    for (const Relation relation : kRelations)
      (void)table->find(name_of(relation));
    table->finish();
    if (sections.size() == telemetry::kMaxSections)
      reader.problem(member.line, section.name,
                     fmt::format("a frame test has at most {} sections", telemetry::kMaxSections));
    sections.push_back(std::move(section));
  }
}

void read_section_budgets(TableReader& reader, const BudgetReader& budgets) {
  for (const telemetry::SectionRange& section : budgets.test.flight.sections) {
    auto table = reader.table(section.name);
    for (const Relation relation : kRelations)
      if (const auto limits = table->table(name_of(relation)))
        read_budgets(limits->node(), "sections." + section.name, relation, budgets);
  }
}

// Returns why a text cannot be the name of a test, which is also that of a folder in --out; empty
// if it can. The reader has refused control characters, and names of more than kMaxNameBytes bytes.
std::string_view problem_of_name(std::string_view name) {
  if (name.empty() || name == "." || name == "..")
    return "the name is also used for a folder and must not be empty, . or ..";
  if (name.find_first_of("/\\") != std::string_view::npos)
    return "the name is also used for a folder and must not contain / or \\";
  return {};
}

void read_name(TableReader& root, const std::filesystem::path& file, FrameTest& test) {
  test.name = core::shown(file.stem().string(), kMaxNameBytes);
  root.read("name", test.name, kMaxNameBytes);
  if (const world::Member* member = root.find("name")) test.name_line = member->line;
  if (const std::string_view problem = problem_of_name(test.name); !problem.empty())
    root.problem(test.name_line, "name", problem);
}

core::Result<void> find(const char* kind, const std::filesystem::path& folder,
                        std::filesystem::path& file) {
  std::error_code error;
  if (file.empty()) return {};
  if (std::filesystem::is_regular_file(folder / file, error)) {
    file = folder / file;
    return {};
  }
  auto found = core::data_file(std::filesystem::path(kind) / file, folder);
  if (!found) {
    std::filesystem::path with_ending = file;
    found = core::data_file(std::filesystem::path(kind) / (with_ending += ".toml"), folder);
  }
  if (!found) return tl::unexpected(found.error());
  file = std::move(*found);
  return {};
}

}  // namespace

std::string_view name_of(Relation relation) {
  return relation == Relation::kAtMost    ? "at_most"
         : relation == Relation::kAtLeast ? "at_least"
                                          : "equal";
}

core::Result<FrameTest> parse_frame_test(std::string_view text,
                                         const std::filesystem::path& file_name) {
  const core::Result<Node> document = world::parse_document(text, file_name.string());
  if (!document) return tl::unexpected(document.error());
  const std::string file = file_name.string();
  Problems problems(file);
  TableReader root(*document, "", 1, problems);
  world::read_format(root, kFrameTestFormat);
  if (problems.any()) return tl::unexpected(problems.first());
  FrameTest test;
  read_name(root, file_name, test);
  test.flight.session.headless = true;
  test.flight.session.world_file = "paper";
  test.flight.session.preset = render::Preset::kLow;
  if (auto flight = root.table("flight")) read_flight(*flight, test.flight);
  if (auto marks = root.table("marks")) read_marks(*marks, test.flight.marks);
  auto sections = root.table("sections");
  if (sections) read_ranges(*sections, test.flight.sections);
  const KnownFields known;
  const BudgetReader budgets{known, problems, test};
  for (const Relation relation : kRelations) {
    if (const auto table = root.table(name_of(relation)))
      read_budgets(table->node(), "", relation, budgets);
  }
  if (sections) read_section_budgets(*sections, budgets);
  std::ranges::stable_sort(test.budgets, {}, &Budget::line);
  test.flight.reference_load = can_change_by_load(test);
  if (auto table = root.table("test")) read_test(*table, file_name, test);
  root.finish();
  if (!problems.any() && test.budgets.empty())
    problems.add(1, "at_most", "a frame test needs a budget in [at_most], [at_least] or [equal]");
  if (problems.any()) return tl::unexpected(problems.first());
  return test;
}

core::Result<FrameTest> load_frame_test(const std::filesystem::path& file) {
  const core::Result<std::string> text = world::read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  core::Result<FrameTest> test = parse_frame_test(*text, file);
  if (!test) return test;
  const auto found =
      find("worlds", file.parent_path(), test->flight.session.world_file).and_then([&] {
        return find("paths", file.parent_path(), test->flight.path_file);
      });
  if (!found)
    return core::fail(found.error().code,
                      fmt::format("{}: {}", file.string(), found.error().message));
  return test;
}

core::Result<std::vector<TestFile>> load_frame_tests(std::span<const std::filesystem::path> files) {
  std::vector<TestFile> tests;
  for (const std::filesystem::path& file : files) {
    tests.push_back({file, load_frame_test(file)});
    const core::Result<FrameTest>& test = tests.back().test;
    if (!test) continue;
    const auto same = std::ranges::find_if(
        tests, [&](const TestFile& other) { return other.test && other.test->name == test->name; });
    if (same + 1 != tests.end())
      return core::fail(
          core::ErrorCode::kParse,
          fmt::format("{}:{}: name: the test of {}:{} is also called {}, and both would write into "
                      "one folder; give one another name",
                      file.string(), test->name_line, same->file.string(), same->test->name_line,
                      test->name));
  }
  return tests;
}

}  // namespace psygen::frametest
