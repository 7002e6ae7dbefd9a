#include "game/game.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <utility>

#include "engine/core/camera.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/log.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/water.hpp"
#include "engine/world/world.hpp"

namespace cairns {
namespace {

constexpr std::uint64_t kFirstSeed = 7;  // land behind the title screen until a game is saved
constexpr double kSaveEveryS = 60, kZoom = 0.28;
constexpr double kSwayM = 0.025, kSwayPerM = 3.6, kPhotoTurn = 0.003;  // radians per pixel
constexpr int kQuietSteps = 2, kTries = 8;  // seeds tried for a random land
constexpr std::uint64_t kSeeds = 1'000'000'000;
constexpr double kTitleHeightM = 26, kTitleRadiusM = 150, kTitleTurnS = 140;
constexpr int kPictureFrames = 2;  // frames until the rendered image has no page over it
constexpr std::uint64_t kBudgetBytes = 256ull << 20;

// The user's folder, or `given`.
core::Result<std::filesystem::path> folder_for(core::UserFolder purpose,
                                               const std::filesystem::path& given) {
  return core::user_folder(purpose, "cairns", given).map_error([](const core::Error& error) {
    return core::Error{error.code, "saved games and settings need a folder that can be written: " +
                                       error.message + " (--folder names another one)"};
  });
}

}  // namespace

core::Result<app::SessionOptions> Game::session_options() {
  auto saves = folder_for(core::UserFolder::kData, options_.folder);
  if (!saves) return tl::unexpected(saves.error());
  auto config = folder_for(core::UserFolder::kConfig, options_.folder);
  if (!config) return tl::unexpected(config.error());
  saves_ = *saves;
  config_ = *config;
  seed_ = !options_.seed.empty() ? seed_of(options_.seed) : last_seed(saves_).value_or(kFirstSeed);
  auto text = land_text(seed_);
  if (!text) return tl::unexpected(text.error());
  app::SessionOptions session;
  session.world_file = *land_file();
  session.world_text = std::move(*text);
  session.headless = options_.headless;
  session.size = options_.size;
  if (auto read = load_settings(config_)) {
    settings_ = *read;
  } else {
    settings_broken_ = true;
    menu_.message = read.error().message;
  }
  session.preset = options_.preset;
  if (!session.preset && settings_.quality >= 0)
    session.preset = static_cast<render::Preset>(settings_.quality);
  session.scene.budget_bytes = kBudgetBytes;
  session.scene.modelers = options_.modelers;
  session.scene.virtual_time = options_.virtual_time;
  app::Plugin plugin;
  plugin.name = "cairns";
  plugin.register_models = add_types;
  plugin.on_step = [this](app::Session& s, double dt) { step(s, dt); };
  plugin.on_gui = [this](app::Session& s) {
    if (picture_in_ == 0) choose(s, menu_.draw(s, play(), settings_));
  };
  session.plugins.push_back(std::move(plugin));
  return session;
}

core::Result<Game::Loaded> Game::load(std::uint64_t seed, int tries) {
  auto land = Land::load(seed);
  if (!land) return tl::unexpected(land.error());
  auto play = Play::create((*land)->world, (*land)->registry);
  if (!play && tries > 1) return load(seed + 1, tries - 1);
  if (!play) return tl::unexpected(play.error());
  return Loaded{std::move(*land), std::move(*play)};
}

void Game::load_later(std::uint64_t seed, int tries) {
  if (loading_.valid() && seed == seed_) return;
  if (loading_.valid()) dropped_.push_back(std::move(loading_));  // finishes in the background
  loading_ = std::async(std::launch::async, load, seed, tries);
  seed_ = seed;
}

core::Result<void> Game::start(app::Session& session) {
  if (auto ok = add_actions(session.actions()); !ok) return ok;
  if (auto ok = load_keys(config_, session.actions()); !ok) {
    settings_broken_ = true;
    menu_.message = ok.error().message;
  }
  if (settings_broken_) core::log_warning(menu_.message);
  if (settings_.quality < 0) settings_.quality = static_cast<int>(session.renderer().preset());
  title_place_ = session.home().position;
  if (auto ok = scenery_.open(session); !ok) return ok;
  const auto destination =
      options_.sound ? audio::Destination::kDevice : audio::Destination::kNowhere;
  sounds_.emplace(session.scene().world().block_size_m(), destination);
  apply_settings(session);
  if (session.window() != nullptr) {
    session.window()->set_title("Cairns");
    session.window()->set_right_button_looks(false);
  }
  const double step_s = session.scene().step().step_s;
  if (!options_.record.empty()) recording_.emplace(session.actions(), step_s);
  if (!options_.replay.empty()) {
    auto recording = input::Recording::load(options_.replay);
    if (!recording) return tl::unexpected(recording.error());
    auto replay = input::Replay::create(std::move(*recording), session.actions(), step_s);
    if (!replay) return tl::unexpected(replay.error());
    session.replay(std::move(*replay));
  }
  menu_.can_continue = last_seed(saves_).has_value();
  if (options_.seed.empty() && !options_.autoplay) {
    loading_ = std::async(std::launch::async, load, seed_, 1);
    return {};
  }
  auto loaded = load(seed_);
  if (!loaded) return tl::unexpected(loaded.error());
  return begin(session, std::move(*loaded));
}

// Enters a land, and resumes its save if there is one.
core::Result<void> Game::begin(app::Session& session, Loaded loaded) {
  const std::uint64_t seed = loaded.land->world.seed;
  const bool is_kept = options_.record.empty() && options_.replay.empty();
  std::optional<Saved> opened;
  if (is_kept) {
    auto saved = Saved::open(save_file(saves_, seed), *loaded.play);
    if (!saved) return tl::unexpected(saved.error());
    opened.emplace(std::move(*saved));
  }
  if (seed != session.scene().world().seed) {
    title_query_.reset();
    if (auto ok = session.set_world(loaded.land->text); !ok) return ok;
  }
  scenery_.clear(session);
  pilot_.reset();
  saved_ = std::move(opened);
  unsaved_s_ = unsaved_at_put_s_ = 0;
  lands_.emplace(std::move(loaded));
  seed_ = seed;
  if (options_.autoplay) pilot_.emplace(*lands_->play);
  title_place_ = lands_->play->route().start;
  open_page(session, Page::kNone);
  until_save_s_ = kSaveEveryS;
  shown_edits_ = lands_->play->edits().layer();
  session.scene().edit(lands_->play->edits());
  // Fill the cache first, so that the player never sees a half-built land.
  const core::CameraPose eyes = frame(session, 0);
  if (auto ok = session.prepare(eyes); !ok) return ok;
  if (saved_ && saved_->notice())
    hud_.say(saved_->notice()->line, saved_->notice()->help, 8);
  else if (lands_->play->progress().time_s < 1)
    hud_.say("Twelve cairns stand in this land.", "The mark on the compass points to the next one.",
             8);
  return {};
}

void Game::open_page(app::Session& session, Page page) {
  if (shown_page_ == Page::kSettings && page != Page::kSettings && !settings_broken_) {
    if (auto ok = save_settings(config_, settings_, session.actions()); !ok)
      hud_.say(ok.error().message, {}, 8);
  }
  if (page == Page::kPhoto && lands_) {
    menu_.photo.hour = static_cast<float>(lands_->play->hour());
    menu_.photo.fov_deg = static_cast<float>(settings_.fov_deg);
    photo_turn_ = {};
  }
  menu_.page = shown_page_ = page;
  quiet_steps_ = kQuietSteps;
  if (session.window() == nullptr) return;
  session.window()->set_right_button_looks(page == Page::kPhoto);
  session.window()->capture_cursor(page == Page::kNone);
}

void Game::step(app::Session& session, double dt) {
  if (!lands_ || menu_.page != Page::kNone) return;
  unsaved_s_ += dt;
  if (recording_) {
    if (auto ok = recording_->add(session.actions().states()); !ok) {
      hud_.say(ok.error().message, {}, 8);
      recording_.reset();
    }
  }
  Play& play = *lands_->play;
  const double mouse = recording_ || session.replays() ? 1 : settings_.mouse;
  Intent intent = pilot_ ? pilot_->steer(dt) : intent_of(session.actions(), mouse, dt);
  zoom_ = has(play.abilities(), Ability::kEye) && state_of(session.actions(), Act::kEye).held;
  if (zoom_) {
    intent.turn *= kZoom;
    intent.look *= kZoom;
  }
  if (quiet_steps_ > 0 && !pilot_) {
    --quiet_steps_;
    intent.jump = intent.use = intent.build = intent.fire = intent.sleep = intent.lantern = false;
  }
  play.step(intent, dt);
}

// After the steps of a frame: presents the events, and hands edits to the scene.
void Game::sync_presentation(app::Session& session, double dt_s) {
  Play& play = *lands_->play;
  for (const Happening& happening : play.take_happenings()) {
    hud_.tell(happening);
    scenery_.tell(session, happening, play);
    sounds_->tell(happening, play);
    if (happening.kind == Happening::Kind::kFound || happening.kind == Happening::Kind::kSlept)
      until_save_s_ = 0;
  }
  if (play.edits().layer() != shown_edits_) {
    shown_edits_ = play.edits().layer();
    session.scene().edit(play.edits());
  }
  until_save_s_ -= dt_s;
  if (until_save_s_ <= 0) {
    if (auto ok = save(); !ok) hud_.say(ok.error().message, {}, 8);
  }
  if (saved_) {
    if (const auto done = saved_->outcome()) note_outcome(*done);
  }
}

core::Result<void> Game::save() {
  until_save_s_ = kSaveEveryS;
  if (!lands_ || !saved_) return {};
  auto put = saved_->put(*lands_->play);
  unsaved_at_put_s_ = put ? unsaved_s_ : 0;
  return put;
}

// Takes the result of a finished write.
void Game::note_outcome(const core::Result<void>& outcome) {
  menu_.cannot_save = !outcome;
  if (outcome)
    unsaved_s_ -= std::exchange(unsaved_at_put_s_, 0);
  else
    hud_.say(outcome.error().message, {}, 8);
}

core::Result<void> Game::save_now() {
  auto saved = save().and_then([&] { return saved_ ? saved_->wait() : core::Result<void>(); });
  note_outcome(saved);
  return saved;
}

// Returns false if the game cannot be saved; the page then shows the reason.
bool Game::save_and_leave() {
  const auto saved = save_now();
  if (!saved)
    menu_.message = fmt::format("{}. Make room and save again, or lose the last {:.0f} s.",
                                saved.error().message, unsaved_s_);
  return saved.has_value();
}

bool Game::may_end(app::Session& session) {
  if (session.stopped() || session.window() == nullptr || is_settled_) return true;
  is_settled_ = save_and_leave();
  if (is_settled_) return true;
  const std::string message = menu_.message;
  if (menu_.page != Page::kPause) open_page(session, Page::kPause);
  menu_.message = message;
  session.keep_open();
  return false;
}

void Game::choose(app::Session& session, Choice choice) {
  if (menu_.page != shown_page_) open_page(session, menu_.page);
  if (choice == Choice::kContinue) load_later(last_seed(saves_).value_or(seed_), 1);
  if (choice == Choice::kNew && !menu_.seed.empty()) load_later(seed_of(menu_.seed), 1);
  if (choice == Choice::kNew && menu_.seed.empty()) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    load_later(core::mix64(static_cast<std::uint64_t>(now)) % kSeeds, kTries);
  }
  if (choice == Choice::kNew || choice == Choice::kContinue) menu_.busy = true;
  if (choice == Choice::kPicture) picture_in_ = kPictureFrames;
  if (choice == Choice::kSave && save_and_leave()) {
    hud_.say("Saved.");
    open_page(session, Page::kNone);
  }
  if (choice == Choice::kQuit) session.close();  // may_end() saves
  if (choice == Choice::kAbandon) {
    is_settled_ = true;
    session.close();
  }
  if (choice == Choice::kToTitle && save_and_leave()) {
    scenery_.clear(session);
    pilot_.reset();
    saved_.reset();
    lands_.reset();
    menu_.can_continue = true;
    open_page(session, Page::kTitle);
  }
}

// Handles the keys that also work while the game is paused.
void Game::take_keys(app::Session& session) {
  const auto pressed = [&](Act act) {
    for (const input::Binding& b : session.actions().bindings(static_cast<input::ActionId>(act))) {
      if (input::read(b.control, session.input()).went_down) return true;
    }
    return false;
  };
  const Page page = menu_.page;
  const bool plays = page == Page::kNone;
  if (page == Page::kSettings || page == Page::kCredits || session.replays()) return;
  if (pressed(Act::kMenu)) {
    open_page(session, plays ? Page::kPause : Page::kNone);
  } else if (pressed(Act::kMap) && (plays || page == Page::kMap)) {
    open_page(session, plays ? Page::kMap : Page::kNone);
  } else if (pressed(Act::kPhoto) && plays) {
    open_page(session, Page::kPhoto);
  }
  if (pressed(Act::kPicture)) picture_in_ = kPictureFrames;
}

void Game::apply_settings(app::Session& session) {
  sounds_->set_volumes(settings_.effects, settings_.music);
  const auto preset = static_cast<render::Preset>(settings_.quality);
  if (!options_.preset && session.renderer().preset() != preset) {
    if (auto ok = session.set_preset(preset); !ok) {
      menu_.message = ok.error().message;
      settings_.quality = static_cast<int>(session.renderer().preset());
    }
  }
  if (session.window() != nullptr && session.window()->fullscreen() != settings_.fullscreen)
    (void)session.window()->set_fullscreen(settings_.fullscreen);
}

// Circles slowly above the land behind the title screen.
core::CameraPose Game::title_camera(app::Session& session, double dt_s) {
  if (!settings_.reduced_motion) title_s_ += dt_s;
  const double angle = title_s_ * 2 * std::numbers::pi / kTitleTurnS;
  const scene::WorldFacts& facts = session.scene().facts();
  const world::World& world = facts.world;
  if (!title_query_) title_query_.emplace(world, facts.registry);
  core::CameraPose pose;
  pose.position = position_at_offset(
      title_place_, kTitleRadiusM * glm::dvec3(std::sin(angle), 0, -std::cos(angle)),
      world.block_size_m());
  double height_m = world::kDrySurfaceM;
  for (double ahead = -40; ahead <= 80; ahead += 20) {
    const glm::dvec3 way(std::cos(angle) * ahead, 0, std::sin(angle) * ahead);
    const core::WorldPosition there = position_at_offset(pose.position, way, world.block_size_m());
    if (const auto water = world::water_surface(world, there))
      height_m = std::max(height_m, water->surface_m);
    if (const auto ground = title_query_->ground(there))
      height_m = std::max(height_m, ground->height_m);
  }
  const double wanted = height_m > world::kDrySurfaceM ? height_m + kTitleHeightM : title_height_m_;
  title_height_m_ =
      title_height_m_ == 0 ? wanted : std::lerp(title_height_m_, wanted, std::min(0.4 * dt_s, 1.0));
  pose.position.local.y = title_height_m_;
  pose.yaw = angle + std::numbers::pi / 2;
  pose.pitch = -0.16;
  return pose;
}

void Game::take_picture(app::Session& session) {
  for (int i = 1; i < 10'000; ++i) {
    const std::filesystem::path file = saves_ / ("picture-" + std::to_string(i) + ".png");
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) continue;
    const auto saved = session.save_picture(file);
    const std::string said = saved ? "Saved " + file.string() : saved.error().message;
    hud_.say(said, {}, 5);
    menu_.message = said;
    return;
  }
}

core::CameraPose Game::frame(app::Session& session, double dt_s) {
  using namespace std::chrono_literals;
  if (picture_in_ > 0 && --picture_in_ == 0) take_picture(session);
  if (std::exchange(menu_.settings_changed, false)) apply_settings(session);
  std::erase_if(dropped_,
                [](auto& land) { return land.wait_for(0s) == std::future_status::ready; });
  if (menu_.busy && loading_.valid() && loading_.wait_for(0s) == std::future_status::ready) {
    menu_.busy = false;
    auto loaded = loading_.get();
    auto begun = loaded ? begin(session, std::move(*loaded)) : tl::unexpected(loaded.error());
    if (!begun) menu_.message = begun.error().message;
  }
  core::CameraPose pose;
  if (lands_) {
    pose = playing(session, dt_s);
  } else {
    pose = title_camera(session, dt_s);
    session.hud() = {};
  }
  sounds_->update(lands_ ? lands_->play.get() : nullptr, pose, dt_s);
  return pose;
}

// Returns the camera of a running game, and updates its HUD and scenery.
core::CameraPose Game::playing(app::Session& session, double dt_s) {
  Play& play = *lands_->play;
  take_keys(session);
  sync_presentation(session, dt_s);
  scene::Scene& scene = session.scene();
  const bool photo = menu_.page == Page::kPhoto;
  const double share = scene.step().share;
  core::CameraPose pose = play.walker().eyes(share);
  const bool sways = !settings_.reduced_motion && play.walker().gait() == Gait::kGround;
  if (sways) pose.position.local.y += kSwayM * std::sin(play.walker().walked_m() * kSwayPerM);
  scenery_.update(session, play, share, photo ? menu_.photo.hour : play.hour());
  double fov_deg = settings_.fov_deg * (zoom_ ? kZoom : 1);
  session.hud() = {};
  if (photo) {
    fov_deg = menu_.photo.fov_deg;
    const glm::dvec2 moved = session.input().look_px * kPhotoTurn;
    photo_turn_ += glm::dvec2(moved.x, -moved.y);
    pose.yaw += photo_turn_.x;
    pose.pitch = std::clamp(pose.pitch + photo_turn_.y, -1.5, 1.5);
    const Filter& filter = kFilters[static_cast<std::size_t>(menu_.photo.filter)];
    session.hud().areas.push_back({{}, {{1, 1}, {0, 0}}, filter.colour});
  } else {
    session.hud() = hud_.draw(play, session, settings_, zoom_, dt_s);
  }
  scene.set_field_of_view(static_cast<float>(glm::radians(fov_deg)));
  return pose;
}

core::Result<void> Game::end() {
  auto kept = is_settled_ ? core::Result<void>() : save_now();
  if (!kept)
    kept.error().message += fmt::format("; the last {:.0f} s of the game are lost", unsaved_s_);
  if (recording_) {
    if (auto ok = recording_->save(options_.record); !ok && kept) kept = ok;
  }
  return kept;
}

}  // namespace cairns
