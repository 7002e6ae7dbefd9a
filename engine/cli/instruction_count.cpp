// psygen compare --instructions: compares two commands under callgrind.
#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "engine/cli/child_process.hpp"
#include "engine/cli/compare_command.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/compare/instructions.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/frametest/run.hpp"
#include "engine/telemetry/output_file.hpp"

namespace psygen::cli {
namespace {

constexpr const char* kNoValgrind =
    "it counts instructions (package valgrind); nothing was compared";

// Default work: generators of the paper's world in one thread, without a GPU.
std::vector<std::string> work_of(const std::string& command) {
  std::vector<std::string> words = words_of(command);
  if (words.size() == 1)
    words.insert(words.end(), {"amplify", "--region", "0,0,3,3", "--threads", "1"});
  return words;
}

// Path of the library that replaces an instruction valgrind cannot run (countable.cpp). Empty if it
// is not installed, which is harmless on processors that do not need it.
std::string stand_in() {
  void* library = dlopen("libpsygen_countable.so", RTLD_LAZY | RTLD_LOCAL);
  link_map* map = nullptr;
  if (library == nullptr || dlinfo(library, RTLD_DI_LINKMAP, &map) != 0) return {};
  return map->l_name;
}

std::vector<std::string> environment() {
  const std::string library = stand_in();
  const char* others = std::getenv("LD_PRELOAD");
  if (library.empty()) return {};
  return {fmt::format("LD_PRELOAD={}{}{}", library, others != nullptr ? ":" : "",
                      others != nullptr ? others : "")};
}

std::string whole_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

struct Counted {
  std::uint64_t instructions = 0;
  std::string hash;
};

// Fails with kNoDevice if valgrind cannot count here.
core::Result<Counted> count(const std::string& command, const std::filesystem::path& out,
                            const char* name) {
  const auto profile = out / fmt::format("{}.callgrind", name),
             log = out / fmt::format("{}.txt", name);
  std::vector<std::string> words{"valgrind", "--tool=callgrind",
                                 "--callgrind-out-file=" + profile.string()};
  const std::vector<std::string> work = work_of(command);
  words.insert(words.end(), work.begin(), work.end());
  const auto code = run_program(words, log, environment());
  if (!code)
    return core::fail(core::ErrorCode::kNoDevice,
                      fmt::format("{}; {}", code.error().message, kNoValgrind));
  if (*code == 128 + SIGILL)
    return core::fail(
        core::ErrorCode::kNoDevice,
        fmt::format("{}: valgrind does not support an instruction that it executes on "
                    "this processor; see {}",
                    command, log.string()));
  if (*code != 0)
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("{}: exit code {} under valgrind; its output is in {}", command,
                                  *code, log.string()));
  const auto instructions = compare::instructions_in(whole_text(profile), profile.string());
  if (!instructions) return tl::unexpected(instructions.error());
  return Counted{*instructions, std::string(compare::hash_in(whole_text(log)))};
}

}  // namespace

core::Result<compare::Instructions> CompareCommand::count_instructions() const {
  if (out_.empty())
    return core::fail(core::ErrorCode::kInvalidArgument, "--instructions needs --out");
  if (auto ok = telemetry::create_output_folder(out_); !ok) return tl::unexpected(ok.error());
  const auto a = count(a_, out_, "a");
  if (!a) return tl::unexpected(a.error());
  const auto b = count(b_, out_, "b");
  if (!b) return tl::unexpected(b.error());
  if (a->hash != b->hash)
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("the outputs differ (hashes '{}' and '{}'), so the "
                                  "instruction counts are not comparable",
                                  a->hash, b->hash));
  return compare::Instructions{a->instructions, b->instructions};
}

// Returns 0; 3 if B executes over 1 % more instructions; 77 if valgrind is missing or cannot run a
// command; otherwise 1.
int CompareCommand::compare_instructions() const {
  const auto counted = count_instructions();
  if (!counted) {
    core::log_error(counted.error().message);
    return counted.error().code == core::ErrorCode::kNoDevice ? int{frametest::kSkipped}
                                                              : exit_code_of(counted.error());
  }
  const std::string json = compare::to_json(*counted);
  if (auto ok = core::replace_file(out_ / "compare.json", json); !ok) {
    core::log_error(ok.error().message);
    return kFailed;
  }
  const int printed = print(json_ ? json : compare::to_text(*counted));
  if (printed != kOk) return printed;
  return counted->verdict() == compare::Verdict::kWorse ? int{frametest::kMissed} : kOk;
}

}  // namespace psygen::cli
