#include "game/show/menu.hpp"

#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <cmath>
#include <utility>

namespace cairns {
namespace {

constexpr float kWidth = 340;
constexpr std::array<const char*, 4> kQualities{"low", "medium", "high", "ultra"};
constexpr int kMapCells = 25;  // on each side of the player

// Focuses the next control and draws its highlight, without which keys and pads do not click it.
// ImGui hides that of a focus that a program sets since 1.90.
void focus_next() {
  ImGui::SetKeyboardFocusHere();
#if IMGUI_VERSION_NUM >= 19140
  ImGui::SetNavCursorVisible(true);
#else
  ImGui::GetCurrentContext()->NavDisableHighlight = false;
#endif
}

// Begins a window without a frame at the left. `opened`: its first control takes the focus.
void begin(const char* title, float scale, float width, float text, bool opened) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x * 0.08F, size.y * 0.5F}, ImGuiCond_Always, {0, 0.5F});
  ImGui::SetNextWindowSize({width * scale, 0}, ImGuiCond_Always);
  ImGui::SetNextWindowBgAlpha(0.72F);
  ImGui::Begin(title, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse);
  ImGui::SetWindowFontScale(text);
  if (opened) focus_next();
}

// Map colours, in the order of world::GroundKind; the last one is water.
constexpr std::array<ImU32, 7> kMapColours{
    IM_COL32(98, 125, 62, 255),   IM_COL32(62, 92, 48, 255),    IM_COL32(166, 150, 96, 255),
    IM_COL32(205, 188, 140, 255), IM_COL32(132, 126, 118, 255), IM_COL32(236, 240, 244, 255),
    IM_COL32(66, 106, 128, 255)};

}  // namespace

void Menu::open(Page next) {
  if (next == Page::kSettings || next == Page::kCredits) before_ = page;
  page = next;
  message.clear();
  capture_.reset();
}

bool Menu::button(const char* label) {
  const bool clicked = ImGui::Button(label, {-1, 0});
  // ImGui's own keyboard click is the space bar.
  return clicked || (enter_ && ImGui::IsItemFocused());
}

Choice Menu::draw(app::Session& session, const Play* play, Settings& settings) {
  const bool opened = std::exchange(drawn_, page) != page;
  if (page != Page::kNone && !opened && goes_back(session.input()))
    open(page == Page::kSettings || page == Page::kCredits ? before_ : Page::kNone);
  if (page == Page::kNone) return Choice::kNothing;
  enter_ = input::read(platform::Key::kEnter, session.input()).went_down;
  // Keys also reach the game, which closes pages. Text fields capture them regardless.
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableGamepad |
                                ImGuiConfigFlags_NavEnableKeyboard |
                                ImGuiConfigFlags_NavNoCaptureKeyboard;
  text_ = static_cast<float>(settings.text);
  const auto scale = text_ * ImGui::GetFontSize() / 16;
  if (page == Page::kMap) {
    if (play != nullptr) draw_map(*play, session);
    return Choice::kNothing;
  }
  begin("cairns", scale, page == Page::kSettings ? 1.6F * kWidth : kWidth, text_, opened);
  Choice choice = Choice::kNothing;
  if (page == Page::kTitle) choice = draw_title();
  if (page == Page::kPause) choice = draw_pause();
  if (page == Page::kPhoto) choice = draw_photo();
  if (page == Page::kSettings) draw_settings(session, settings);
  if (page == Page::kCredits) draw_credits();
  if (!message.empty()) ImGui::TextWrapped("%s", message.c_str());
  ImGui::End();
  return choice;
}

void Menu::heading(const char* words, float size) const {
  ImGui::SetWindowFontScale(size * text_);
  ImGui::TextUnformatted(words);
  ImGui::SetWindowFontScale(text_);
}

// Returns true on Escape or the gamepad's B, except while a key is being rebound.
bool Menu::goes_back(const platform::InputState& input) const {
  return page != Page::kTitle && !capture_ &&
         (input::read(platform::Key::kEscape, input).went_down ||
          input::read(platform::PadButton::kB, input).went_down);
}

Choice Menu::draw_title() {
  heading("Cairns", 2.6F);
  ImGui::Spacing();
  if (busy) {
    ImGui::TextUnformatted("Creating the land …");
    return Choice::kNothing;
  }
  if (can_continue && button("Continue")) return Choice::kContinue;
  char typed[64] = {};
  seed.copy(typed, sizeof(typed) - 1);
  ImGui::SetNextItemWidth(-1);
  const bool entered =
      ImGui::InputTextWithHint("##seed", "Seed: any word or number", typed, sizeof(typed),
                               ImGuiInputTextFlags_EnterReturnsTrue);
  seed = typed;
  if (button("New land") || entered) return Choice::kNew;
  if (button("Settings")) open(Page::kSettings);
  if (button("Credits")) open(Page::kCredits);
  return button("Quit") ? Choice::kQuit : Choice::kNothing;
}

Choice Menu::draw_pause() {
  heading("Pause", 1.6F);
  if (button("Resume")) open(Page::kNone);
  if (button("Save")) return Choice::kSave;
  if (button("Map")) open(Page::kMap);
  if (button("Photo mode")) open(Page::kPhoto);
  if (button("Settings")) open(Page::kSettings);
  if (button("Quit to title")) return Choice::kToTitle;
  if (cannot_save && button("Quit without saving")) return Choice::kAbandon;
  return button("Save and quit") ? Choice::kQuit : Choice::kNothing;
}

void Menu::draw_settings(app::Session& session, Settings& settings) {
  bool changed = ImGui::Combo("quality", &settings.quality, kQualities.data(), 4);
  for (const Number& n : kNumbers)
    changed |= ImGui::SliderScalar(n.label, ImGuiDataType_Double, &(settings.*n.value), &n.low,
                                   &n.high, "%.2f");
  for (const Switch& box : kSwitches)
    changed |= ImGui::Checkbox(box.label, &(settings.*box.value));
  if (ImGui::CollapsingHeader("Keys and gamepad")) draw_keys(session);
  settings_changed |= changed;
  if (button("Back")) open(before_);
}

void Menu::draw_keys(app::Session& session) {
  input::Actions& actions = session.actions();
  if (capture_) {
    ImGui::Text("Press a key or button for \"%s\" (Escape cancels)",
                label_of(static_cast<Act>(captured_)));
    if (const auto control = capture_->update(session.input())) {
      capture_.reset();
      const bool cancelled = *control == input::Control(platform::Key::kEscape);
      if (!cancelled) settings_changed |= actions.rebind(captured_, *control).has_value();
    }
    return;
  }
  for (auto i = static_cast<std::size_t>(Act::kAhead); i < kActs; ++i) {
    const std::string key = key_of(actions, static_cast<Act>(i), session.window());
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Button(key.c_str(), {ImGui::GetFontSize() * 9, 0})) {
      captured_ = i;
      capture_.emplace(session.input());
    }
    ImGui::SameLine();
    ImGui::TextUnformatted(label_of(static_cast<Act>(i)));
    ImGui::PopID();
  }
  if (button("Reset to defaults")) {
    actions.reset_bindings();
    settings_changed = true;
  }
}

// Draws the explored cells from above, north up, with the player in the centre.
void Menu::draw_map(const Play& play, const app::Session& session) {
  const core::Extent extent = session.picture_size();
  const float cell = static_cast<float>(extent.height) * 0.86F / (2 * kMapCells + 1);
  const glm::vec2 middle(static_cast<float>(extent.width) / 2,
                         static_cast<float>(extent.height) / 2);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto place = [&](const core::WorldPosition& at) {
    const glm::dvec3 way = way_m(play.progress().feet, at, play.block_m());
    return middle + glm::vec2(static_cast<float>(way.x), static_cast<float>(way.z)) *
                        (cell / static_cast<float>(kMapCellM));
  };
  const float half = cell * (kMapCells + 0.5F);
  list.AddRectFilled({middle.x - half, middle.y - half}, {middle.x + half, middle.y + half},
                     IM_COL32(24, 26, 30, 225), 6);
  const glm::dvec3 at = way_m({}, play.progress().feet, play.block_m());
  const auto number = [](double m) { return static_cast<std::int32_t>(std::floor(m / kMapCellM)); };
  for (std::int32_t z = number(at.z) - kMapCells; z <= number(at.z) + kMapCells; ++z) {
    for (std::int32_t x = number(at.x) - kMapCells; x <= number(at.x) + kMapCells; ++x) {
      const auto seen = play.progress().seen.find(cell_name(x, z));
      if (seen == play.progress().seen.end()) continue;
      core::WorldPosition corner;
      corner.local = {x * kMapCellM, 0, z * kMapCellM};
      const glm::vec2 from = place(corner);
      list.AddRectFilled({from.x, from.y}, {from.x + cell + 0.6F, from.y + cell + 0.6F},
                         kMapColours[seen->second]);
    }
  }
  const auto is_on_map = [&](glm::vec2 p) {
    return std::abs(p.x - middle.x) <= half && std::abs(p.y - middle.y) <= half;
  };
  for (std::size_t i = 0; i < kCairns; ++i) {
    const glm::vec2 p = place(play.route().cairns[i]);
    if (play.progress().found[i] && is_on_map(p))
      list.AddTriangleFilled({p.x, p.y - 8}, {p.x - 6, p.y + 5}, {p.x + 6, p.y + 5},
                             IM_COL32(255, 196, 92, 255));
  }
  for (const core::WorldPosition& waymark : play.progress().waymarks) {
    const glm::vec2 p = place(waymark);
    if (is_on_map(p))
      list.AddRectFilled({p.x - 4, p.y - 4}, {p.x + 4, p.y + 4}, IM_COL32(240, 240, 240, 255));
  }
  const double yaw = play.walker().yaw();
  const ImVec2 tip(middle.x + 12 * static_cast<float>(std::sin(yaw)),
                   middle.y - 12 * static_cast<float>(std::cos(yaw)));
  list.AddCircleFilled({middle.x, middle.y}, 5, IM_COL32(220, 60, 48, 255));
  list.AddLine({middle.x, middle.y}, tip, IM_COL32(220, 60, 48, 255), 3);
  list.AddText({middle.x - 4, middle.y - half + 4}, IM_COL32(255, 255, 255, 220), "N");
}

Choice Menu::draw_photo() {
  ImGui::SliderFloat("hour", &photo.hour, 0, 24, "%.1f");
  ImGui::SliderFloat("field of view", &photo.fov_deg, 15, 100, "%.0f");
  for (int i = 0; i < static_cast<int>(kFilters.size()); ++i) {
    if (i > 0) ImGui::SameLine();
    ImGui::RadioButton(kFilters[static_cast<std::size_t>(i)].name, &photo.filter, i);
  }
  ImGui::TextUnformatted("Hold the right mouse button to look around.");
  if (button("Save image (F12)")) return Choice::kPicture;
  if (button("Back")) open(Page::kNone);
  return Choice::kNothing;
}

void Menu::draw_credits() {
  ImGui::TextWrapped(
      "Cairns is the game of psygen. The land, its trees, the creatures, all sounds and the music "
      "are generated while you play; nothing was recorded or drawn. Font: DejaVu Sans.");
  if (button("Back")) open(before_);
}

}  // namespace cairns
