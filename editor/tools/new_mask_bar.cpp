#include "editor/tools/new_mask_bar.hpp"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

enum Area { kAroundView, kWholeWorld };

}  // namespace

NewMaskBar::NewMaskBar(QWidget* parent)
    : QWidget(parent), area_(new QComboBox), pixels_(new QLabel) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(6, 0, 6, 0);
  area_->setAccessibleName(tr("Area of the new mask"));
  area_->setToolTip(tr("Area of the new mask: the blue border in the view"));
  area_->addItem(tr("Around the view"));
  layout->addWidget(area_);
  side_ = add_metres(tr("Side"), tr("Side of the new mask in metres"));
  side_->setRange(NewMask::kMinSideM, NewMask::kMaxSideM);
  side_->setDecimals(0);
  pixel_ = add_metres(tr("Pixel"), tr("Size of a pixel of the new mask in metres"));
  pixel_->setRange(NewMask::kMinPixelM, NewMask::kMaxPixelM);
  pixel_->setDecimals(1);
  layout->addWidget(pixels_);
  const auto changed = [this] { Q_EMIT edited(shown()); };
  connect(area_, &QComboBox::activated, this, changed);
  connect(side_, &QDoubleSpinBox::valueChanged, this, changed);
  connect(pixel_, &QDoubleSpinBox::valueChanged, this, changed);
}

QDoubleSpinBox* NewMaskBar::add_metres(const QString& label, const QString& name) {
  auto* edit = new QDoubleSpinBox;
  edit->setAccessibleName(name);
  edit->setToolTip(name);
  edit->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  edit->setGroupSeparatorShown(true);
  edit->setSuffix(tr(" m"));
  layout()->addWidget(new QLabel(label));
  layout()->addWidget(edit);
  return edit;
}

NewMask NewMaskBar::shown() const {
  return {.whole_world = area_->currentIndex() == kWholeWorld,
          .side_m = side_->value(),
          .pixel_m = pixel_->value()};
}

void NewMaskBar::show_plan(const NewMask& mask, const world::World& world) {
  const QSignalBlocker quiet[] = {QSignalBlocker(area_), QSignalBlocker(side_),
                                  QSignalBlocker(pixel_)};
  if (world.is_endless() && area_->count() > kWholeWorld) area_->removeItem(kWholeWorld);
  if (!world.is_endless() && area_->count() == kWholeWorld) area_->addItem(tr("The whole world"));
  const bool whole = mask.whole_world && !world.is_endless();
  area_->setCurrentIndex(whole ? kWholeWorld : kAroundView);
  side_->setEnabled(!whole);
  // Does not replace a value while the user types it.
  if (side_->value() != mask.side_m) side_->setValue(mask.side_m);
  if (pixel_->value() != mask.pixel_m) pixel_->setValue(mask.pixel_m);
  const auto plan = plan_of(mask, world, {0, 0});
  pixels_->setText(plan
                       ? tr("%1 × %2 pixels").arg(count_text(plan->width), count_text(plan->height))
                       : tr("<b>too many pixels</b>"));
  pixels_->setToolTip(plan ? QString() : to_qstring(plan.error().message));
}

}  // namespace psygen::editor
