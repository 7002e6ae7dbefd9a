#include "editor/shell/view_bars.hpp"

#include <QComboBox>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>
#include <QSpinBox>
#include <QToolBar>
#include <cmath>

#include "editor/document/qt_text.hpp"
#include "editor/document/scale.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

constexpr int kSliderSteps = 1000, kHourPx = 200, kWeatherPx = 110;

QSlider* add_slider(QToolBar& bar, const QString& label, const QString& help) {
  bar.addWidget(new QLabel(" " + label + " "));
  auto* slider = new QSlider(Qt::Horizontal);
  slider->setAccessibleName(help);
  slider->setToolTip(help);
  slider->setFocusPolicy(Qt::StrongFocus);
  bar.addWidget(slider);
  return slider;
}

}  // namespace

ViewBars::ViewBars(const EditorContext& context, std::function<void(bool)> set_dragging)
    : QObject(&context.window), context_(context), set_dragging_(std::move(set_dragging)) {
  QToolBar* bar = context.window.addToolBar(tr("Image"));
  bar->setObjectName("picture");
  add_quality(*bar);
  bar->addSeparator();
  add_hour(*bar);
  add_weather(*add_slider(*bar, tr("Clouds"), tr("Clouds: from clear to overcast")),
              {"sky", "cloud_cover"});
  add_weather(*add_slider(*bar, tr("Visibility"), tr("Visibility: from fog to clear air")),
              {"sky", "visibility_m"});
  add_model_bar(context.window);
}

void ViewBars::add_quality(QToolBar& bar) {
  bar.addWidget(new QLabel(tr(" Quality ")));
  auto* presets = new QComboBox;
  presets->setAccessibleName(tr("Image quality"));
  presets->addItems({"low", "medium", "high", "ultra"});
  bar.addWidget(presets);
  connect(presets, &QComboBox::textActivated, this, [this](const QString& name) {
    const auto preset = render::preset_from(name.toStdString());
    if (context_.view.session() != nullptr && preset)
      context_.messages.check(context_.view.session()->set_preset(*preset));
  });
  connect(&context_.view, &WorldView::opened, this, [this, presets](const QString& error) {
    if (error.isEmpty())
      presets->setCurrentText(
          to_qstring(render::to_string(context_.view.session()->renderer().preset())));
  });
}

// The hour belongs to the view. The file contains only the hour at which a day begins.
void ViewBars::add_hour(QToolBar& bar) {
  QSlider* hour = add_slider(bar, tr("Hour"), tr("Time of day"));
  hour->setRange(0, 24 * 60);
  hour->setMaximumWidth(kHourPx);
  connect(hour, &QSlider::valueChanged, this, [this](int minutes) {
    const world::Sky& sky = context_.document.world().sky;
    if (context_.view.session() == nullptr) return;
    double hours = minutes / 60.0 - sky.start_hour;
    if (hours < 0) hours += 24;
    context_.view.session()->set_now(hours / 24 * sky.day_length_s);
  });
  const auto update = [this, hour] {
    const bool has_day = context_.document.world().sky.day_length_s > 0;
    hour->setEnabled(has_day);
    if (has_day && context_.view.session() != nullptr && !hour->isSliderDown()) {
      const QSignalBlocker blocker(hour);
      const world::Sky& sky = context_.document.world().sky;
      const double hours =
          sky.start_hour + 24 * context_.view.session()->now_s() / sky.day_length_s;
      hour->setValue(static_cast<int>(60 * std::fmod(hours, 24)));
    }
    hour->setToolTip(has_day ? tr("Time of day")
                             : tr("Set Sky > Day length to use the time of day."));
  };
  connect(&context_.document, &Document::changed, this, update);
  connect(&context_.view, &WorldView::opened, this, update);
  update();
}

// Makes a slider the second control for a field of the sky.
void ViewBars::add_weather(QSlider& slider, const world::TextPath& path) {
  slider.setRange(0, kSliderSteps);
  slider.setMaximumWidth(kWeatherPx);
  connect(&slider, &QSlider::sliderPressed, this, [this] { set_dragging_(true); });
  connect(&slider, &QSlider::sliderReleased, this, [this] { set_dragging_(false); });
  connect(&slider, &QSlider::valueChanged, this, [this, path](int position) {
    const world::WorldField* field = context_.document.field(path);
    if (field == nullptr) return;
    const double value = scale_of(*field).at(static_cast<double>(position) / kSliderSteps);
    context_.messages.check(context_.document.set_value(path, world::toml_number(value)));
  });
  const auto update = [this, &slider, path] {
    const world::WorldField* field = context_.document.field(path);
    slider.setEnabled(field != nullptr && !field->numbers.empty());
    if (!slider.isEnabled() || slider.isSliderDown()) return;
    const QSignalBlocker blocker(&slider);
    slider.setValue(static_cast<int>(
        std::lround(scale_of(*field).fraction_of(field->numbers[0]) * kSliderSteps)));
  };
  connect(&context_.document, &Document::changed, this, update);
  update();
}

void ViewBars::add_model_bar(QMainWindow& window) {
  model_bar_ = window.addToolBar(tr("Model"));
  model_bar_->setObjectName("model");
  auto* title = new QLabel;
  model_bar_->addWidget(title);
  model_bar_->addWidget(new QLabel(tr("  Seed ")));
  auto* seed = new QSpinBox;
  seed->setAccessibleName(tr("Seed of the model"));
  seed->setRange(0, 1'000'000);
  seed->setValue(static_cast<int>(context_.model.seed()));
  model_bar_->addWidget(seed);
  connect(seed, &QSpinBox::valueChanged, this,
          [this](int value) { context_.model.set_seed(static_cast<std::uint64_t>(value)); });
  model_bar_->addWidget(new QLabel(tr("  Drag to orbit, scroll to zoom.  ")));
  model_bar_->addAction(tr("Back to the world"), &context_.model, &ModelView::close);
  model_bar_->toggleViewAction()->setVisible(false);
  connect(&context_.model, &ModelView::switched, this, [this, title] {
    title->setText(" <b>" + context_.model.title().toHtmlEscaped() + "</b>");
    update_model_bar();
  });
  update_model_bar();
}

void ViewBars::update_model_bar() {
  model_bar_->setVisible(context_.model.is_on());
}

}  // namespace psygen::editor
