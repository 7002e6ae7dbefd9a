#include "game/game.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "engine/core/log.hpp"
#include "engine/platform/window.hpp"
#include "engine/scene/scene.hpp"

namespace cairns {
namespace {

constexpr std::uint64_t kFirstSeed = 7;  // of the land behind the title, until a game was saved
constexpr double kSaveEveryS = 60, kZoom = 0.28;
constexpr double kTitleHeightM = 26, kTitleRadiusM = 150, kTitleTurnS = 140;
constexpr int kPictureFrames = 2;  // until the last one has no page over it
constexpr std::uint64_t kBudgetBytes = 256ull << 20;

}  // namespace

core::Result<app::SessionOptions> Game::session_options() {
  auto saves = save_folder(options_.folder);
  if (!saves) return tl::unexpected(saves.error());
  auto config = settings_folder(options_.folder);
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
  session.preset = options_.preset;
  session.prefill = false;
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

core::Result<Game::Loaded> Game::load(std::uint64_t seed) {
  auto land = Land::load(seed);
  if (!land) return tl::unexpected(land.error());
  auto play = Play::create((*land)->world, (*land)->registry);
  if (!play) return tl::unexpected(play.error());
  auto text = land_text(seed);
  if (!text) return tl::unexpected(text.error());
  return Loaded{std::move(*land), std::move(*play), std::move(*text)};
}

core::Result<void> Game::start(app::Session& session) {
  if (auto ok = add_actions(session.actions()); !ok) return ok;
  if (auto read = load_settings(config_, session.actions())) {
    settings_ = *read;
  } else {
    core::log_warning(read.error().message);
  }
  if (auto ok = scenery_.open(session); !ok) return ok;
  const auto destination =
      options_.sound ? audio::Destination::kDevice : audio::Destination::kNowhere;
  sounds_.emplace(session.scene().state().facts.world.block_size_m(), destination);
  apply_settings(session);
  if (session.window() != nullptr) {
    session.window()->set_title("Cairns");
    session.window()->set_right_button_looks(false);
  }
  const double step_s = session.scene().state().simulation.step.step_s;
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
    loading_ = std::async(std::launch::async, load, seed_);
    return {};
  }
  auto loaded = load(seed_);
  if (!loaded) return tl::unexpected(loaded.error());
  return begin(session, std::move(*loaded));
}

// Goes into a land; its save, if there is one, is gone on from.
core::Result<void> Game::begin(app::Session& session, Loaded loaded) {
  const std::uint64_t seed = loaded.land->world.seed;
  auto saved = Saved::open(save_file(saves_, seed), *loaded.play);
  if (!saved) return tl::unexpected(saved.error());
  if (seed != session.scene().state().facts.world.seed) {
    if (auto ok = session.set_world(loaded.text); !ok) return ok;
  }
  scenery_.clear(session);
  pilot_.reset();
  saved_.emplace(std::move(*saved));
  lands_.emplace(std::move(loaded));
  seed_ = seed;
  shown_edits_ = nullptr;
  if (options_.autoplay) pilot_.emplace(*lands_->play);
  open_page(session, Page::kNone);
  until_save_s_ = kSaveEveryS;
  if (lands_->play->progress().time_s < 1)
    hud_.say("Twelve cairns stand in this land.", "The needle knows the next one.", 8);
  return {};
}

void Game::open_page(app::Session& session, Page page) {
  menu_.page = shown_page_ = page;
  if (session.window() == nullptr) return;
  session.window()->capture_cursor(page == Page::kNone);
}

void Game::step(app::Session& session, double dt) {
  if (recording_) (void)recording_->add(session.actions().states());
  if (!lands_ || menu_.page != Page::kNone) return;
  Play& play = *lands_->play;
  Intent intent = pilot_ ? pilot_->steer(dt) : intent_of(session.actions(), settings_.mouse, dt);
  if (zoom_) intent.turn *= kZoom;
  play.step(intent, dt);
}

// After the steps of a frame: what happened is heard and seen, edits go to the scene.
void Game::keep_up(app::Session& session, double dt_s) {
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
  if (until_save_s_ <= 0) save();
  if (saved_) {
    if (const auto done = saved_->outcome(); done && !*done) hud_.say(done->error().message);
  }
}

void Game::save() {
  until_save_s_ = kSaveEveryS;
  if (!lands_ || !saved_) return;
  if (auto ok = saved_->put(*lands_->play); !ok) hud_.say(ok.error().message, {}, 8);
}

void Game::choose(app::Session& session, Choice choice) {
  if (menu_.settings_changed) {
    menu_.settings_changed = false;
    apply_settings(session);
    if (auto ok = save_settings(config_, settings_, session.actions()); !ok)
      menu_.message = ok.error().message;
  }
  if (menu_.page != shown_page_) open_page(session, menu_.page);
  if (choice == Choice::kNew || choice == Choice::kContinue) {
    const bool again = choice == Choice::kContinue;
    const auto seed = again ? last_seed(saves_).value_or(seed_)
                      : menu_.seed.empty()
                          ? core::mix64(static_cast<std::uint64_t>(
                                std::chrono::steady_clock::now().time_since_epoch().count())) %
                                1'000'000
                          : seed_of(menu_.seed);
    if (!loading_.valid() || seed != seed_) loading_ = std::async(std::launch::async, load, seed);
    seed_ = seed;
    menu_.busy = true;
  } else if (choice == Choice::kSave) {
    save();
    hud_.say("Saved.");
    open_page(session, Page::kNone);
  } else if (choice == Choice::kToTitle) {
    save();
    if (saved_) (void)saved_->wait();
    saved_.reset();
    menu_.can_continue = true;
    open_page(session, Page::kTitle);
  } else if (choice == Choice::kPicture) {
    picture_in_ = kPictureFrames;
  } else if (choice == Choice::kQuit) {
    session.close();
  }
}

// Keys that are not of the steps: they also work while the game stands still.
void Game::take_keys(app::Session& session) {
  const auto pressed = [&](Act act) {
    for (const input::Binding& b : session.actions().bindings(static_cast<input::ActionId>(act))) {
      if (input::read(b.control, session.input()).went_down) return true;
    }
    return false;
  };
  const Page page = menu_.page;
  if (page == Page::kTitle || page == Page::kSettings) return;
  if (pressed(Act::kMenu)) open_page(session, page == Page::kNone ? Page::kPause : Page::kNone);
  if (pressed(Act::kMap)) open_page(session, page == Page::kMap ? Page::kNone : Page::kMap);
  if (pressed(Act::kPhoto)) {
    menu_.photo.hour = static_cast<float>(lands_->play->hour());
    menu_.photo.fov_deg = static_cast<float>(settings_.fov_deg);
    open_page(session, page == Page::kPhoto ? Page::kNone : Page::kPhoto);
  }
  if (pressed(Act::kPicture)) picture_in_ = kPictureFrames;
}

void Game::apply_settings(app::Session& session) {
  sounds_->set_volumes(settings_.effects, settings_.music);
  const auto preset = static_cast<render::Preset>(settings_.quality);
  if (!options_.preset && session.renderer().preset() != preset) (void)session.set_preset(preset);
  if (session.window() != nullptr && session.window()->fullscreen() != settings_.fullscreen)
    (void)session.window()->set_fullscreen(settings_.fullscreen);
}

// Over the land of the title, in a slow circle.
core::CameraPose Game::title_camera(app::Session& session, double dt_s) {
  if (!settings_.reduced_motion) title_s_ += dt_s;
  const double angle = title_s_ * 2 * 3.14159265 / kTitleTurnS;
  core::CameraPose pose =
      lands_ ? core::CameraPose{lands_->play->route().start, 0, 0} : session.home();
  const world::World& world = session.scene().state().facts.world;
  query::World query(world, session.scene().state().facts.registry, 1 << 20);
  pose.position =
      at_end_of(pose.position, kTitleRadiusM * glm::dvec3(std::sin(angle), 0, -std::cos(angle)),
                world.block_size_m());
  double height_m = world.water.level_m;
  for (double ahead = -40; ahead <= 80; ahead += 20) {
    const glm::dvec3 way(std::cos(angle) * ahead, 0, std::sin(angle) * ahead);
    if (const auto ground = query.ground(at_end_of(pose.position, way, world.block_size_m())))
      height_m = std::max(height_m, ground->height_m);
  }
  const double wanted = height_m + kTitleHeightM;
  title_height_m_ =
      title_height_m_ == 0 ? wanted : std::lerp(title_height_m_, wanted, std::min(0.4 * dt_s, 1.0));
  pose.position.local.y = title_height_m_;
  pose.yaw = angle + 3.14159265 / 2;
  pose.pitch = -0.16;
  return pose;
}

void Game::take_picture(app::Session& session) {
  for (int i = 1; i < 10'000; ++i) {
    const std::filesystem::path file = saves_ / ("picture-" + std::to_string(i) + ".png");
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) continue;
    const auto saved = session.save_picture(file);
    hud_.say(saved ? "Saved " + file.string() : saved.error().message, {}, 5);
    return;
  }
}

core::CameraPose Game::frame(app::Session& session, double dt_s) {
  using namespace std::chrono_literals;
  if (picture_in_ > 0 && --picture_in_ == 0) take_picture(session);
  if (menu_.busy && loading_.valid() && loading_.wait_for(0s) == std::future_status::ready) {
    menu_.busy = false;
    auto loaded = loading_.get();
    auto begun = loaded ? begin(session, std::move(*loaded)) : tl::unexpected(loaded.error());
    if (!begun) menu_.message = begun.error().message;
  }
  scene::State& state = session.scene().state();
  const bool title = !lands_ || menu_.page == Page::kTitle;
  double fov_deg = settings_.fov_deg;
  core::CameraPose pose;
  if (title) {
    pose = title_camera(session, dt_s);
    session.hud() = {};
  } else {
    Play& play = *lands_->play;
    take_keys(session);
    keep_up(session, dt_s);
    const bool photo = menu_.page == Page::kPhoto;
    zoom_ = has(play.abilities(), Ability::kEye) && state_of(session.actions(), Act::kEye).held;
    if (zoom_) fov_deg *= kZoom;
    if (photo) fov_deg = menu_.photo.fov_deg;
    const double share = state.simulation.step.share;
    pose = play.walker().eyes(share);
    const bool sways = !settings_.reduced_motion && play.walker().gait() == Gait::kGround;
    if (sways) pose.position.local.y += 0.025 * std::sin(play.walker().walked_m() * 3.6);
    scenery_.update(session, play, share, photo ? menu_.photo.hour : play.hour());
    session.hud() = photo ? render::HudDrawing{} : hud_.draw(play, session, settings_, zoom_, dt_s);
    if (photo)
      session.hud().areas.push_back(
          {{}, {{1, 1}, {0, 0}}, kFilters[static_cast<std::size_t>(menu_.photo.filter)].colour});
  }
  state.camera.projection.vertical_fov = static_cast<float>(glm::radians(fov_deg));
  sounds_->update(title ? nullptr : lands_->play.get(), pose, dt_s);
  return pose;
}

core::Result<void> Game::end(app::Session&) {
  if (recording_) {
    if (auto ok = recording_->save(options_.record); !ok) return ok;
  }
  if (!lands_ || !saved_) return {};
  return saved_->put(*lands_->play).and_then([&] { return saved_->wait(); });
}

}  // namespace cairns
