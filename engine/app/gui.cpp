#include "engine/app/gui.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <utility>

#include "engine/app/gui_input.hpp"
#include "engine/platform/window.hpp"

namespace psygen::app {
namespace {

constexpr double kLongestFrameS = 0.25;

ImGuiStyle style_at(float scale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 6;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.PopupRounding = 4;
  style.WindowPadding = {12, 12};
  style.FramePadding = {8, 5};
  style.ItemSpacing = {8, 7};
  style.WindowBorderSize = 0;
  style.WindowTitleAlign = {0.5F, 0.5F};
  style.Colors[ImGuiCol_WindowBg] = {0.04F, 0.05F, 0.07F, 0.88F};
  style.Colors[ImGuiCol_TitleBgActive] = {0.11F, 0.19F, 0.27F, 1.0F};
  style.ScaleAllSizes(scale);
  return style;
}

// Debian's ImGui checks by assert() that calls come in pairs, so a wrong pair aborts.
thread_local sigjmp_buf* way_out = nullptr;
struct sigaction without_trap = {};  // of aborts, before the outermost trap

// While it lives, an abort of this thread jumps to `target`; those of other threads end the program
// as without a trap.
class AbortTrap {
 public:
  explicit AbortTrap(sigjmp_buf& target) : outer_(std::exchange(way_out, &target)) {
    struct sigaction jump = {};
    jump.sa_handler = [](int) {
      if (way_out != nullptr) siglongjmp(*way_out, 1);
      sigaction(SIGABRT, &without_trap, nullptr);
      raise(SIGABRT);  // takes effect when this function has returned
    };
    sigaction(SIGABRT, &jump, &before_);
    if (outer_ == nullptr) without_trap = before_;
  }
  ~AbortTrap() {
    sigaction(SIGABRT, &before_, nullptr);
    way_out = outer_;
  }
  AbortTrap(const AbortTrap&) = delete;
  AbortTrap& operator=(const AbortTrap&) = delete;

 private:
  sigjmp_buf* outer_;  // of a trap around this one; null: none
  struct sigaction before_ = {};
};

// Returns false if the code aborted.
bool survives(const std::function<void()>& code) {
  sigjmp_buf here;
  const AbortTrap trap(here);
  if (sigsetjmp(here, 1) != 0) return false;
  code();
  return true;
}

#if IMGUI_VERSION_NUM >= 19130
// Keeps the first of ImGui's messages, "Missing End()".
void note_missing(ImGuiContext* context, void* first, const char* message) {
  std::string& missing = *static_cast<std::string*>(first);
  if (!missing.empty()) return;
  const std::string_view call = message;
  const bool of_window = call.ends_with(" End()") || call.ends_with(" EndChild()");
  missing = fmt::format("{} {} '{}'", call, of_window ? "for" : "in", context->CurrentWindow->Name);
  missing[0] = 'm';
}

// Closes all that is open in the frame, except its own fallback window. Sets `missing`, which the
// caller of survives() owns, to the first missing call; empty: none.
void close_all(std::string& missing) {
  ImGuiContext& g = *ImGui::GetCurrentContext();
  if (!g.WithinFrameScope) return;
  g.ErrorCallback = note_missing;
  g.ErrorCallbackUserData = &missing;
  g.IO.ConfigErrorRecoveryEnableAssert = false;
  ImGui::ErrorRecoveryTryToRecoverState(&g.StackSizesInNewFrame);
  g.IO.ConfigErrorRecoveryEnableAssert = true;
  g.ErrorCallback = nullptr;
}
#else
// Keeps the first of ImGui's messages, "Recovered from missing End() for 'Menu'".
__attribute__((format(printf, 2, 3))) void note_missing(void* first, const char* format, ...) {
  std::string& missing = *static_cast<std::string*>(first);
  if (!missing.empty()) return;
  std::array<char, 256> text{};
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(text.data(), text.size(), format, values);
  va_end(values);
  missing = text.data();
  constexpr std::string_view kBefore = "Recovered from ";
  if (missing.starts_with(kBefore)) missing.erase(0, kBefore.size());
}

// Closes all that is open in the frame, except its own fallback window. Sets `missing`, which the
// caller of survives() owns, to the first missing call; empty: none.
void close_all(std::string& missing) {
  ImGuiContext& g = *ImGui::GetCurrentContext();
  while (g.WithinFrameScope && g.CurrentWindowStack.Size > 0) {
    const char* const name = g.CurrentWindow->Name;
    ImGui::ErrorCheckEndWindowRecover(note_missing, &missing);
    while (g.FontStack.Size > g.CurrentWindowStack.back().StackSizesOnBegin.SizeOfFontStack) {
      note_missing(&missing, "missing PopFont() in '%s'", name);
      ImGui::PopFont();
    }
    if (g.CurrentWindowStack.Size == 1) break;
    const bool child = (g.CurrentWindow->Flags & ImGuiWindowFlags_ChildWindow) != 0;
    note_missing(&missing, "missing %s() for '%s'", child ? "EndChild" : "End", name);
    child ? ImGui::EndChild() : ImGui::End();
  }
}
#endif

// Ends a frame that failed.
void abandon_frame() {
  std::string missing;
  survives([&missing] {
    close_all(missing);
    ImGui::EndFrame();
  });
  ImGui::GetIO().Fonts->Locked = false;
}

}  // namespace

core::Result<void> Gui::draw(const std::function<void()>& code) {
  ImGui::SetCurrentContext(context_);
  std::string missing;
  bool whole = false;
  try {
    whole = survives(code);
  } catch (...) {
    ImGui::SetCurrentContext(context_);
    abandon_frame();
    throw;
  }
  ImGui::SetCurrentContext(context_);
  whole = whole && survives([&missing] { close_all(missing); });
  if (whole && missing.empty()) return {};
  abandon_frame();
  return core::fail(core::ErrorCode::kInternal,
                    whole ? missing : "it aborted; stderr has the assertion");
}

const char* Gui::read_clipboard(void* self) {
  Gui& gui = *static_cast<Gui*>(self);
  gui.clipboard_ = gui.window_->clipboard();
  return gui.clipboard_.c_str();
}

void Gui::write_clipboard(void* self, const char* text) {
  static_cast<Gui*>(self)->window_->set_clipboard(text);
}

Gui::Gui(ImFontAtlas& atlas, platform::Window* window) : window_(window) {
  ImGuiContext* const before = ImGui::GetCurrentContext();
  context_ = ImGui::CreateContext(&atlas);
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // ImGui must not write files into the current folder
  io.LogFilename = nullptr;
  io.BackendPlatformName = io.BackendRendererName = "psygen";
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  prepare_input(io);
  if (window != nullptr) {
    io.ClipboardUserData = this;
    io.GetClipboardTextFn = read_clipboard;
    io.SetClipboardTextFn = write_clipboard;
  }
  ImGui::SetCurrentContext(before);
}

Gui::~Gui() {
  ImGui::DestroyContext(context_);
}

void Gui::begin(const platform::InputState& input, core::Extent picture, float scale, double dt_s) {
  ImGui::SetCurrentContext(context_);
  const float whole = std::isfinite(scale) ? std::clamp(scale, 0.5F, 8.0F) : 1.0F;
  if (whole != styled_scale_) ImGui::GetStyle() = style_at(styled_scale_ = whole);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(picture.width), static_cast<float>(picture.height)};
  io.DeltaTime = static_cast<float>(std::isfinite(dt_s) ? std::clamp(dt_s, 1e-4, kLongestFrameS)
                                                        : kLongestFrameS);
  io.FontGlobalScale = kTextPx * whole / io.Fonts->Fonts[0]->FontSize;
  feed_input(input, io);
  ImGui::NewFrame();
}

const ImDrawData* Gui::end() {
  ImGui::SetCurrentContext(context_);
  ImGui::Render();
  return ImGui::GetDrawData();
}

bool Gui::takes_keyboard() const {
  ImGui::SetCurrentContext(context_);
  return ImGui::GetIO().WantCaptureKeyboard || ImGui::GetIO().WantTextInput;
}

bool Gui::takes_mouse() const {
  ImGui::SetCurrentContext(context_);
  return ImGui::GetIO().WantCaptureMouse;
}

}  // namespace psygen::app
