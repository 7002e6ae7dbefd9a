#include "editor/pictures/picture_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <QCoreApplication>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "editor/pictures/export_file.hpp"
#include "editor/pictures/model_world.hpp"
#include "editor/pictures/picture_request.hpp"
#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/log.hpp"
#include "engine/core/processors.hpp"
#include "engine/handmade/files.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

constexpr double kServerWatchdogS = 12;
constexpr double kErrorPixels = 1.5, kSmallErrorPixels = 3;
constexpr std::uint32_t kSmallWidth = 1000;  // narrower images allow more error
constexpr std::uint64_t kServerBudgetBytes = 384ULL << 20;
constexpr double kMinEyeM = 0.6;  // minimum height of the camera above the ground
constexpr int kHungExit = 3;
constexpr const char* kNoInstance = "the model has no instance";
constexpr std::size_t kChunk = 1 << 16;

core::Error failed(std::string message) {
  return {core::ErrorCode::kSynthesisFailed, std::move(message)};
}

// Reads lines from the standard input.
class LineInput {
 public:
  // The next line; nullopt at the end of the input.
  std::optional<QByteArray> next() {
    while (true) {
      if (const qsizetype end = buffer_.indexOf('\n'); end >= 0) {
        QByteArray line = buffer_.left(end);
        buffer_.remove(0, end + 1);
        return line;
      }
      if (!read()) return std::nullopt;
    }
  }
  // True if another line is complete. Ends the process if the other end has closed the pipe.
  bool waiting() {
    if (buffer_.contains('\n')) return true;
    pollfd poll{STDIN_FILENO, POLLIN, 0};
    if (::poll(&poll, 1, 0) <= 0) return false;
    if (!read()) std::_Exit(0);
    return buffer_.contains('\n');
  }

 private:
  bool read() {
    char bytes[kChunk];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) return false;
    buffer_.append(bytes, static_cast<qsizetype>(count));
    return true;
  }
  QByteArray buffer_;
};

class PictureServer {
 public:
  PictureServer(std::vector<app::Plugin> plugins, std::string device_name)
      : plugins_(std::move(plugins)), device_name_(std::move(device_name)) {}

  // Answers requests until the input ends.
  int run() {
    while (const auto line = input_.next()) {
      const auto request = request_from(*line);
      if (!request) continue;
      const PictureReply reply = answer(*request);
      const QByteArray text = to_line(reply);
      if (::write(out_, text.constData(), static_cast<std::size_t>(text.size())) < 0) return 0;
      if (session_ && session_->has_hung_modelers()) std::_Exit(kHungExit);
    }
    return 0;
  }
  // Reserves the standard output for answers; other output goes to the standard error.
  bool take_output() {
    out_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    return out_ >= 0 && ::dup2(STDERR_FILENO, STDOUT_FILENO) >= 0;
  }

 private:
  PictureReply answer(const PictureRequest& request) {
    PictureReply reply;
    reply.id = request.id;
    files_ = files_of(request);
    const auto parsed = parse_world_text(
        request.text, request.file,
        [this](auto& registry) { return app::register_models(plugins_, registry); }, files_.get());
    core::Result<void> done;
    if (!parsed) {
      done = tl::unexpected(parsed.error());
    } else if (request.kind == PictureKind::kCost) {
      reply.cost = block_cost(**parsed, block_of(request, (*parsed)->world), learnt(), false);
    } else if (request.kind == PictureKind::kMeasure) {
      const auto portrait = portrait_pose(**parsed, projection_of(request));
      if (!portrait) done = tl::unexpected(failed(kNoInstance));
      if (portrait) reply.distance_m = portrait->distance_m;
    } else if (request.kind == PictureKind::kExportModel ||
               request.kind == PictureKind::kExportBlock) {
      const core::BlockCoord block{request.block_x, request.block_z};
      const auto note =
          request.kind == PictureKind::kExportBlock
              ? export_block(**parsed, block, request.level, request.out)
              : export_model(**parsed, block, request.index, request.level, request.out);
      done = note.map([&](const std::string& text) { reply.note = text; });
    } else {
      done = draw(request, **parsed, reply);
    }
    if (!done) reply.error = done.error().message;
    return reply;
  }

  // The resources of the world with its unsaved images. Parsing the world reports unreadable files.
  static handmade::FilesPtr files_of(const PictureRequest& request) {
    auto pictures = std::make_shared<handmade::InMemoryImages>();
    for (const auto& [name, file] : request.pictures) {
      if (auto picture = handmade::files().read_grey(file))
        pictures->in_place[name] = *std::move(picture);
    }
    return handmade::files_with(request.file, std::move(pictures));
  }

  const synthesis::CostModel* learnt() const {
    return session_ ? &session_->scene().meshes().costs() : nullptr;
  }

  core::Result<void> draw(const PictureRequest& request, const ParsedWorld& parsed,
                          PictureReply& reply) {
    if (auto ok = show(request, parsed); !ok) return ok;
    scene::Scene& scene = session_->scene();
    const core::Projection projection = projection_of(request);
    core::CameraPose pose = session_->home();
    if (request.kind == PictureKind::kPortrait) {
      const auto portrait = portrait_pose(parsed, projection, request.distance_m);
      if (!portrait) return tl::unexpected(failed(kNoInstance));
      pose = portrait->pose;
    } else if (request.place) {
      pose = pose_of(*request.place, parsed.world);
    }
    if (!core::is_valid(pose)) return tl::unexpected(failed("the camera pose is not valid"));
    session_->set_now(request.now_s);
    const bool small = request.kind == PictureKind::kPicture && request.size.width <= kSmallWidth;
    scene.set_max_error(small ? kSmallErrorPixels : kErrorPixels);
    scene.input().size = session_->picture_size();
    const std::uint64_t failed_before = scene.statistics().failed_in_all;
    session_->scene().settle(pose, [&](std::string_view, double) {
      reply.dropped = reply.dropped || input_.waiting();
      return !reply.dropped;
    });
    if (reply.dropped) return {};
    if (auto ok = session_->tick(pose, 0); !ok) return ok;
    if (scene.statistics().failed_in_all > failed_before || scene.statistics().drawn.holes > 0)
      return tl::unexpected(failed(what_failed(scene)));
    reply.cost = block_cost(parsed, block_of(request, parsed.world), learnt(), false);
    return session_->save_picture(request.out);
  }

  static core::Projection projection_of(const PictureRequest& request) {
    core::Projection projection;
    projection.aspect =
        static_cast<float>(request.size.width) / static_cast<float>(request.size.height);
    return projection;
  }

  static std::string what_failed(const scene::Scene& scene) {
    const auto& hung = scene.meshes().hung();
    if (!hung.empty()) return fmt::format("a model takes more than {} s", kServerWatchdogS);
    return "a model could not be made";
  }

  // The session with this world and size.
  core::Result<void> show(const PictureRequest& request, const ParsedWorld& parsed) {
    const std::filesystem::path folder = std::filesystem::path(request.file).parent_path();
    const bool same_pictures = session_ && images_ == parsed.world.palette.images &&
                               (images_empty(parsed.world) || folder == folder_);
    if (same_pictures) {
      if (session_->picture_size() != request.size) {
        if (auto ok = session_->renderer().resize(request.size); !ok) return ok;
      }
      session_->set_files(files_);
      return session_->set_world(request.text);
    }
    session_.reset();
    app::SessionOptions options;
    options.world_text = request.text;
    options.world_file = request.file;
    options.files = files_;
    options.headless = true;
    options.device_name = device_name_;
    options.size = request.size;
    options.preset = render::Preset::kHigh;
    options.plugins = plugins_;
    options.scene.budget_bytes = kServerBudgetBytes;
    options.scene.max_error_pixels = kErrorPixels;
    options.scene.fade_seconds = 0;
    // All processors, because the main thread waits meanwhile.
    options.scene.modelers = core::usable_processors();
    options.scene.watchdog_seconds = kServerWatchdogS;
    auto session = app::Session::create(std::move(options));
    if (!session) return tl::unexpected(session.error());
    session_ = std::move(*session);
    images_ = parsed.world.palette.images;
    folder_ = folder;
    return {};
  }

  static bool images_empty(const world::World& world) {
    return world.palette.images == decltype(world.palette.images){};
  }

  // The block around which costs are predicted.
  static core::BlockCoord block_of(const PictureRequest& request, const world::World& world) {
    if (request.place) return pose_of(*request.place, world).position.block;
    return {static_cast<std::int32_t>(world.blocks_x / 2),
            static_cast<std::int32_t>(world.blocks_z / 2)};
  }

  static core::CameraPose pose_of(const PicturePlace& place, const world::World& world) {
    core::CameraPose pose{{{}, {place.at_m.x, 0, place.at_m.z}}, place.yaw, place.pitch};
    pose.position = core::normalised(pose.position, world.block_size_m());
    const double surface_m = world::surface_height_m(world, pose.position);
    const double height_m = place.at_m.y + (place.above_ground ? surface_m : 0);
    pose.position.local.y = std::max(height_m, surface_m + kMinEyeM);
    return pose;
  }

  std::vector<app::Plugin> plugins_;
  std::string device_name_;
  std::unique_ptr<app::Session> session_;
  handmade::FilesPtr files_;  // of the request
  decltype(world::Palette{}.images) images_{};
  std::filesystem::path folder_;
  LineInput input_;
  int out_ = -1;
};

}  // namespace

int render_pictures(std::vector<app::Plugin> plugins, std::string device_name) {
  // Before the first thread starts, because threads inherit the priority.
  (void)::setpriority(PRIO_PROCESS, 0, 19);
  std::ofstream("/proc/self/oom_score_adj") << 1000;
  const rlimit no_core{0, 0};
  (void)::setrlimit(RLIMIT_CORE, &no_core);
  PictureServer server(std::move(plugins), std::move(device_name));
  return server.take_output() ? server.run() : 1;
}

}  // namespace psygen::editor
