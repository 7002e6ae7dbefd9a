#include "editor/panels/impact_bar.hpp"

#include <QAccessible>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

namespace psygen::editor {

ImpactBar::ImpactBar(QWidget* parent)
    : QFrame(parent),
      text_(new QLabel),
      apply_(new QPushButton(tr("&Apply anyway"))),
      discard_(new QPushButton(tr("&Keep the old value"))) {
  setObjectName("impact");
  text_->setWordWrap(true);
  text_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  text_->setAccessibleName(tr("Impact of the last change"));
  text_->setMinimumHeight(3 * text_->fontMetrics().lineSpacing());
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(apply_);
  buttons->addWidget(discard_);
  buttons->addStretch(1);
  for (QPushButton* button : {apply_, discard_}) {
    QSizePolicy policy = button->sizePolicy();
    policy.setRetainSizeWhenHidden(true);
    button->setSizePolicy(policy);
  }
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 4, 6, 4);
  layout->setSpacing(2);
  layout->addWidget(text_);
  layout->addLayout(buttons);
  connect(apply_, &QPushButton::clicked, this, &ImpactBar::apply_requested);
  connect(discard_, &QPushButton::clicked, this, &ImpactBar::discard_requested);
  impact_ = tr("The cost of your last change appears here.");
  update_widgets();
}

void ImpactBar::show_impact(const QString& impact) {
  impact_ = impact;
  update_widgets();
}

void ImpactBar::ask(const QString& question) {
  question_ = question;
  asks_ = !question.isEmpty();
  update_widgets();
  if (!asks_) return;
  QAccessibleEvent alert(text_, QAccessible::Alert);
  QAccessible::updateAccessibility(&alert);
}

void ImpactBar::update_widgets() {
  text_->setText(asks_ ? question_ : impact_);
  apply_->setVisible(asks_);
  discard_->setVisible(asks_);
  setStyleSheet(
      QString("#impact { border: 2px solid palette(%1); }").arg(asks_ ? "highlight" : "midlight"));
}

}  // namespace psygen::editor
