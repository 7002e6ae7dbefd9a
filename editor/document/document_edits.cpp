// Edits of a document: each changes its text (engine/world/files/text_edit.hpp).
#include <fmt/format.h>

#include <QUndoCommand>
#include <algorithm>
#include <utility>

#include "editor/document/document.hpp"
#include "editor/document/field_value.hpp"
#include "editor/document/qt_text.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/text_snippet.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

constexpr int kTries = 8;  // random values per field

using Text = core::Result<std::string>;

// All fields below a path, in order.
std::vector<const world::WorldField*> fields_below(
    const world::TextPath& path, const std::vector<world::WorldSection>& sections) {
  std::vector<const world::WorldField*> fields;
  for (const world::WorldSection& section : sections) {
    for (const world::WorldField& field : section.fields) {
      if (field.path.starts_with(path)) fields.push_back(&field);
    }
    const auto parts = fields_below(path, section.parts);
    fields.insert(fields.end(), parts.begin(), parts.end());
  }
  return fields;
}

// An undo step. Steps of one drag merge.
class TextCommand : public QUndoCommand {
 public:
  // `drag`: steps with the same number merge; 0: none. `show` sets the text of the document.
  TextCommand(const QString& name, ShownText before, ShownText after, int drag,
              std::function<void(const ShownText&)> show)
      : QUndoCommand(name),
        before_(std::move(before)),
        after_(std::move(after)),
        drag_(drag),
        show_(std::move(show)) {}

  void undo() override { show_(before_); }
  void redo() override { show_(after_); }
  int id() const override { return drag_ == 0 ? -1 : drag_; }
  // A drag that ends at its first text is no step.
  bool mergeWith(const QUndoCommand* next) override {
    after_ = static_cast<const TextCommand*>(next)->after_;
    setObsolete(*before_.text == *after_.text);
    return true;
  }

 private:
  ShownText before_, after_;
  int drag_;
  std::function<void(const ShownText&)> show_;
};

}  // namespace

core::Result<void> Document::push(Text text, const QString& step, std::optional<FieldLocks> locks,
                                  bool guarded) {
  if (!text) return tl::unexpected(std::move(text.error()));
  if (*text == *text_) return discard_proposed_edit(), core::Result<void>{};
  auto parsed = parse(*text);
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  Edit edit{.text = *std::move(text), .step = step, .locks = std::move(locks), .drag = drag_};
  if (guarded && guard_) {
    const QString confirmation = guard_(*parsed_, **parsed);
    if (!confirmation.isEmpty())
      return propose_edit(std::move(edit), confirmation), core::Result<void>{};
  }
  apply_edit(std::move(edit), *std::move(parsed));
  return {};
}

void Document::apply_edit(Edit edit, ParsedWorldPtr parsed) {
  const ShownText before{text_, parsed_};
  const ShownText after{std::make_shared<const std::string>(std::move(edit.text)), parsed};
  next_parsed_ = std::move(parsed);
  std::function<void(const ShownText&)> show_step = [this](const ShownText& shown) { show(shown); };
  if (edit.locks)
    show_step = [this, first = text_, undone = locks_, done = edit.locks](const ShownText& shown) {
      locks_ = shown.text == first ? undone : *done;
      show(shown);
    };
  if (!edit.paint.empty())
    show_step = [this, first = text_, paint = std::move(edit.paint)](const ShownText& shown) {
      apply_paint(paint, shown.text != first);
      show(shown);
    };
  undo_.push(new TextCommand(edit.step, before, after, edit.drag, std::move(show_step)));
  before_preview_.reset();
}

void Document::propose_edit(std::optional<Edit> edit, const QString& confirmation) {
  proposed_edit_ = std::move(edit);
  if (std::exchange(confirmation_, confirmation) != confirmation)
    Q_EMIT edit_proposed(confirmation);
}

core::Result<void> Document::apply_proposed_edit() {
  if (!proposed_edit_) return {};
  Edit edit = *std::move(proposed_edit_);
  discard_proposed_edit();
  auto parsed = parse(edit.text);
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  apply_edit(std::move(edit), *std::move(parsed));
  return {};
}

core::Result<void> Document::set_text(std::string text, const QString& step) {
  const int drag = std::exchange(drag_, 0);
  const auto before = text_;
  auto set = push(std::move(text), step, {}, false);
  if (drag != 0 && text_ != before)
    begin_drag();
  else
    drag_ = drag;
  return set;
}

core::Result<void> Document::edit(const QString& step,
                                  const std::function<Text(std::string_view)>& change) {
  return push(change(*text_), step);
}

int Document::begin_drag() {
  drag_text_ = text_;
  return drag_ = ++last_drag_;
}

core::Result<void> Document::cancel_drag() {
  if (drag_ == 0) return {};
  return push(*drag_text_, tr("Cancel"), {}, false);
}

core::Result<void> Document::set_value(const world::TextPath& path, std::string_view toml_value) {
  return edit(tr("Set %1").arg(to_qstring(path.text())), [&](std::string_view text) -> Text {
    return with_field_value(text, *parsed_, path, toml_value);
  });
}

core::Result<void> Document::reset_value(const world::TextPath& path) {
  return edit(tr("Reset %1").arg(to_qstring(path.text())),
              [&](std::string_view text) { return world::without_value(text, path); });
}

core::Result<void> Document::append_table(const world::TextPath& array, std::string_view table) {
  return edit(tr("Add %1").arg(to_qstring(array.text())), [&](std::string_view text) {
    return world::with_table_appended(text, array, table);
  });
}

core::Result<void> Document::remove_table(const world::TextPath& path) {
  FieldLocks locks = locks_;
  if (!path.empty() && path.back().is_index) locks.note_removed(path);
  return push(world::without_table(*text_, path), tr("Remove %1").arg(to_qstring(path.text())),
              std::move(locks));
}

core::Result<void> Document::move_table(const world::TextPath& item, std::size_t to) {
  auto text = world::with_table_moved(*text_, item, to);
  if (!text) return tl::unexpected(std::move(text.error()));
  FieldLocks locks = locks_;
  locks.note_moved(item, to);
  return push(std::move(text), tr("Move %1").arg(to_qstring(item.text())), std::move(locks));
}

core::Result<void> Document::duplicate_table(const world::TextPath& item) {
  auto text = world::with_table_duplicated(*text_, item);
  if (!text) return tl::unexpected(std::move(text.error()));
  const world::TextPath copy = item.parent().with(item.back().index + 1);
  if (item.first(1) == world::TextPath{"species"} && item.size() == 2) {
    const std::string& name = world().species[item.back().index].name;
    int number = 2;
    while (parsed_->registry.find(fmt::format("{}_{}", name, number)) >= 0)
      ++number;
    text = world::with_value(*text, copy.with("name"),
                             world::toml_string(fmt::format("{}_{}", name, number)));
  }
  FieldLocks locks = locks_;
  locks.note_inserted(copy);
  return push(std::move(text), tr("Duplicate %1").arg(to_qstring(item.text())), std::move(locks));
}

core::Result<std::string> Document::copy(const world::TextPath& path) const {
  return world::copied_snippet(*text_, path);
}

core::Result<void> Document::paste(const world::TextPath& path, std::string_view snippet) {
  return edit(tr("Paste into %1").arg(to_qstring(path.text())),
              [&](std::string_view text) { return world::with_snippet(text, path, snippet); });
}

core::Result<void> Document::save_preset(const world::TextPath& path,
                                         const std::filesystem::path& preset) const {
  return copy(path).and_then([&](const std::string& snippet) {
    return core::replace_file(preset, world::preset_text(snippet));
  });
}

core::Result<void> Document::apply_preset(const world::TextPath& path,
                                          const std::filesystem::path& preset) {
  const auto snippet = world::read_text_file(preset).and_then(
      [&](const std::string& text) { return world::read_preset(text, preset.string()); });
  if (!snippet) return tl::unexpected(snippet.error());
  return edit(tr("Apply %1").arg(to_qstring(preset.stem().string())),
              [&](std::string_view before) { return world::with_snippet(before, path, *snippet); });
}

core::Result<void> Document::reset_section(const world::TextPath& path) {
  return edit(tr("Reset %1").arg(to_qstring(path.text())), [&](std::string_view before) {
    Text text{std::string(before)};
    for (const world::WorldField* field : fields_below(path, sections())) {
      if (text && field->is_set && !field->required)
        text = world::without_value(*text, field->path);
    }
    return text;
  });
}

core::Result<void> Document::randomise(const world::TextPath& path, std::mt19937_64& random) {
  std::string text = *text_;
  for (const world::WorldField* field : fields_below(path, sections())) {
    const bool names_others = field->required && field->kind == world::FieldKind::kChoice;
    if (names_others || field->is_switch || locks_.is_locked(field->path)) continue;
    for (int i = 0; i < kTries; ++i) {
      const auto value = random_value(*field, random);
      if (!value) break;
      auto next = world::with_value(text, field->path, *value);
      if (!next || !parse(*next)) continue;
      text = *std::move(next);
      break;
    }
  }
  return push(std::move(text), tr("Randomise %1").arg(to_qstring(path.text())));
}

core::Result<void> Document::step_value(const world::TextPath& path, int steps) {
  const world::WorldField* of = field(path);
  const auto value = of != nullptr ? stepped_value(*of, steps) : std::nullopt;
  if (!value)
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{}: the field has no number to step", path.text()));
  return set_value(path, *value);
}

}  // namespace psygen::editor
