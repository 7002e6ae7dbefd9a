// Dear ImGui in a session, with simulated user input.
#include "engine/app/gui.hpp"

#include <imgui/imgui.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <thread>

#include "engine/image/image.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/text/overlay_layout.hpp"
#include "tests/engine/app/fixture.hpp"
#include "tests/engine/platform/virtual_display.hpp"

namespace psygen::app {
namespace {

using platform::InputState;
using platform::Key;
using platform::MouseButton;

constexpr core::Extent kGuiSize{640, 360};

class GuiOfAPerson : public testing::Test {
 protected:
  // Draws a window at 100, 50 of 200 × 150 pixels, with a button and a text field.
  const ImDrawData* frame() {
    gui_.begin(input_, kGuiSize, 1, 1.0 / 60);
    ImGui::SetNextWindowPos({100, 50});
    ImGui::SetNextWindowSize({200, 150});
    ImGui::Begin("window");
    if (ImGui::Button("press me")) ++presses_;
    button_ = middle_of_last();
    ImGui::InputText("##name", name_.data(), name_.size());
    field_ = middle_of_last();
    ImGui::End();
    const ImDrawData* drawn = gui_.end();
    platform::clear_changes(input_);
    return drawn;
  }
  static glm::dvec2 middle_of_last() {
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    return {(from.x + to.x) / 2, (from.y + to.y) / 2};
  }
  void hold(MouseButton button, bool down) {
    const auto bit = static_cast<std::size_t>(button);
    input_.buttons_held.set(bit, down);
    (down ? input_.buttons_went_down : input_.buttons_went_up).set(bit);
    frame();
  }
  void click(const glm::dvec2& at) {
    input_.pointer_px = at;
    frame();
    frame();  // ImGui detects the widget below the pointer from the last frame
    hold(MouseButton::kLeft, true);
    hold(MouseButton::kLeft, false);
    frame();
  }

  render::OverlayLayout overlay_;
  Gui gui_{overlay_.font_atlas(), nullptr};
  InputState input_;
  glm::dvec2 button_{0.0}, field_{0.0};
  int presses_ = 0;
  std::array<char, 32> name_{};
};

TEST_F(GuiOfAPerson, TakesTheMouseOverAWindowAndNowhereElse) {
  frame();
  input_.pointer_px = {600, 300};
  frame();
  frame();
  EXPECT_FALSE(gui_.takes_mouse());
  input_.pointer_px = {150, 100};
  frame();
  frame();
  EXPECT_TRUE(gui_.takes_mouse());
  input_.looking = input_.captured = true;
  frame();
  frame();
  EXPECT_FALSE(gui_.takes_mouse()) << "a captured cursor is over nothing";
}

TEST_F(GuiOfAPerson, ClicksAButtonWithTheMouse) {
  frame();
  click(button_);
  EXPECT_EQ(presses_, 1);
  click({600, 300});
  EXPECT_EQ(presses_, 1);
}

TEST_F(GuiOfAPerson, TakesTheKeyboardOnlyForATextField) {
  frame();
  EXPECT_FALSE(gui_.takes_keyboard());
  click(field_);
  EXPECT_TRUE(gui_.takes_keyboard());
  for (const char c : {'h', '\xC3', '\xB6'})
    input_.text.push_back(c);
  frame();
  frame();
  EXPECT_STREQ(name_.data(), "h\xC3\xB6");
  input_.went_down.set(static_cast<std::size_t>(Key::kBackspace));  // a tap within a frame
  frame();
  frame();
  EXPECT_STREQ(name_.data(), "h");
}

TEST_F(GuiOfAPerson, IsUsedWithAGamepad) {
  frame();
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableGamepad;
  platform::Gamepad& pad = input_.pads[3];
  const auto tap = [&](platform::PadButton button) {
    for (const bool down : {true, false}) {
      pad.held.set(static_cast<std::size_t>(button), down);
      frame();
      frame();
    }
  };
  tap(platform::PadButton::kA);
  EXPECT_EQ(presses_, 0) << "no gamepad is connected";
  pad.connected = true;
  tap(platform::PadButton::kUp);  // shows the focus
  tap(platform::PadButton::kUp);  // moves it to the button
  tap(platform::PadButton::kA);
  EXPECT_EQ(presses_, 1);
  tap(platform::PadButton::kDown);
  tap(platform::PadButton::kA);
  EXPECT_EQ(presses_, 1) << "the text field has the focus";
}

TEST_F(GuiOfAPerson, IsDrawnAsTrianglesInsideThePicture) {
  frame();
  const ImDrawData* drawn = frame();
  std::vector<shaders::OverlayVertex> out(6);
  std::vector<render::GuiRun> runs;
  overlay_.lay_out(*drawn, kGuiSize, out, runs);
  ASSERT_FALSE(runs.empty());
  std::size_t next = 6, letters = 0;
  for (const render::GuiRun& run : runs) {
    EXPECT_EQ(run.first_vertex, next) << "after the existing vertices";
    next += run.vertex_count;
    EXPECT_LE(run.x + run.width, kGuiSize.width);
    EXPECT_LE(run.y + run.height, kGuiSize.height);
  }
  EXPECT_EQ(next, out.size());
  for (std::size_t i = 6; i < out.size(); ++i)
    letters += out[i].look.x > 0 ? 1 : 0;
  EXPECT_GE(letters, std::strlen("window") * 6);
  EXPECT_LT(letters, out.size() - 6);
}

TEST_F(GuiOfAPerson, ToleratesInvalidTimesAndSizes) {
  for (const double dt_s : {0.0, -1.0, 1e300, std::nan("")}) {
    gui_.begin(input_, {0, 0}, NAN, dt_s);
    gui_.end();
  }
  const ImGuiIO& io = ImGui::GetIO();
  EXPECT_GT(io.DeltaTime, 0.0F);
  EXPECT_TRUE(std::isfinite(io.DeltaTime));
  EXPECT_TRUE(std::isfinite(io.FontGlobalScale));
  input_.pointer_px = {std::nan(""), 1e300};
  frame();
  click(button_);
  EXPECT_EQ(presses_, 1);
}

using Code = std::function<void()>;

TEST_F(GuiOfAPerson, ClosesWhatDrawingCodeLeavesOpenAndNamesIt) {
  const std::pair<Code, const char*> cases[] = {
      {[] { ImGui::Begin("a"); }, "missing End() for 'a'"},
      {[] { ImGui::Begin("a"), ImGui::Begin("b"), ImGui::End(); }, "missing End() for 'a'"},
      {[] { ImGui::Begin("a"), ImGui::BeginChild("b"); }, "missing EndChild() for 'a/b"},
      {[] { ImGui::Begin("a"), ImGui::PushID(1); }, "missing PopID() in 'a'"},
      {[] { ImGui::PushID(1); }, "missing PopID() in 'Debug##Default'"},
      {[] { ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.5F); }, "missing PopStyleVar() in"},
      {[] { ImGui::PushStyleColor(ImGuiCol_Text, 0U); }, "missing PopStyleColor() in"},
      {[] { ImGui::Begin("a"), ImGui::PushFont(ImGui::GetFont()); }, "missing PopFont() in 'a'"},
      {[] { ImGui::BeginDisabled(); }, "missing EndDisabled() in"},
      {[] { ImGui::Begin("a"), ImGui::BeginGroup(); }, "missing EndGroup() in 'a'"},
      {[] { ImGui::Begin("a"), ImGui::BeginTable("t", 2); }, "missing EndTable() in 'a'"},
      {[] { ImGui::Begin("a"), ImGui::BeginTabBar("t"); }, "missing EndTabBar() in 'a'"},
      {[] { ImGui::Begin("a"), ImGui::TreePush("t"); }, "missing TreePop() in 'a'"},
      {[] { ImGui::BeginTooltip(); }, "missing End() for '##Tooltip"},
      {[] { ImGui::BeginMainMenuBar(); }, "missing EndGroup() in '##MainMenuBar'"},
      {[] { ImGui::OpenPopup("p"), ImGui::BeginPopup("p"); }, "missing End() for '##Popup"}};
  for (const auto& [code, missing] : cases) {
    for (const bool throws : {false, true}) {
      gui_.begin(input_, kGuiSize, 1, 1.0 / 60);
      if (throws) {
        EXPECT_THROW((void)gui_.draw([&] { code(), throw 7; }), int) << missing;
      } else {
        const auto drawn = gui_.draw(code);
        ASSERT_FALSE(drawn) << missing;
        EXPECT_THAT(drawn.error().message, testing::StartsWith(missing));
      }
      ASSERT_GT(frame()->TotalVtxCount, 0) << "the next frame after " << missing;
    }
  }
  click(button_);
  EXPECT_EQ(presses_, 1);
}

TEST_F(GuiOfAPerson, ReportsCodeThatItsAssertionsAbort) {
  const Code cases[] = {[] { ImGui::Begin("a"), ImGui::PushID(1), ImGui::End(); },
                        [] { ImGui::Begin("a"), ImGui::BeginChild("b"), ImGui::End(); },
                        [] { ImGui::End(); },
                        [] { ImGui::PopID(); },
                        [] { ImGui::PopStyleVar(); },
                        [] { ImGui::NewFrame(); }};
  for (const Code& code : cases) {
    Gui gui(overlay_.font_atlas(), nullptr);
    gui.begin(input_, kGuiSize, 1, 1.0 / 60);
    const auto drawn = gui.draw(code);
    ASSERT_FALSE(drawn);
    EXPECT_EQ(drawn.error().message, "it aborted; stderr has the assertion");
  }
  ASSERT_GT(frame()->TotalVtxCount, 0) << "another context";
  EXPECT_DEATH(std::abort(), "") << "aborts elsewhere end the program";
}

TEST_F(GuiOfAPerson, LeavesAbortsOfOtherThreadsToTheHandlerOfTheProgram) {
  const auto abort_beside = [this] {
    std::signal(SIGABRT, [](int) { std::_Exit(7); });
    Gui gui(overlay_.font_atlas(), nullptr);
    gui.begin(input_, kGuiSize, 1, 1.0 / 60);
    (void)gui.draw([] { std::thread([] { std::abort(); }).join(); });
  };
  EXPECT_EXIT(abort_beside(), testing::ExitedWithCode(7), "");
}

TEST(GuiInASession, ACallWithoutItsPartnerEndsTheSessionWithAnErrorThatNamesThePlugin) {
  const std::pair<Code, const char*> cases[] = {
      {[] { ImGui::Begin("Menu"); }, "missing End() for 'Menu'"},
      {[] { ImGui::Begin("Menu"), ImGui::PushID(1); }, "missing PopID() in 'Menu'"},
      {[] { ImGui::Begin("Menu"), ImGui::BeginChild("list"); }, "missing EndChild() for 'Menu/"},
      {[] { ImGui::Begin("Menu"), ImGui::PushID(1), ImGui::End(); }, "it aborted"}};
  for (const auto& [code, missing] : cases) {
    SessionOptions options = short_session();
    options.plugins = {{.name = "sheep", .on_gui = [](Session&) { ImGui::Text("baa"); }},
                       {.name = "wolves", .on_gui = [code = code](Session&) { code(); }}};
    auto session = Session::create(options);
    ASSERT_TRUE(session) << session.error().message;
    const auto ticked = (*session)->tick((*session)->home(), 1.0 / 60);
    ASSERT_FALSE(ticked);
    EXPECT_EQ(ticked.error().code, core::ErrorCode::kInternal);
    EXPECT_THAT(ticked.error().message,
                testing::StartsWith(std::string("plugin wolves: on_gui: ") + missing));
    EXPECT_TRUE((*session)->over());
    EXPECT_FALSE((*session)->tick((*session)->home(), 1.0 / 60));
  }
}

TEST(GuiInAWindow, KeepsClicksOnAMenuFromTheGameAndPassesOthers) {
  const auto display = platform::VirtualDisplay::start();
  ASSERT_NE(display, nullptr) << "these tests need xvfb, openbox and xdotool";
  int presses = 0;
  SessionOptions options = short_session();
  options.headless = options.vsync = false;
  options.scene.view_distance_m = 64;
  options.plugins.push_back({.name = "menu", .on_gui = [&](Session&) {
                               ImGui::SetNextWindowPos({20, 20});
                               ImGui::SetNextWindowSize({160, 120});
                               ImGui::Begin("Menu");
                               presses += ImGui::Button("Go on", {120, 60}) ? 1 : 0;
                               ImGui::End();
                             }});
  auto created = Session::create(options);
  ASSERT_TRUE(created) << created.error().message;
  Session& session = **created;
  int clicks_of_the_game = 0;
  const auto frames_until = [&](const std::function<bool()>& done) {
    for (int i = 0; i < 20'000 && !done(); ++i) {
      ASSERT_TRUE(session.poll());
      clicks_of_the_game += session.input().was_pressed(MouseButton::kLeft) ? 1 : 0;
      ASSERT_TRUE(session.tick(session.home(), 1.0 / 60));
    }
    EXPECT_TRUE(done());
  };
  const auto move_to = [&](const char* x, const char* y) {
    EXPECT_TRUE(
        display->xdotool({"search", "--sync", "--onlyvisible", "--name", "psygen: paper",
                          "windowactivate", "--sync", "mousemove", "--window", "%1", x, y}));
  };
  move_to("90", "90");
  frames_until([&] { return session.gui().takes_mouse(); });
  ASSERT_TRUE(display->xdotool({"mousedown", "1"}));
  frames_until([&] { return ImGui::GetIO().MouseDown[0]; });
  ASSERT_TRUE(display->xdotool({"mouseup", "1"}));
  frames_until([&] { return presses == 1; });
  EXPECT_EQ(clicks_of_the_game, 0);
  move_to("280", "150");
  frames_until([&] { return !session.gui().takes_mouse(); });
  ASSERT_TRUE(display->xdotool({"click", "1"}));
  frames_until([&] { return clicks_of_the_game == 1; });
  EXPECT_EQ(presses, 1);
}

TEST(GuiInASession, IsInImagesWithoutAWindowAndOnlyInItsOwnSession) {
  const auto picture = [](bool with_gui) {
    SessionOptions options = short_session();
    options.preset = render::Preset::kLow;
    if (with_gui) {
      Plugin plugin;
      plugin.name = "menu";
      plugin.on_gui = [](Session& session) {
        EXPECT_EQ(ImGui::GetCurrentContext(), session.gui().context());
        ImGui::SetNextWindowPos({40, 20});
        ImGui::SetNextWindowSize({160, 100});
        ImGui::Begin("Menu");
        ImGui::Text(
            "Stra\xC3\x9F"
            "e");
        ImGui::End();
      };
      options.plugins.push_back(std::move(plugin));
    }
    auto session = Session::create(options);
    EXPECT_TRUE(session) << session.error().message;
    EXPECT_TRUE((*session)->prepare((*session)->home()));
    for (int i = 0; i < 3; ++i)
      EXPECT_TRUE((*session)->tick((*session)->home(), 0));
    EXPECT_THAT((*session)->renderer().validation_messages(), ::testing::IsEmpty());
    auto taken = (*session)->picture();
    EXPECT_TRUE(taken);
    return *taken;
  };
  const image::Image without = picture(false), with = picture(true);
  int inside = 0, outside = 0;
  for (std::uint32_t y = 0; y < with.height; ++y) {
    for (std::uint32_t x = 0; x < with.width; ++x) {
      const std::size_t at = 4 * (std::size_t{y} * with.width + x);
      const bool differs = std::abs(with.rgba[at] - without.rgba[at]) > 8;
      const bool in = x >= 40 && x < 200 && y >= 20 && y < 120;
      (in ? inside : outside) += differs ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 160 * 100 / 2);
  EXPECT_EQ(outside, 0);
}

}  // namespace
}  // namespace psygen::app
