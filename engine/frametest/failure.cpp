#include "engine/frametest/failure.hpp"

#include <fmt/format.h>

#include <optional>

#include "engine/app/flight.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/frametest/cause_report.hpp"
#include "engine/image/compare.hpp"
#include "engine/image/image_io.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/scene.hpp"
#include "engine/telemetry/page.hpp"

namespace psygen::frametest {
namespace {

constexpr const char* kPage = "failed.html";
constexpr std::string_view kPicturePrefix = "worst_";

struct Seen {
  core::CameraPose pose;
  double time_s = 0;
  std::optional<core::Result<image::Image>> picture;
};

// Captures the image of the frame. Runs after the game's plugins, so that the image contains their
// drawing.
app::Plugin photographer(const WorstFrame& frame, bool numbered, Seen& seen) {
  app::Plugin plugin;
  plugin.name = "pictures of the worst frames";
  plugin.on_frame = [&frame, &seen, numbered, count = std::uint64_t{0}](app::Session& session,
                                                                        double dt_s) mutable {
    const double end_s = session.now_s();  // end of the frame
    const bool is_it = numbered ? count++ == frame.index : end_s > frame.time_s;
    if (!is_it || seen.picture) return;
    seen.pose = session.scene().input().pose;
    seen.time_s = end_s - dt_s;
    seen.picture = session.picture();
  };
  return plugin;
}

// Renders the same position and time with all meshes ready that fit into the budget.
core::Result<image::Image> expected_picture(app::Session& session, const Seen& seen) {
  constexpr int kTicks = 2;  // in the first tick, meshes of the last frame may still cross-fade
  scene::Scene& scene = session.scene();
  session.set_now(seen.time_s);
  session.set_paused(true);
  scene.stop_adapting();  // uses the error that the test requests
  session.scene().settle(seen.pose);
  for (int i = 0; i < kTicks; ++i)
    if (auto ok = session.tick(seen.pose, 0); !ok) return tl::unexpected(ok.error());
  return session.picture();
}

std::string picture_name(const WorstFrame& frame, std::string_view kind) {
  return fmt::format("{}{:05}_{}.png", kPicturePrefix, frame.index, kind);
}

core::Result<image::ImageDifference> write_pictures(const WorstFrame& frame,
                                                    const image::Image& seen,
                                                    const image::Image& expected,
                                                    const std::filesystem::path& folder) {
  const auto difference = image::picture_of_difference(expected, seen);
  if (!difference) return tl::unexpected(difference.error());
  const std::pair<const char*, const image::Image*> pictures[] = {
      {"seen", &seen}, {"expected", &expected}, {"difference", &*difference}};
  for (const auto& [kind, picture] : pictures) {
    const auto written = image::write_png(folder / picture_name(frame, kind), *picture);
    if (!written) return tl::unexpected(written.error());
  }
  return image::compare(seen, expected);
}

// Repeats the flight up to the frame, and writes its three images.
core::Result<image::ImageDifference> fly_to(const WorstFrame& frame, const FrameTest& test,
                                            const RunOptions& options, const Hooks& hooks) {
  app::FlightOptions flight = test.flight;
  flight.images_every = 0;
  flight.hash_world = false;
  flight.reference_load = false;
  const bool numbered = is_numbered(flight);
  flight.frames = numbered ? frame.index + 1 : 0;
  if (!numbered) flight.seconds = frame.time_s + 1e-9;
  Seen seen;
  auto flown = start_flight(flight, options, hooks, photographer(frame, numbered, seen));
  if (!flown) return tl::unexpected(flown.error());
  const auto report = (*flown)->run();
  if (!report) return tl::unexpected(report.error());
  app::Session& session = (*flown)->session();
  if (session.stopped() || !seen.picture)
    return core::fail(core::ErrorCode::kInterrupted, "the flight ended before this frame");
  if (!*seen.picture) return tl::unexpected(seen.picture->error());
  const auto expected = expected_picture(session, seen);
  if (!expected) return tl::unexpected(expected.error());
  return write_pictures(frame, **seen.picture, *expected, options.out / test.name);
}

std::string frame_html(const WorstFrame& frame, const std::string& cause_html,
                       const core::Result<image::ImageDifference>& difference) {
  std::string html = fmt::format("<h2>Frame {} at {:.2f} s</h2>\n{}<p>{}. ", frame.index,
                                 frame.time_s, cause_html, escaped(frame.why));
  if (!difference)
    return html + fmt::format("No images: {}</p>\n", escaped(difference.error().message));
  html += fmt::format("{:.2f} % of the pixels differ by more than {} of 255.</p>\n<div class=row>",
                      100 * difference->share_over, image::kGoldenThreshold);
  for (const char* kind : {"seen", "expected", "difference"}) {
    const std::string file = picture_name(frame, kind);
    html += fmt::format(
        "<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\"></a>"
        "<figcaption>{1}</figcaption></figure>",
        file, kind);
  }
  return html + "</div>\n";
}

std::string budgets_html(const TestResult& result) {
  std::string html = "<table><tr><th>budget</th><th>limit</th><th>this run</th></tr>\n";
  for (const BudgetResult& r : result.budgets) {
    if (r.holds) continue;
    html += fmt::format("<tr><td>{}</td><td>{} {}</td><td>{}</td></tr>\n", escaped(r.budget.field),
                        escaped(sign_of(r.budget.relation)), escaped(limit_of(r.budget)),
                        escaped(r.value));
  }
  return html + "</table>\n";
}

std::string lead_html(const FrameTest& test) {
  const bool exact = test.flight.session.scene.virtual_time;
  return fmt::format(
      "<h1>{}: budgets missed</h1>\n<p class=\"lead\">The worst frames as drawn, the same frames "
      "with all meshes ready, and their difference (yellow to red). {} <a href=\"report.html\">The "
      "whole flight</a></p>\n",
      escaped(test.name),
      exact ? "The images are bit-identical to those of the judged flight."
            : "The images are from a second flight through the same positions: on the wall clock, "
              "missing meshes differ from flight to flight.");
}

}  // namespace

void remove_failure(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::remove(folder / kPage, error);
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    std::error_code ignored;
    if (name.starts_with(kPicturePrefix) && name.ends_with(".png"))
      std::filesystem::remove(it->path(), ignored);
  }
}

core::Result<std::filesystem::path> write_failure(const FrameTest& test, const TestResult& result,
                                                  std::span<const WorstFrame> frames,
                                                  const CauseReport& causes,
                                                  const RunOptions& options, const Hooks& hooks) {
  const std::filesystem::path page = options.out / test.name / kPage;
  constexpr std::string_view kStyle =
      ".row{display:flex;flex-wrap:wrap;gap:12px}.row figure{margin:0;flex:1 1 300px}"
      "img{width:100%;image-rendering:pixelated}td,th{text-align:left;padding:2px 16px 2px 0}";
  std::string html = lead_html(test) + budgets_html(result) + causes.base_html;
  for (const std::string& reason : causes.missing)
    html += fmt::format("<p>{}</p>\n", escaped(reason));
  for (std::size_t i = 0; i < frames.size(); ++i)
    html += frame_html(frames[i], causes.frames_html[i], fly_to(frames[i], test, options, hooks));
  if (frames.empty()) html += "<p>The missed budgets are not measured per frame.</p>\n";
  const std::string title = core::shown(test.name) + ": budgets missed";
  return core::replace_file(page, telemetry::page_html(title, kStyle, html)).map([&] {
    return page;
  });
}

}  // namespace psygen::frametest
