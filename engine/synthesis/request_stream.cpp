#include "engine/synthesis/request_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <numeric>
#include <optional>
#include <queue>

#include "engine/core/assert.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::synthesis {
namespace {

constexpr double kMinNoticeSeconds = 0.002;  // deadlines are stored in milliseconds
constexpr std::string_view kHeader = "psygen requests 2";

// Removes and returns the next word of a line.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const std::size_t end = std::min(line.find(' '), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

std::optional<double> time_of(std::string_view word) {
  double value = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool ok = parsed.ec == std::errc() && parsed.ptr == word.data() + word.size() &&
                  value >= 0 && value <= kNoDeadline;  // false for NaN
  return ok ? std::optional(value) : std::nullopt;
}

std::optional<SimulatedJob> job_of(std::string_view line) {
  const auto arrival = time_of(take_word(line)), seconds = time_of(take_word(line));
  const std::string_view due = take_word(line), rank = take_word(line);
  const auto deadline = due == "-" ? std::optional(kNoDeadline) : time_of(due);
  std::uint64_t bits = 0;
  const auto parsed = std::from_chars(rank.data(), rank.data() + rank.size(), bits, 16);
  if (!arrival || !seconds || !deadline || parsed.ec != std::errc() ||
      parsed.ptr != rank.data() + rank.size() || !take_word(line).empty()) {
    return std::nullopt;
  }
  return SimulatedJob{*arrival, *seconds, *deadline, Rank::from_bits(bits)};
}

std::vector<SimulatedJob> initial_fill(std::span<const SimulatedJob> jobs) {
  std::vector<SimulatedJob> fill;
  double first = kNoDeadline;
  for (const SimulatedJob& job : jobs)
    first = std::min(first, job.arrival_s);
  for (const SimulatedJob& job : jobs) {
    if (job.arrival_s == first) fill.push_back({0, job.seconds, job.deadline_s - first, job.rank});
  }
  return fill;
}

// Returns true if a request could be in time. A model due at once stands at the edge of the view,
// on ground already in view: no policy could have it in time.
bool is_due_later(const SimulatedJob& job) {
  return job.deadline_s < kNoDeadline && job.deadline_s > job.arrival_s + kMinNoticeSeconds;
}

PolicyStats figures_of(std::span<const SimulatedJob> jobs, unsigned modelers, Policy policy) {
  PolicyStats figures;
  figures.policy = policy;
  const SimulationResult fill = simulate(initial_fill(jobs), modelers, policy);
  figures.fill_s = fill.makespan_s;
  if (fill.makespan_s > 0)
    figures.fill_idle_percent = 100 * fill.idle_seconds / (fill.makespan_s * modelers);
  const SimulationResult all = simulate(jobs, modelers, policy);
  std::vector<double> waits, lateness;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (is_visible(jobs[i].rank.group())) {
      waits.push_back(all.runs[i].finish_s - jobs[i].arrival_s);
    } else if (is_due_later(jobs[i])) {
      lateness.push_back(std::max(0.0, all.runs[i].finish_s - jobs[i].deadline_s));
    }
  }
  figures.visible_p50_s = quantile(waits, 0.5);
  figures.visible_p99_s = quantile(waits, 0.99);
  figures.visible_max_s = quantile(waits, 1.0);
  for (const double late : lateness) {
    figures.late_percent += late > 0 ? 100.0 / static_cast<double>(lateness.size()) : 0.0;
    figures.lateness_mean_s += late / static_cast<double>(lateness.size());
    figures.lateness_max_s = std::max(figures.lateness_max_s, late);
  }
  return figures;
}

}  // namespace

SimulationResult simulate(std::span<const SimulatedJob> jobs, unsigned modelers, Policy policy) {
  PSYGEN_CHECK(modelers >= 1, "a simulation needs at least one modeler");
  std::vector<std::size_t> arriving(jobs.size());
  std::iota(arriving.begin(), arriving.end(), std::size_t{0});
  std::stable_sort(arriving.begin(), arriving.end(), [&](std::size_t a, std::size_t b) {
    return jobs[a].arrival_s < jobs[b].arrival_s;
  });
  const auto later = [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      const SimulatedJob& j = jobs[i];
      return ScheduleKey{j.rank, static_cast<float>(j.deadline_s), j.seconds, i};
    };
    return served_before(policy, key(b), key(a));
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> waiting(later);
  std::vector<double> free_at(modelers, 0.0);
  SimulationResult result;
  result.runs.resize(jobs.size());
  double busy_seconds = 0, now = 0;
  for (std::size_t next = 0; next < arriving.size() || !waiting.empty();) {
    const auto modeler = std::min_element(free_at.begin(), free_at.end());
    // A modeler that was idle starts now, not when it became free.
    now = std::max(now, *modeler);
    if (waiting.empty()) now = std::max(now, jobs[arriving[next]].arrival_s);
    while (next < arriving.size() && jobs[arriving[next]].arrival_s <= now)
      waiting.push(arriving[next++]);
    const std::size_t i = waiting.top();
    waiting.pop();
    const double finish = now + jobs[i].seconds;
    result.runs[i] = {now, finish, static_cast<std::uint32_t>(modeler - free_at.begin())};
    *modeler = finish;
    busy_seconds += jobs[i].seconds;
    result.makespan_s = std::max(result.makespan_s, finish);
    const double lateness = std::max(0.0, finish - jobs[i].deadline_s);
    result.mean_wait_s += finish - jobs[i].arrival_s;
    result.mean_lateness_s += lateness;
    result.max_lateness_s = std::max(result.max_lateness_s, lateness);
  }
  if (!jobs.empty()) {
    result.mean_wait_s /= static_cast<double>(jobs.size());
    result.mean_lateness_s /= static_cast<double>(jobs.size());
  }
  result.idle_seconds = std::max(0.0, result.makespan_s * modelers - busy_seconds);
  return result;
}

std::string stream_text(std::vector<SimulatedJob> jobs) {
  std::stable_sort(jobs.begin(), jobs.end(), [](const SimulatedJob& a, const SimulatedJob& b) {
    return a.arrival_s < b.arrival_s;
  });
  std::string text = std::string(kHeader) + "\n";
  for (const SimulatedJob& job : jobs) {
    const std::string due =
        job.deadline_s < kNoDeadline ? fmt::format("{:.3f}", job.deadline_s) : std::string("-");
    fmt::format_to(std::back_inserter(text), "{:.4f} {:.8f} {} {:x}\n", job.arrival_s, job.seconds,
                   due, job.rank.bits());
  }
  return text;
}

core::Result<std::vector<SimulatedJob>> parse_stream(std::string_view text, std::string_view file) {
  const auto refuse = [file](std::size_t line, std::string_view why) {
    return core::fail(core::ErrorCode::kParse, fmt::format("{}:{}: {}", file, line, why));
  };
  std::vector<SimulatedJob> jobs;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (number == 1) {
      if (line != kHeader)
        return refuse(number, fmt::format("the first line must be '{}'", kHeader));
      continue;
    }
    const auto job = job_of(line);
    if (!job) return refuse(number, "a request needs: arrival, seconds, deadline or -, rank");
    if (jobs.size() == kMaxStreamRequests) {
      return refuse(number, fmt::format("more than {} requests", kMaxStreamRequests));
    }
    jobs.push_back(*job);
  }
  if (jobs.empty()) return refuse(1, "the file has no requests");
  return jobs;
}

StreamLoad load_of(std::span<const SimulatedJob> jobs, unsigned modelers) {
  StreamLoad load;
  load.requests = jobs.size();
  double first = kNoDeadline, last = 0;
  for (const SimulatedJob& job : jobs) {
    first = std::min(first, job.arrival_s);
    last = std::max(last, job.arrival_s);
    load.work_s += job.seconds;
  }
  load.span_s = std::max(last - first, 0.0);
  load.percent = load.span_s > 0 ? 100 * load.work_s / (load.span_s * modelers) : 0.0;
  return load;
}

std::vector<PolicyStats> compare_policies(std::span<const SimulatedJob> jobs, unsigned modelers) {
  std::vector<PolicyStats> rows;
  for (const Policy policy : kAllPolicies)
    rows.push_back(figures_of(jobs, modelers, policy));
  return rows;
}

}  // namespace psygen::synthesis
