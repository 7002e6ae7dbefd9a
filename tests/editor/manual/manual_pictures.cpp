// Takes the images of the manual (docs/editor.md): uses the panels of a window and saves each as
// NAME-THEME-WIDTH.jpg. Run by tools/editor_pictures.sh; takes minutes.
//   psygen_manual_pictures FOLDER dark|light WIDTHxHEIGHT [window|tools|rivers|others]
// `window`: only the window; `tools`: the tools of the view; `rivers`: the river network of
// watershed; `others`: export, comparison, attached flight. It edits the document without saving.
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QElapsedTimer>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QProcess>
#include <QScrollArea>
#include <QSpinBox>
#include <QTimer>
#include <QUndoStack>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <string>

#include "editor/attach/remote_session.hpp"
#include "editor/flights/flight_process.hpp"
#include "editor/flights/timeline_panel.hpp"
#include "editor/gallery/compare_window.hpp"
#include "editor/gallery/contact_sheet.hpp"
#include "editor/gallery/library_panel.hpp"
#include "editor/panels/cache_map.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/pictures/picture_server.hpp"
#include "editor/shell/command_palette.hpp"
#include "editor/shell/main_window.hpp"
#include "editor/shell/theme.hpp"
#include "editor/tools/view_tools.hpp"
#include "engine/core/camera.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/world.hpp"
#include "tests/editor/manual/photographer.hpp"
#include "tests/editor/own_display.hpp"
#include "tests/source_file.hpp"

namespace psygen::editor {
namespace {

struct Arguments {
  std::filesystem::path folder;
  QString theme;
  std::string size;  // of the display
  std::string only;  // "window", "tools", "rivers", "others"; empty: all pictures but rivers
  std::filesystem::path home = {};  // for temporary files
};

constexpr int kFlownMs = 2500;
constexpr double kFlownMps = 25, kFlownTurn = 0.12;  // a second

// The section with this title below a table.
world::TextPath section_called(const Document& document, const std::string& table,
                               const std::string& title) {
  for (const world::WorldSection& section : document.sections()) {
    if (section.title == title && !section.path.empty() && section.path.steps[0].key == table)
      return section.path;
  }
  return {};
}

// A scatter with its costs, and the impact of a change.
void take_window(Photographer& take) {
  const world::TextPath oaks = section_called(take.document(), "scatter", "oak");
  take.properties().go_to(oaks);
  rest(6000);  // curves of costs
  const world::TextPath size = oaks.with("size_m");
  take.settle([&] { take.set(size, "[2.4, 3.9]"); });
  const auto* impact = take.properties().findChild<QWidget*>("impact");
  if (!wait_until([&] { return impact->findChild<QLabel*>()->text().contains("Rebuilds"); },
                  kLongestMs))
    take.fail("the impact of a change does not come");
  rest(6000);
  take.window("window");
}

void take_fields(Photographer& take) {
  take.panel("properties", "properties");
  const world::TextPath oaks = section_called(take.document(), "scatter", "oak");
  take.set(oaks.with("count"), "400");
  if (take.document().confirmation().isEmpty()) take.fail("a costly value does not ask");
  take.widget("question", *take.properties().findChild<QWidget*>("impact"));
  take.document().discard_proposed_edit();
  take.properties().show(take.document().sections());
}

void take_panels(Photographer& take, MainWindow& window) {
  const scene::Scene& scene = window.view().session()->scene();
  const glm::vec3 ahead = core::forward_of(window.view().camera().pose());
  window.view().select(pick(scene, window.view().camera().pose(), glm::dvec3(ahead)));
  take.panel("selection", "selection");
  take.panel("history", "history");
  take.panel("map", "map");
  auto* colours = window.findChild<QDockWidget*>("map")->findChild<QComboBox*>();
  colours->setCurrentText("Age");
  Q_EMIT colours->activated(colours->currentIndex());
  take.panel("map", "map-age");
  window.findChild<MessageLog*>()->check(take.document().set_value({"sky", "cloud_cover"}, "7"));
  take.panel("messages", "messages");
  take.panel("statistics", "statistics");
  colours->setCurrentIndex(0);
  Q_EMIT colours->activated(0);
  window.view().select(std::nullopt);
  auto* library = window.findChild<QDockWidget*>("library");
  library->show();
  library->raise();
  auto* shown = library->findChild<LibraryPanel*>();
  if (!wait_until([&] { return shown->awaited() == 0; }, kLongestMs))
    take.fail("the library does not fill");
  take.panel("library", "library");
  window.findChild<QDockWidget*>("properties")->raise();
}

void take_model(Photographer& take) {
  take.properties().go_to(section_called(take.document(), "species", "oak"));
  take.settle([&] { take.command("Model alone"); });
  take.command("1 m");
  rest(3000);
  take.window("model");
  take.command("None");
  take.settle([&] { take.command("Model alone"); });
}

// Points of the ground around the point that the camera looks at from above.
class Ground {
 public:
  explicit Ground(MainWindow& window) : before_(window.view().camera().pose()), window_(window) {
    const glm::dvec2 eye_m = window.document().world().metres(before_.position);
    const glm::vec3 ahead = core::forward_of(before_);
    middle_m_ = eye_m + glm::normalize(glm::dvec2(ahead.x, ahead.z)) * kAheadM;
    core::CameraPose pose = before_;
    pose.position.local.y += kUpM;
    pose.pitch = -std::atan2(kUpM, kAheadM);
    window.view().camera().set_pose(pose);
  }
  ~Ground() { window_.view().camera().set_pose(before_); }
  // A point right of and beyond the middle, from the camera's view.
  ToolPoint at(double right_m, double beyond_m) const {
    const double c = std::cos(before_.yaw), s = std::sin(before_.yaw);
    ToolPoint point;
    point.ground_m = middle_m_ + right_m * glm::dvec2(c, s) + beyond_m * glm::dvec2(s, -c);
    return point;
  }

 private:
  static constexpr double kAheadM = 90, kUpM = 45;
  core::CameraPose before_;
  MainWindow& window_;
  glm::dvec2 middle_m_{0.0};
};

void click(ViewTool& tool, const ToolPoint& at) {
  tool.press(at);
  tool.release();
}

// Takes an image of one tool and undoes its edits.
void take_tool(Photographer& take, const QString& command, const QString& name,
               const std::function<void()>& use) {
  const std::string before = take.document().text();
  take.command(command);
  take.settle(use);
  rest(3000);
  take.window(name);
  take.command("Exit tool");
  take.settle([&] { (void)take.document().set_text(before, "Undo"); });
}

void take_tools(Photographer& take, MainWindow& window) {
  auto* tools = window.findChild<ViewTools*>();
  const Ground ground(window);
  take_tool(take, "Draw roads", "road", [&] {
    click(tools->road(), ground.at(-45, -12));
    for (const auto& [right_m, beyond_m] :
         {std::pair{-22, -14}, std::pair{-4, 2}, std::pair{6, 24}, std::pair{30, 40}})
      click(tools->road(), ground.at(right_m, beyond_m));
  });
  take_tool(take, "Place models", "place", [&] {
    tools->place().set_type("oak");
    for (int i = 0; i < 5; ++i)
      click(tools->place(), ground.at(24 * i - 60, 6 * (i % 2) + 8 * i - 20));
    tools->place().hover(ground.at(4, -22));
  });
  MaskTool& mask = tools->mask();
  take.command("Paint masks");
  mask.set_new_mask(NewMask{false, 128, 1});
  mask.choose(section_called(take.document(), "scatter", "spruce").steps[1].index);
  rest(3000);
  take.window("new-mask");
  take.command("Exit tool");
  take_tool(take, "Paint masks", "mask", [&] {
    mask.set_new_mask(std::nullopt);
    mask.choose(section_called(take.document(), "scatter", "spruce").steps[1].index);
    mask.make_mask();
    take.command("Erase");
    mask.press(ground.at(-70, 10));
    for (const auto& [right_m, beyond_m] :
         {std::pair{-40, 0}, std::pair{-10, 5}, std::pair{10, 20}, std::pair{20, 40}})
      mask.drag(ground.at(right_m, beyond_m));
    mask.release();
    mask.hover(ground.at(14, 4));
  });
}

// Records and renders a few seconds straight ahead.
void take_timeline(Photographer& take, MainWindow& window) {
  auto* timeline = window.findChild<TimelinePanel*>();
  timeline->set_recording(true);
  const core::CameraPose start = window.view().camera().pose();
  QElapsedTimer flown;
  flown.start();
  while (flown.elapsed() < kFlownMs) {
    core::CameraPose pose = start;
    const double seconds = static_cast<double>(flown.elapsed()) * 1e-3;
    pose.position.local += glm::dvec3(core::forward_of(start)) * kFlownMps * seconds;
    pose.yaw += kFlownTurn * seconds;
    window.view().camera().set_pose(pose);
    rest(20);
  }
  timeline->set_recording(false);
  const auto tells = [&](const QString& words) {
    for (QLabel* label : timeline->findChildren<QLabel*>()) {
      if (label->text().contains(words)) return true;
    }
    return false;
  };
  if (!wait_until([&] { return tells("median frame time"); }, kLongestMs))
    take.fail("the flight does not end");
  take.panel("timeline", "timeline");
  window.view().camera().set_pose(start);
}

void take_sheet(Photographer& take, MainWindow& window) {
  const world::TextPath oak = section_called(take.document(), "species", "oak");
  take.properties().go_to(oak);
  Q_EMIT take.properties().field_focused(oak.with("spread"));
  rest(3000);  // the sheet ignores shorter focus
  take.command("Contact sheet …");
  auto* sheet = window.findChild<ContactSheet*>();
  if (sheet == nullptr) return take.fail("there is no contact sheet");
  for (auto* spin : sheet->findChildren<QSpinBox*>())
    spin->setValue(3);
  const auto is_filled = [&] {
    for (QLabel* label : sheet->findChildren<QLabel*>()) {
      if (label->text().startsWith("Click a picture")) return true;
    }
    return false;
  };
  if (!wait_until(is_filled, kLongestMs)) take.fail("the contact sheet does not fill");
  sheet->resize(880, 640);
  take.widget("contact-sheet", *sheet);
  sheet->close();
  take.command("Find a command or field …");
  auto* palette = window.findChild<CommandPalette*>();
  palette->findChild<QLineEdit*>()->setText("size");
  take.widget("commands", *palette);
  palette->reject();
}

// The export of the selected oak. The dialog blocks, so a timer takes the image, with file names
// relative to the folder of the sources.
void take_export(Photographer& take, MainWindow& window) {
  const scene::Scene& scene = window.view().session()->scene();
  const core::CameraPose pose = window.view().camera().pose();
  for (double aside = -0.3; aside < 0.3; aside += 0.02) {
    core::CameraPose turned = pose;
    turned.yaw += aside;
    window.view().select(pick(scene, pose, glm::dvec3(core::forward_of(turned))));
    const auto& selection = window.view().selection();
    if (selection && selection->kind == query::HitKind::kModel) break;
  }
  QTimer::singleShot(kRestMs, &window, [&take] {
    QWidget* dialog = QApplication::activeModalWidget();
    if (dialog == nullptr) return take.fail("there is no dialog for exports");
    const auto lines = dialog->findChildren<QLineEdit*>();
    for (QLineEdit* line : lines) {
      const bool of_number = qobject_cast<QSpinBox*>(line->parentWidget()) != nullptr;
      if (!line->isReadOnly() && !of_number) line->setText("oak.glb");
    }
    for (QLineEdit* line : lines) {
      if (!line->isReadOnly()) continue;
      line->setText(line->text().replace(QString::fromStdString(source_file("")), ""));
      line->setCursorPosition(0);
    }
    take.widget("export", *dialog);
    dialog->close();
  });
  take.command("Export a model or block …");
  window.view().select(std::nullopt);
}

// The landscape left of the line, and in the evening right of it.
void take_compare(Photographer& take, MainWindow& window) {
  take.command("Mark this state as A");
  take.settle([&] { take.set({"sky", "sun_elevation_deg"}, "12"); });
  take.command("A and B side by side");
  auto* compare = window.findChild<CompareWindow*>();
  if (compare == nullptr) return take.fail("there is no comparison");
  const auto is_drawn = [&] {
    const QImage seen = compare->grab().toImage();
    const QColor empty = compare->palette().color(QPalette::Base);
    return seen.pixelColor(seen.width() / 4, seen.height() / 2) != empty &&
           seen.pixelColor(seen.width() * 3 / 4, seen.height() / 2) != empty;
  };
  if (!wait_until(is_drawn, kLongestMs)) take.fail("the comparison is not drawn");
  take.widget("compare", *compare);
  compare->close();
  take.settle([&] { take.document().undo_stack().undo(); });
}

// A flight in another process. The document becomes its world, so this is the last image.
void take_attached(Photographer& take, MainWindow& window, const std::filesystem::path& home) {
  const std::filesystem::path sockets = home / "sockets";
  std::filesystem::create_directory(sockets);
  std::filesystem::permissions(sockets, std::filesystem::perms::owner_all);
  ::setenv("XDG_RUNTIME_DIR", sockets.c_str(), 1);
  if (auto done = take.document().revert(); !done)
    return take.fail(QString::fromStdString(done.error().message));
  QProcess flight;
  flight.start(psygen_program(), {"fly", "--headless", "--world", "paper", "--path", "walk27",
                                  "--loop", "--seconds", "600", "--target-fps", "30", "--inspect"});
  auto* remote = window.findChild<RemoteSession*>();
  bool answers = false;
  QObject::connect(remote, &RemoteSession::entities, &window,
                   [&answers](const QJsonObject&) { answers = true; });
  // A new flight may not answer yet.
  const auto is_attached = [&] {
    const auto found = inspect::endpoints(sockets);
    if (!remote->is_attached() && found && !found->empty()) (void)remote->attach(found->front());
    return answers;
  };
  if (!wait_until(is_attached, kLongestMs)) take.fail("no flight can be attached to");
  rest(6000);
  auto* area = window.findChild<QDockWidget*>("attached")->findChild<QScrollArea*>();
  if (area == nullptr) return take.fail("there is no panel of an attached program");
  take.widget("attached", *area->widget());  // the whole panel, also its invisible part
  remote->detach(false);
  flight.terminate();
  flight.waitForFinished();
}

bool take_others(Photographer& take, MainWindow& window, const Arguments& arguments) {
  take_export(take, window);
  take_compare(take, window);
  take_attached(take, window, arguments.home);
  return take.ok();
}

// The network of a world over the view and over the map.
void take_rivers(Photographer& take, MainWindow& window) {
  core::CameraPose pose;
  pose.position = core::normalised({{}, {-9560, 0, 9950}}, take.document().world().block_size_m());
  pose.position.local.y = world::surface_height_m(take.document().world(), pose.position) + 260;
  pose.yaw = 0.2;
  pose.pitch = -0.3;
  window.view().camera().set_pose(pose);
  rest(3000);
  auto* dock = window.findChild<QDockWidget*>("map");
  dock->raise();
  dock->findChild<CacheMap*>()->set_radius_m(6000);
  take.command("River network");
  if (!wait_until([&] { return window.view().rivers().map() != nullptr; }, kLongestMs))
    take.fail("the map of the rivers does not come");
  const auto is_complete = [&] {
    return window.view().session()->scene().meshes().outstanding() == 0;
  };
  for (int k = 0; k < 4; ++k) {
    if (!wait_until(is_complete, kLongestMs)) take.fail("the view does not settle");
    rest(3000);
  }
  take.window("rivers");
  take.panel("map", "map-rivers");
}

bool take_all(MainWindow& window, const Arguments& arguments) {
  Photographer take(window, arguments.folder, arguments.theme);
  if (!wait_until([&] { return window.view().session() != nullptr; }, kLongestMs)) return false;
  take.settle([] {});
  if (arguments.only == "tools") return take_tools(take, window), take.ok();
  if (arguments.only == "others") return take_others(take, window, arguments);
  if (arguments.only == "rivers") return take_rivers(take, window), take.ok();
  take_window(take);
  if (arguments.only == "window") return take.ok();
  take_fields(take);
  take_panels(take, window);
  take_model(take);
  take_tools(take, window);
  take_sheet(take, window);
  take_timeline(take, window);
  return take_others(take, window, arguments);
}

int run(int argc, char** argv, Arguments arguments) {
  const auto display = OwnDisplay::start(arguments.size);
  if (!display) return 1;
  const QApplication application(argc, argv);
  QApplication::setOrganizationName("psygen");
  QApplication::setApplicationName("psygen-editor");
  apply_theme(arguments.theme);
  MainWindowOptions options;
  options.session.preset = render::Preset::kMedium;
  options.session.target_hz = 0;  // full detail, however long a frame takes
  options.document.state_folder = arguments.home = display->home();
  MainWindow window(std::move(options));
  window.showFullScreen();
  window.use_first_pose();
  // A relative path, so that messages name the same file on every machine.
  const std::string name = arguments.only == "rivers" ? "watershed" : kFirstWorld;
  window.open_file(std::filesystem::proximate(source_file("game/worlds/" + name + ".toml")));
  return take_all(window, arguments) ? 0 : 1;
}

}  // namespace
}  // namespace psygen::editor

int main(int argc, char** argv) {
  using namespace psygen::editor;
  if (argc > 1 && std::strcmp(argv[1], kPicturesOption) == 0) return render_pictures({});
  if (argc < 4 || argc > 5) {
    std::fprintf(stderr,
                 "usage: psygen_manual_pictures FOLDER dark|light WIDTHxHEIGHT "
                 "[window|tools|rivers|others]\n");
    return 2;
  }
  return run(argc, argv, {argv[1], argv[2], argv[3], argc > 4 ? argv[4] : ""});
}
