// A world that is edited. The document is the text of its file: every change is a change of the
// text, is read by the engine before it counts, and is one undo step. A text that is not a world is
// refused and nothing changes. Also its file: saving as a whole, changes by others, and what is
// unsaved after a crash. It has no window and draws nothing. Main thread.
#pragma once

#include <QObject>
#include <QString>
#include <QTimer>
#include <QUndoStack>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "editor/document/disk_watch.hpp"
#include "editor/document/file_copies.hpp"
#include "editor/document/paint_change.hpp"
#include "editor/document/parsed_world.hpp"
#include "editor/document/recovery.hpp"
#include "editor/document/text_command.hpp"
#include "editor/document/variation.hpp"
#include "engine/core/error.hpp"
#include "engine/handmade/files.hpp"
#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

// How a document works.
struct DocumentOptions {
  RegisterModels register_models = {};      // the model types of a program
  std::filesystem::path state_folder = {};  // empty: default_state_folder()
  int autosave_ms = 3000;                   // after a change
};

// Asked before an edit counts: a sentence where a person shall agree first; empty: it counts at
// once. Some milliseconds.
using EditGuard = std::function<QString(const ParsedWorld& before, const ParsedWorld& after)>;

// What became of the file on the disk.
enum class DiskState { kSame, kChanged, kRemoved };

class Document : public QObject {
  Q_OBJECT

 public:
  // A small new world without a file.
  explicit Document(DocumentOptions options = {}, QObject* parent = nullptr);
  // A clean end: what is unsaved is gone, so ask before.
  ~Document() override;

  // --- The file. Every function that fails leaves the document as it was. Messages name the file.

  // Opens a world file; the undo steps end. Fails like world::load_world(), and with
  // kInvalidArgument where another editor has it open, unless `share`.
  core::Result<void> open(const std::filesystem::path& file, bool share = false);
  // A new world: the text with its pictures, or a small one.
  core::Result<void> make_new(std::string text = {}, handmade::MemoryPicturesPtr pictures = {});
  // Writes the file as a whole: after a crash or on a full disk it is the old or the new one. Fails
  // with kIo; with kInvalidArgument without a file, and where the file was changed by others since
  // it was read (reload(), or keep_mine() and save again).
  core::Result<void> save();
  // Writes another file, which is the document's from then on, and replaces what is there. In
  // another folder the files that the world names (handmade::files_named_by) come along, before the
  // text; gives the names of those that were copied. Fails like save() and files_named_by(), and
  // with kInvalidArgument where other files of such names are there (save again to replace them);
  // then nothing new is left there.
  core::Result<std::vector<std::string>> save_as(const std::filesystem::path& file,
                                                 bool share = false);
  // Back to the text of the file as it was last read or saved, as an undo step.
  core::Result<void> revert();
  // The file; empty: none. Whether it, or its folder, cannot be written.
  const std::filesystem::path& file() const { return file_; }
  bool is_read_only() const;
  // Whether the text differs from the file as it was last read or saved, or a picture is painted
  // that is not written.
  bool is_modified() const { return *text_ != saved_ || !unsaved_pictures().empty(); }
  // What save() would change, as `diff -u` shows it.
  std::string unsaved_diff() const;

  // Looks whether others changed the file, and emits disk_changed() for each new state. The
  // document watches the file by itself; call it where a window becomes active.
  DiskState check_disk();
  // Takes over the text of the disk, as an undo step. Fails like open().
  core::Result<void> reload();
  // The next save() replaces what others wrote.
  void keep_mine();

  // --- The text and what it means.

  const std::string& text() const { return *text_; }
  // The world of the text. Views may keep it.
  ParsedWorldPtr parsed() const { return parsed_; }
  const world::World& world() const { return parsed_->world; }
  // All fields (world_schema.hpp), made when they are asked for. Valid until the text changes.
  const std::vector<world::WorldSection>& sections() const;
  const world::WorldField* field(const world::TextPath& path) const;

  // --- Edits. Each is one undo step with this name, or nothing if the text stays. Fail like
  // world::parse_world() and the functions of text_edit.hpp; then nothing changes.

  core::Result<void> set_text(std::string text, const QString& step);
  core::Result<void> set_value(const world::TextPath& path, std::string_view toml_value);
  core::Result<void> reset_value(const world::TextPath& path);
  // All fields below `path` that have a default.
  core::Result<void> reset_section(const world::TextPath& path);
  core::Result<void> append_table(const world::TextPath& array, std::string_view table);
  core::Result<void> remove_table(const world::TextPath& path);
  core::Result<void> move_table(const world::TextPath& item, std::size_t to);
  // A copy behind the item; of a species with another name.
  core::Result<void> duplicate_table(const world::TextPath& item);
  // Another name for a species, also where it is scattered.
  core::Result<void> rename_species(std::size_t species, const std::string& name);
  // Another model for a scatter; parameters that it does not have are removed.
  core::Result<void> set_scatter_model(std::size_t scatter, const std::string& model);
  // Any change of the text by one function, such as world::with_snippet().
  core::Result<void> edit(const QString& step,
                          const std::function<core::Result<std::string>(std::string_view)>& change);
  // --- Edits that wait for an answer. All edits but set_text() are shown to the guard. One that it
  // has a sentence for succeeds, but changes nothing yet: the newest one waits until it is applied,
  // dropped, or the text changes.

  void set_guard(EditGuard guard) { guard_ = std::move(guard); }
  // What is asked; empty: nothing.
  const QString& question() const { return question_; }
  // Makes the edit that waits, as it would have been made at first. Without one, nothing.
  core::Result<void> apply_asked();
  void drop_asked() { ask(std::nullopt, {}); }

  // --- Pictures beside the file, such as masks. They are painted in memory; save() writes them as
  // PNG files, before the text, each as a whole. It fails with kIo, and with kInvalidArgument where
  // another program has put another picture there (save() again replaces it).

  // What the world shows under a name; null where it names no such picture.
  PicturePtr picture(const std::string& name) const;
  // Shows a picture in place of what is there, without an undo step: while a stroke is painted.
  core::Result<void> preview_picture(const std::string& name, const PicturePtr& picture);
  // One undo step: pictures change, and with them the text. Fails like the edits.
  core::Result<void> paint(const QString& step, std::vector<PaintChange> changes, std::string text);
  // What is not written yet, for others that read the text; null: nothing.
  const handmade::MemoryPicturesPtr& pictures() const { return pictures_; }

  // Edits between these two are one step: a drag, or several values at once.
  int begin_drag();
  void end_drag() { drag_ = 0; }
  // Goes on with a drag, by what begin_drag() gave: its step grows, if it is the last one.
  void resume_drag(int drag) { drag_ = drag; }
  QUndoStack& undo_stack() { return undo_; }

  // --- Copies, presets and variations.

  // A value or section as text, and such a text into the section at `path` (text_snippet.hpp).
  core::Result<std::string> copy(const world::TextPath& path) const;
  core::Result<void> paste(const world::TextPath& path, std::string_view snippet);
  // A preset file of a section, and such a file into the section at `path`.
  core::Result<void> save_preset(const world::TextPath& path,
                                 const std::filesystem::path& preset) const;
  core::Result<void> apply_preset(const world::TextPath& path, const std::filesystem::path& preset);
  // Random values for all fields below `path` that are not locked, as one step. A field whose
  // values are refused several times keeps its own.
  core::Result<void> randomise(const world::TextPath& path, std::mt19937_64& random);
  // One field `steps` further.
  core::Result<void> step_value(const world::TextPath& path, int steps);
  // Fields that randomise() leaves alone. Kept in the state folder when the document is saved or
  // ends.
  FieldLocks& locks() { return locks_; }

  // --- After a crash.

  // What other sessions left, of all files or of this one, newest first.
  std::vector<Recovery> recoveries() const { return left_recoveries(options_.state_folder); }
  // Opens the recovery's file with its text as one undo step, and removes the recovery. Where the
  // file cannot be opened, the text becomes that of a new world.
  core::Result<void> recover(const Recovery& recovery);
  // Writes the recovery file now. It is written by itself a while after each change.
  core::Result<void> write_recovery();

 Q_SIGNALS:
  // After every change of the text, by edits, undo and files.
  void changed(psygen::editor::Changes what);
  void modified_changed(bool modified);
  void file_changed();
  // Another edit waits for an answer; empty: none.
  void asked(const QString& sentence);
  // Others changed or removed the file, or put it back. `conflict`: there are unsaved changes too.
  void disk_changed(psygen::editor::DiskState state, bool conflict);
  // The recovery file cannot be written. Once, until it works again.
  void autosave_failed(const QString& sentence);

 private:
  // A file with its lock; the old session, if it is the same file.
  core::Result<std::unique_ptr<RecoverySession>> session_of(const std::filesystem::path& file,
                                                            bool share);
  void adopt(const std::filesystem::path& file, std::string text, ParsedWorldPtr parsed,
             std::unique_ptr<RecoverySession> session, handmade::MemoryPicturesPtr pictures = {});
  void note_saved(std::string text);
  core::Result<void> require_known_disk() const;
  core::Result<ParsedWorldPtr> parse(const std::string& text) const;
  std::string name() const;  // for messages
  // An edit whose text is a world.
  struct Edit {
    std::string text;
    QString step;
    std::optional<FieldLocks> locks;
    int drag = 0;
    std::vector<PaintChange> paint = {};
  };
  core::Result<void> push(std::string text, const QString& step,
                          std::optional<FieldLocks> locks = {}, bool guarded = true);
  void make(Edit edit, ParsedWorldPtr parsed);
  void ask(std::optional<Edit> edit, const QString& question);
  void show(const ShownText& shown);
  void note_modified();
  std::vector<std::string> unsaved_pictures() const;  // by name
  handmade::MemoryPicturesPtr with_picture(const std::string& name,
                                           const PicturePtr& picture) const;
  // Makes the next world, of this text with these pictures.
  core::Result<void> show_pictures(handmade::MemoryPicturesPtr pictures, const std::string& text);
  void note_on_disk(const std::string& name);
  void apply(const std::vector<PaintChange>& changes, bool done);
  void end_preview();
  core::Result<void> require_known_pictures(const std::filesystem::path& file);
  core::Result<void> write_pictures(const std::filesystem::path& file) const;
  void note_pictures_written();
  core::Result<void> write_all(const std::filesystem::path& file);
  core::Result<std::vector<std::string>> take_along(const std::filesystem::path& file,
                                                    FileCopies& copies);
  core::Result<void> require_free(const std::vector<std::filesystem::path>& taken);
  void autosave();
  void save_locks() const;

  DocumentOptions options_;
  std::filesystem::path file_;
  TextPtr text_;
  ParsedWorldPtr parsed_;
  ParsedWorldPtr next_parsed_;            // of the text that an edit is about to show
  std::string saved_;                     // the file as it was last read or saved
  std::optional<std::string> seen_;       // the text of the disk that was told last; none: no file
  handmade::MemoryPicturesPtr pictures_;  // null: none was painted
  std::optional<handmade::MemoryPicturesPtr> before_preview_;  // while one is shown
  // Hashes of pictures as files had them when they were read or written, by name. What files were
  // when saving was refused for them, by path.
  std::map<std::string, std::uint64_t> disk_pictures_, refused_files_;
  bool was_modified_ = false;
  bool autosave_told_ = false;
  int drag_ = 0, last_drag_ = 0;
  EditGuard guard_;
  std::optional<Edit> asked_;
  QString question_;
  FieldLocks locks_, kept_locks_;  // kept: as the state folder has them
  QUndoStack undo_;
  DiskWatch watch_;
  QTimer autosave_timer_;
  std::unique_ptr<RecoverySession> session_;
  mutable std::optional<std::vector<world::WorldSection>> sections_;
};

}  // namespace psygen::editor
