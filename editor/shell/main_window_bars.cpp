// Toolbars of the window: quality, hour and weather; the bar of a model that is shown alone. Also
// the grid on the ground.
#include <QAction>
#include <QActionGroup>
#include <QComboBox>
#include <QLabel>
#include <QMenu>
#include <QSlider>
#include <QSpinBox>
#include <QToolBar>
#include <cmath>

#include "editor/document/scale.hpp"
#include "editor/gallery/model_view.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/shell/main_window.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

constexpr int kSliderSteps = 1000, kHourPx = 200, kWeatherPx = 110;

QSlider* add_slider(QToolBar& bar, const QString& label, const QString& help, int steps,
                    int max_px) {
  bar.addWidget(new QLabel(" " + label + " "));
  auto* slider = new QSlider(Qt::Horizontal);
  slider->setAccessibleName(help);
  slider->setToolTip(help);
  slider->setFocusPolicy(Qt::StrongFocus);
  slider->setRange(0, steps);
  slider->setMaximumWidth(max_px);
  bar.addWidget(slider);
  return slider;
}

}  // namespace

void MainWindow::add_toolbar() {
  QToolBar* bar = addToolBar(tr("Picture"));
  bar->setObjectName("picture");
  bar->addWidget(new QLabel(tr(" Quality ")));
  auto* presets = new QComboBox;
  presets->setAccessibleName(tr("Quality of the picture"));
  presets->addItems({"low", "medium", "high", "ultra"});
  bar->addWidget(presets);
  connect(presets, &QComboBox::textActivated, this, [this](const QString& name) {
    const auto preset = render::preset_from(name.toStdString());
    if (view_->session() != nullptr && preset) tell(view_->session()->set_preset(*preset));
  });
  connect(view_, &WorldView::opened, this, [this, presets](const QString& error) {
    if (error.isEmpty())
      presets->setCurrentText(
          QString::fromUtf8(render::to_string(view_->session()->renderer().preset()).data()));
  });
  bar->addSeparator();
  add_hour(*bar);
  add_weather(*bar, tr("Clouds"), tr("Clouds: from clear to overcast"), {"sky", "cloud_cover"});
  add_weather(*bar, tr("Clear air"), tr("Clear air: how far one sees, from fog to none"),
              {"sky", "visibility_m"});
  add_model_bar();
}

// The hour is the view's: the file has only the one that a day begins with.
void MainWindow::add_hour(QToolBar& bar) {
  QSlider* hour = add_slider(bar, tr("Hour"), tr("Hour of the day"), 24 * 60, kHourPx);
  connect(hour, &QSlider::valueChanged, this, [this](int minutes) {
    const world::Sky& sky = document_.world().sky;
    if (view_->session() == nullptr) return;
    double hours = minutes / 60.0 - sky.start_hour;
    if (hours < 0) hours += 24;
    view_->session()->set_now(hours / 24 * sky.day_length_s);
  });
  const auto fit = [this, hour] {
    const bool has_day = document_.world().sky.day_length_s > 0;
    hour->setEnabled(has_day);
    if (has_day && view_->session() != nullptr && !hour->isSliderDown()) {
      const QSignalBlocker quiet(hour);
      const world::Sky& sky = document_.world().sky;
      const double hours = sky.start_hour + 24 * view_->session()->now_s() / sky.day_length_s;
      hour->setValue(static_cast<int>(60 * std::fmod(hours, 24)));
    }
    hour->setToolTip(has_day ? tr("Hour of the day")
                             : tr("The sun of this world stands still: Sky, day length, is 0"));
  };
  connect(&document_, &Document::changed, this, fit);
  connect(view_, &WorldView::opened, this, fit);
  fit();
}

// A field of the sky: another way to the same slider of the properties.
void MainWindow::add_weather(QToolBar& bar, const QString& label, const QString& help,
                             const world::TextPath& path) {
  QSlider* slider = add_slider(bar, label, help, kSliderSteps, kWeatherPx);
  connect(slider, &QSlider::sliderPressed, this, [this] { set_dragging(true); });
  connect(slider, &QSlider::sliderReleased, this, [this] { set_dragging(false); });
  connect(slider, &QSlider::valueChanged, this, [this, path](int position) {
    const world::WorldField* field = document_.field(path);
    if (field == nullptr) return;
    const double value = scale_of(*field).at(static_cast<double>(position) / kSliderSteps);
    tell(document_.set_value(path, world::toml_number(value)));
  });
  const auto fit = [this, slider, path] {
    const world::WorldField* field = document_.field(path);
    slider->setEnabled(field != nullptr && !field->numbers.empty());
    if (!slider->isEnabled() || slider->isSliderDown()) return;
    const QSignalBlocker quiet(slider);
    slider->setValue(
        static_cast<int>(std::lround(scale_of(*field).share_of(field->numbers[0]) * kSliderSteps)));
  };
  connect(&document_, &Document::changed, this, fit);
  fit();
}

// Shown while a model is alone in the view.
void MainWindow::add_model_bar() {
  QToolBar* bar = addToolBar(tr("Model"));
  bar->setObjectName("model");
  auto* title = new QLabel;
  bar->addWidget(title);
  bar->addWidget(new QLabel(tr("  Seed ")));
  auto* seed = new QSpinBox;
  seed->setAccessibleName(tr("Seed of the model that is shown alone"));
  seed->setRange(0, 1'000'000);
  seed->setValue(static_cast<int>(model_->seed()));
  bar->addWidget(seed);
  connect(seed, &QSpinBox::valueChanged, this,
          [this](int value) { model_->set_seed(static_cast<std::uint64_t>(value)); });
  bar->addWidget(new QLabel(tr("  Left button turns it, the wheel comes nearer.  ")));
  bar->addAction(tr("Back to the world"), model_, &ModelView::close);
  bar->hide();
  bar->toggleViewAction()->setVisible(false);
  connect(model_, &ModelView::switched, this, [this, bar, title] {
    bar->setVisible(model_->is_on());
    title->setText(" <b>" + model_->title().toHtmlEscaped() + "</b>");
  });
}

void MainWindow::add_model_action(QMenu& menu) {
  QAction* alone = menu.addAction(tr("Model a&lone"), tr("Ctrl+M"), this, [this](bool on) {
    on ? model_->open(properties_->section()) : model_->close();
  });
  alone->setCheckable(true);
  const auto fit = [this, alone] { alone->setChecked(model_->is_on()); };
  connect(model_, &ModelView::switched, this, fit);
  connect(alone, &QAction::triggered, this, fit);  // also where there is no model to show
}

void MainWindow::add_grid_menu(QMenu& menu) {
  QMenu* grids = menu.addMenu(tr("&Grid on the ground"));
  auto* group = new QActionGroup(this);
  const std::pair<QString, double> kinds[] = {{tr("&None"), 0},
                                              {tr("&1 m"), 1},
                                              {tr("1&0 m"), 10},
                                              {tr("10&0 m"), 100},
                                              {tr("&Borders of blocks"), GroundGrid::kBlocks}};
  for (const auto& [name, spacing_m] : kinds) {
    QAction* action = grids->addAction(
        name, this, [this, spacing_m = spacing_m] { view_->grid().set_spacing(spacing_m); });
    action->setCheckable(true);
    action->setChecked(spacing_m == 0);
    group->addAction(action);
  }
  menu.addAction(tr("Next grid"), tr("Ctrl+G"), this, [group] {
    const auto actions = group->actions();
    const auto now = actions.indexOf(group->checkedAction());
    actions[(now + 1) % actions.size()]->trigger();
  });
}

}  // namespace psygen::editor
