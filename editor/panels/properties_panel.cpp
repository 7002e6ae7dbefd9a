#include "editor/panels/properties_panel.hpp"

#include <QAccessible>
#include <QApplication>
#include <QClipboard>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSplitter>
#include <QToolButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <functional>

#include "editor/document/qt_text.hpp"
#include "editor/panels/message_log.hpp"

namespace psygen::editor {
namespace {

constexpr int kPathRole = Qt::UserRole;

using Visit = std::function<void(const world::WorldSection&)>;
void visit(const std::vector<world::WorldSection>& sections, const Visit& each) {
  for (const world::WorldSection& section : sections) {
    each(section);
    visit(section.parts, each);
  }
}

bool same_fields(const world::WorldSection& a, const world::WorldSection& b) {
  const auto same_field = [](const world::WorldField& x, const world::WorldField& y) {
    return x.path == y.path && x.kind == y.kind && x.choices == y.choices;
  };
  return a.path == b.path && a.title == b.title &&
         std::ranges::equal(a.fields, b.fields, same_field) &&
         std::ranges::equal(a.parts, b.parts, same_fields);
}

// True if the text sets a field with a default, in the section or in its parts.
bool sets_anything(const world::WorldSection& section) {
  const auto is_set = [](const world::WorldField& field) {
    return field.is_set && !field.required;
  };
  return std::ranges::any_of(section.fields, is_set) ||
         std::ranges::any_of(section.parts, sets_anything);
}

}  // namespace

PropertiesPanel::PropertiesPanel(FieldHost host)
    : host_(std::move(host)),
      search_(new QLineEdit),
      tree_(new QTreeWidget),
      heading_(make_heading()),
      scroll_(new QScrollArea),
      impact_(make_impact()) {
  search_->setPlaceholderText(tr("Search all fields"));
  search_->setClearButtonEnabled(true);
  search_->setAccessibleName(tr("Search all fields"));
  tree_->setHeaderHidden(true);
  tree_->setAccessibleName(tr("Sections of the world"));
  tree_->setContextMenuPolicy(Qt::CustomContextMenu);
  scroll_->setWidgetResizable(true);
  scroll_->setFrameShape(QFrame::NoFrame);
  auto* fields = new QWidget;
  auto* fields_layout = new QVBoxLayout(fields);
  fields_layout->setContentsMargins(0, 0, 0, 0);
  fields_layout->setSpacing(2);
  fields_layout->addWidget(heading_);
  fields_layout->addWidget(scroll_, 1);
  auto* splitter = new QSplitter(Qt::Vertical);
  splitter->addWidget(tree_);
  splitter->addWidget(fields);
  splitter->setStretchFactor(0, 2);
  splitter->setStretchFactor(1, 5);
  splitter->setChildrenCollapsible(false);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(search_);
  layout->addWidget(splitter, 1);
  layout->addWidget(impact_);
  show_impact(tr("The cost of your last change appears here."));
  connect(search_, &QLineEdit::textChanged, this, &PropertiesPanel::search);
  connect(tree_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    if (item == nullptr || item->data(0, kPathRole).isNull()) return;
    const auto path = world::parse_text_path(item->data(0, kPathRole).toString().toStdString());
    if (path) chosen_ = *path;
    search_->clear();
    search({});
    Q_EMIT section_chosen(chosen_);
  });
  connect(tree_, &QTreeWidget::customContextMenuRequested, this, [this](const QPoint& at) {
    if (tree_->itemAt(at) != nullptr)
      Q_EMIT section_menu_requested(tree_->viewport()->mapToGlobal(at));
  });
}

QWidget* PropertiesPanel::make_heading() {
  auto* heading = new QWidget;
  heading->setObjectName("heading");
  auto* layout = new QHBoxLayout(heading);
  layout->setContentsMargins(4, 0, 4, 0);
  layout->addWidget(title_ = new QLabel, 1);
  const auto add = [&](const QString& text, const QString& help, auto command) {
    auto* button = new QToolButton;
    button->setText(text);
    button->setToolTip(help);
    button->setAccessibleName(help);
    button->setFocusPolicy(Qt::StrongFocus);
    layout->addWidget(button);
    connect(button, &QToolButton::clicked, this, command);
    return button;
  };
  add(tr("Copy"), tr("Copy all fields of this section as text"), &PropertiesPanel::copy);
  add(tr("Paste"), tr("Paste text into this section"), &PropertiesPanel::paste);
  add(tr("⚄"), tr("Randomise all fields of this section"), &PropertiesPanel::randomise);
  reset_ = add(tr("↺"), tr("Reset all fields of this section to their defaults"),
               &PropertiesPanel::reset);
  return heading;
}

// The height is constant, so that the fields keep their place.
QFrame* PropertiesPanel::make_impact() {
  auto* frame = new QFrame;
  frame->setObjectName("impact");
  impact_label_ = new QLabel;
  impact_label_->setWordWrap(true);
  impact_label_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  impact_label_->setAccessibleName(tr("Impact of the last change"));
  impact_label_->setMinimumHeight(3 * impact_label_->fontMetrics().lineSpacing());
  apply_ = new QPushButton(tr("&Apply anyway"));
  discard_ = new QPushButton(tr("&Keep the old value"));
  auto* buttons = new QHBoxLayout;
  for (QPushButton* button : {apply_, discard_}) {
    QSizePolicy policy = button->sizePolicy();
    policy.setRetainSizeWhenHidden(true);
    button->setSizePolicy(policy);
    buttons->addWidget(button);
  }
  buttons->addStretch(1);
  auto* layout = new QVBoxLayout(frame);
  layout->setContentsMargins(6, 4, 6, 4);
  layout->setSpacing(2);
  layout->addWidget(impact_label_);
  layout->addLayout(buttons);
  connect(apply_, &QPushButton::clicked, this,
          [this] { host_.messages.check(host_.document.apply_proposed_edit()); });
  connect(discard_, &QPushButton::clicked, this, [this] {
    host_.document.discard_proposed_edit();
    show(host_.document.sections());
  });
  connect(&host_.document, &Document::edit_proposed, this, [this](const QString& question) {
    update_impact();
    if (question.isEmpty()) return;
    QAccessibleEvent alert(impact_label_, QAccessible::Alert);
    QAccessible::updateAccessibility(&alert);
  });
  return frame;
}

void PropertiesPanel::show_impact(const QString& impact) {
  impact_text_ = impact;
  update_impact();
}

void PropertiesPanel::update_impact() {
  const QString& question = host_.document.confirmation();
  const bool asks = !question.isEmpty();
  impact_label_->setText(asks ? question : impact_text_);
  apply_->setVisible(asks);
  discard_->setVisible(asks);
  impact_->setStyleSheet(
      QString("#impact { border: 2px solid palette(%1); }").arg(asks ? "highlight" : "midlight"));
}

// Null hides the heading, for a list of fields from several sections.
void PropertiesPanel::show_heading(const world::WorldSection* section) {
  heading_->setVisible(section != nullptr);
  if (section == nullptr) return;
  title_->setText("<b>" + to_qstring(section->title).toHtmlEscaped() + "</b>");
  reset_->setEnabled(sets_anything(*section));
}

void PropertiesPanel::randomise() {
  host_.messages.check(host_.document.randomise(chosen_, host_.random));
}

void PropertiesPanel::reset() {
  host_.messages.check(host_.document.reset_section(chosen_));
}

void PropertiesPanel::copy() {
  const auto text = host_.document.copy(chosen_);
  if (!text) return host_.messages.show_message(to_qstring(text.error().message));
  QApplication::clipboard()->setText(to_qstring(*text));
  host_.messages.show_message(tr("Copied %1 as text.").arg(to_qstring(chosen_.text())));
}

void PropertiesPanel::paste() {
  host_.messages.check(
      host_.document.paste(chosen_, QApplication::clipboard()->text().toStdString()));
}

void PropertiesPanel::show(const std::vector<world::WorldSection>& sections) {
  const bool same = std::ranges::equal(sections, sections_, same_fields);
  sections_ = sections;
  if (!same) return list(sections);
  mark(sections);
  if (search_->text().isEmpty()) show_heading(chosen());
  for (FieldRow* row : rows_) {
    if (const world::WorldField* field = find_field(sections_, row->field().path))
      row->show(*field);
  }
}

void PropertiesPanel::list(const std::vector<world::WorldSection>& sections) {
  const world::TextPath before = chosen_;
  {
    const QSignalBlocker quiet(tree_);
    tree_->clear();
    for (const world::WorldSection& section : sections)
      add_item(section, group_of(section.kind));
    tree_->expandToDepth(0);
  }
  mark(sections);
  tree_->setCurrentItem(nullptr);
  go_to(before);
  if (tree_->currentItem() == nullptr && tree_->topLevelItemCount() > 0)
    tree_->setCurrentItem(tree_->topLevelItem(0));
}

// Lists of sections get headings, because a species and its scatter layer have the same name.
QTreeWidgetItem* PropertiesPanel::group_of(world::SectionKind kind) {
  const QString title = kind == world::SectionKind::kSpecies   ? tr("Species")
                        : kind == world::SectionKind::kModel   ? tr("Models from files")
                        : kind == world::SectionKind::kScatter ? tr("Scatter layers")
                        : kind == world::SectionKind::kPlace   ? tr("Placed by hand")
                        : kind == world::SectionKind::kStamp   ? tr("Heightmap stamps")
                        : kind == world::SectionKind::kRoad    ? tr("Roads")
                        : kind == world::SectionKind::kLake    ? tr("Lakes")
                        : kind == world::SectionKind::kRiver   ? tr("Rivers")
                                                               : QString();
  if (title.isEmpty()) return nullptr;
  const auto known = tree_->findItems(title, Qt::MatchExactly);
  if (!known.empty()) return known.front();
  auto* group = new QTreeWidgetItem(tree_, {title});
  group->setFlags(Qt::ItemIsEnabled);
  return group;
}

void PropertiesPanel::add_item(const world::WorldSection& section, QTreeWidgetItem* parent) {
  auto* item = parent != nullptr ? new QTreeWidgetItem(parent) : new QTreeWidgetItem(tree_);
  item->setText(0, to_qstring(section.title));
  item->setData(0, kPathRole, to_qstring(section.path.text()));
  for (const world::WorldSection& part : section.parts)
    add_item(part, item);
}

// Sections that the text contains are bold.
void PropertiesPanel::mark(const std::vector<world::WorldSection>& sections) {
  std::vector<const world::WorldSection*> all;
  visit(sections, [&](const world::WorldSection& section) { all.push_back(&section); });
  std::size_t next = 0;
  for (QTreeWidgetItemIterator it(tree_); *it != nullptr && next < all.size(); ++it) {
    if ((*it)->data(0, kPathRole).isNull()) continue;
    QFont font = (*it)->font(0);
    font.setBold(all[next++]->is_set);
    (*it)->setFont(0, font);
  }
}

void PropertiesPanel::go_to(const world::TextPath& section) {
  for (QTreeWidgetItemIterator it(tree_); *it != nullptr; ++it) {
    const QVariant path = (*it)->data(0, kPathRole);
    if (path.isNull() || path.toString() != to_qstring(section.text())) continue;
    tree_->setCurrentItem(*it);
    tree_->scrollToItem(*it);
    return;
  }
}

const world::WorldSection* PropertiesPanel::chosen() const {
  const world::WorldSection* found = nullptr;
  visit(sections_, [&](const world::WorldSection& section) {
    if (section.path == chosen_) found = &section;
  });
  return found;
}

void PropertiesPanel::add_row(const world::WorldField& field) {
  auto* row = new FieldRow(host_, field);
  lines_->addWidget(row);
  rows_.push_back(row);
  connect(row, &FieldRow::field_focused, this, &PropertiesPanel::field_focused);
}

// Shows the fields of the chosen section, or all fields that contain the text.
void PropertiesPanel::search(const QString& text) {
  rows_.clear();
  auto* form = new QWidget;
  lines_ = new QVBoxLayout(form);
  lines_->setSpacing(1);
  if (text.isEmpty()) {
    const world::WorldSection* section = chosen();
    show_heading(section);
    if (section != nullptr) {
      for (const world::WorldField& field : section->fields)
        add_row(field);
    }
  } else {
    show_heading(nullptr);
    visit(sections_, [&](const world::WorldSection& section) {
      bool headed = false;
      for (const world::WorldField& field : section.fields) {
        const QString about = to_qstring(section.title + " " + field.label + " " + field.doc + " " +
                                         field.path.text());
        if (!about.contains(text, Qt::CaseInsensitive)) continue;
        if (!std::exchange(headed, true))
          lines_->addWidget(new QLabel("<b>" + to_qstring(section.title) + "</b>"));
        add_row(field);
      }
    });
    if (rows_.empty()) lines_->addWidget(new QLabel(tr("No matching fields.")));
  }
  lines_->addStretch(1);
  // A row of the previous form may be in the middle of its signal.
  if (QWidget* previous = scroll_->takeWidget()) previous->deleteLater();
  scroll_->setWidget(form);
}

std::vector<world::WorldField> PropertiesPanel::shown_fields() const {
  std::vector<world::WorldField> fields;
  for (const FieldRow* row : rows_)
    fields.push_back(row->field());
  return fields;
}

FieldRow* PropertiesPanel::row(const world::TextPath& path) const {
  for (FieldRow* row : rows_) {
    if (row->field().path == path) return row;
  }
  return nullptr;
}

}  // namespace psygen::editor
