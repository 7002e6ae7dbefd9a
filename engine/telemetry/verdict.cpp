#include "engine/telemetry/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/telemetry/units.hpp"

namespace psygen::telemetry {
namespace {

// Modelers that used at least this percentage of their processors had enough processor time.
constexpr double kBusyPercent = 60;
constexpr double kFasterThanReal = 1.1;  // flight time over real time

// Missing or too coarse part of the image, as the grade counts it.
double coarse_percent(const Summary& s) {
  const auto& m = s.missing;
  return (m.coarse_p99_percent.has_value() ? m.coarse_p99_percent : m.coarse_max_percent)
      .value.value_or(0.0);
}

// True if these are more than kRaisedPercent of the frames.
bool is_often(const Summary& s, const Count& frames) {
  return static_cast<double>(frames.value.value_or(0)) * 100 >
         kRaisedPercent * static_cast<double>(s.run.measured_frames);
}

std::string frames_text(const Summary& s, const Count& frames) {
  return fmt::format("{} of {} frame{}", frames.value.value_or(0), s.run.measured_frames,
                     s.run.measured_frames == 1 ? "" : "s");
}

class Judge {
 public:
  explicit Judge(const Summary& summary) : s_(summary) {}

  Verdict verdict() {
    if (s_.run.measured_frames == 0) {
      verdict_ = {Grade::kUnknown, "not measured", {"There are no frames after the warm-up."}, {}};
      if (s_.run.frames > 0) verdict_.advice = {"Fly longer, or with a shorter --warmup."};
      return verdict_;
    }
    verdict_ = {Grade::kGood, "as requested", {}, {}};
    judge_holes();
    judge_coarseness();
    judge_memory();
    judge_target();
    judge_failures();
    if (verdict_.grade == Grade::kGood) {
      verdict_.reasons = {
          fmt::format("No frame had a hole, and in 99 % of the frames at most {:g} % of the "
                      "image was too coarse.",
                      kGoodPercent)};
    }
    return std::move(verdict_);
  }

 private:
  void lower(Grade grade, std::string_view headline, std::string reason) {
    if (grade > verdict_.grade) {
      verdict_.grade = grade;
      verdict_.headline = headline;
    }
    verdict_.reasons.push_back(std::move(reason));
  }

  void judge_holes() {
    if (s_.missing.frames.value.value_or(0) == 0) return;
    lower(Grade::kPoor, "incomplete",
          fmt::format("{} had a hole: ground or a model in view had no mesh.",
                      frames_text(s_, s_.missing.frames)));
    advise_on_time();
  }

  void judge_coarseness() {
    const double percent = coarse_percent(s_);
    if (percent <= kGoodPercent) return;
    const bool poor = percent > kPoorPercent;
    const bool often = 2 * s_.missing.coarse_frames.value.value_or(0) > s_.run.measured_frames;
    const std::string headline =
        fmt::format("{}too coarse{}", poor ? "much " : "", often ? "" : " at times");
    lower(poor ? Grade::kPoor : Grade::kFair, headline,
          fmt::format("In {} ({} s of {} s of flight) more than {:g} % of the image was missing "
                      "or too coarse, at worst {} %.",
                      frames_text(s_, s_.missing.coarse_frames),
                      value_or_dash(s_.missing.coarse_seconds, three_digits),
                      three_digits(s_.run.measured_seconds), kCoarsePercent,
                      value_or_dash(s_.missing.coarse_max_percent, three_digits)));
    advise_on_time();
  }

  bool lacks_memory() const {
    return is_often(s_, s_.detail.raised_by_memory) || is_often(s_, s_.detail.refused_frames);
  }

  // Advises on the reason why meshes were late. If memory is the cause, judge_memory() reports it.
  void advise_on_time() {
    if (!verdict_.advice.empty() || lacks_memory()) return;
    const double real_s = s_.run.real_seconds.value.value_or(0);
    if (s_.run.fixed_step.has_value() && s_.run.measured_seconds > kFasterThanReal * real_s) {
      verdict_.advice.push_back(fmt::format(
          "With a fixed step the flight ran {} times as fast as real time: {} s of flight left the "
          "modelers only {} s. Use a --fixed-step above {:g} Hz, or none.",
          three_digits(s_.run.measured_seconds / std::max(real_s, 1e-9)),
          three_digits(s_.run.measured_seconds), three_digits(real_s), *s_.run.fixed_step));
    }
    const Figure& busy = s_.synthesis.coarse_busy_percent;
    if (busy.has_value() && *busy < kBusyPercent) {
      verdict_.advice.push_back(fmt::format(
          "In these frames the modelers used {} % of the time of {} processor{}; drawing or "
          "other programs may have used the rest. A smaller --size or a lower --preset leaves them "
          "more.",
          three_digits(*busy), s_.run.modelers, s_.run.modelers == 1 ? "" : "s"));
    }
    if (verdict_.advice.empty())
      verdict_.advice.push_back("A slower flight or more --modelers gives synthesis more time.");
  }

  std::string error_text() const {
    std::string text =
        fmt::format("the allowed error was {} pixels in the median and {} at most, instead of {:g}",
                    value_or_dash(s_.detail.p50_pixels, three_digits),
                    value_or_dash(s_.detail.max_pixels, three_digits), s_.run.error_pixels);
    const Figure& least = s_.detail.resolution_min;
    if (least.has_value() && *least < 1)
      text += fmt::format("; the render scale was {} % in the median and {} % at worst",
                          three_digits(100 * s_.detail.resolution_p50.value.value_or(1)),
                          three_digits(100 * *least));
    return text;
  }

  void judge_memory() {
    if (!lacks_memory()) return;
    const auto& d = s_.detail;
    const bool raised = d.raised_by_memory.value.value_or(0) >= d.refused_frames.value.value_or(0);
    lower(
        Grade::kFair, "coarser than requested",
        fmt::format("The geometry budget was too small in {}: {}.",
                    frames_text(s_, raised ? d.raised_by_memory : d.refused_frames), error_text()));
    verdict_.advice.push_back(fmt::format("Raise --budget above {}.",
                                          bytes_text(static_cast<double>(s_.cache.budget_bytes))));
  }

  void judge_target() {
    if (!is_often(s_, s_.detail.raised_for_target)) return;
    lower(Grade::kFair, "coarser than requested",
          fmt::format("To hold {:g} frames/s, detail was reduced in {}: {}.",
                      s_.run.target_fps.value.value_or(0),
                      frames_text(s_, s_.detail.raised_for_target), error_text()));
    verdict_.advice.push_back(
        "A lower --target-fps, a smaller --size or a lower --preset allows more detail.");
  }

  void judge_failures() {
    const std::uint64_t failed = s_.synthesis.failed.value.value_or(0);
    if (failed == 0) return;
    lower(Grade::kPoor, "incomplete",
          fmt::format("{} model{} could not be synthesised; a coarser mesh or nothing replaces {}.",
                      failed, failed == 1 ? "" : "s", failed == 1 ? "it" : "them"));
    verdict_.advice.push_back("The log names the first one and the reason.");
  }

  const Summary& s_;
  Verdict verdict_;
};

}  // namespace

std::string_view name_of(Grade grade) {
  constexpr std::array<std::string_view, 4> kNames = {"unknown", "good", "fair", "poor"};
  return kNames[static_cast<std::size_t>(grade)];
}

std::string left_out_text(const Summary& summary) {
  constexpr std::array<std::string_view, kApartKinds> kWhat = {"",
                                                               "written as images",
                                                               "after the GPU was idle",
                                                               "while the window was resized",
                                                               "while the window accepted no image",
                                                               "while the machine stalled"};
  std::string text;
  for (std::size_t kind = 1; kind < kApartKinds; ++kind) {
    const std::uint64_t count = summary.run.apart_frames[kind];
    if (count == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kWhat[kind]);
  }
  if (text.empty()) return text;
  const std::uint64_t left_out = summary.run.measured_frames - summary.run.timed_frames;
  return fmt::format("{} of {} measured frame{} {} excluded from timing statistics: {}.", left_out,
                     summary.run.measured_frames, summary.run.measured_frames == 1 ? "" : "s",
                     left_out == 1 ? "is" : "are", text);
}

Verdict judge_quality(const Summary& summary) {
  return Judge(summary).verdict();
}

}  // namespace psygen::telemetry
