#include "editor/panels/section_bar.hpp"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <algorithm>

namespace psygen::editor {
namespace {

// True if the text sets a field with a default, in the section or in its parts.
bool sets_anything(const world::WorldSection& section) {
  const auto is_set = [](const world::WorldField& field) {
    return field.is_set && !field.required;
  };
  return std::ranges::any_of(section.fields, is_set) ||
         std::ranges::any_of(section.parts, sets_anything);
}

}  // namespace

SectionBar::SectionBar(QWidget* parent)
    : QWidget(parent), title_(new QLabel), reset_(new QToolButton) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(4, 0, 4, 0);
  layout->addWidget(title_, 1);
  const auto add = [&](QToolButton* button, const QString& text, const QString& help,
                       void (SectionBar::*signal)()) {
    button->setText(text);
    button->setToolTip(help);
    button->setAccessibleName(help);
    button->setFocusPolicy(Qt::StrongFocus);
    layout->addWidget(button);
    connect(button, &QToolButton::clicked, this, signal);
  };
  add(new QToolButton, tr("Copy"), tr("Copy all fields of this section as text"),
      &SectionBar::copy_requested);
  add(new QToolButton, tr("Paste"), tr("Paste text into this section"),
      &SectionBar::paste_requested);
  add(new QToolButton, tr("⚄"), tr("Randomise all fields of this section"),
      &SectionBar::randomise_requested);
  add(reset_, tr("↺"), tr("Reset all fields of this section to their defaults"),
      &SectionBar::reset_requested);
}

void SectionBar::show(const world::WorldSection* section) {
  setVisible(section != nullptr);
  if (section == nullptr) return;
  title_->setText("<b>" + QString::fromStdString(section->title).toHtmlEscaped() + "</b>");
  reset_->setEnabled(sets_anything(*section));
}

}  // namespace psygen::editor
