// A world file in the editor. The document is the text of the file: every edit changes the text, is
// one undo step, and takes effect only if the engine can parse the new text. The document also
// saves the file, detects changes by other programs, and keeps unsaved changes for recovery after a
// crash. It has no window and draws nothing. Main thread.
#pragma once

#include <QFileSystemWatcher>
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

#include "editor/document/file_copies.hpp"
#include "editor/document/paint_change.hpp"
#include "editor/document/parsed_world.hpp"
#include "editor/document/recovery.hpp"
#include "editor/document/variation.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/error.hpp"
#include "engine/handmade/files.hpp"
#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

struct DocumentOptions {
  RegisterModels register_models = {};      // the model types of a program
  std::filesystem::path state_folder = {};  // empty: default_state_folder()
  int autosave_ms = 3000;                   // after a change
  // Worlds in these folders or below come with psygen: they are templates.
  std::vector<std::filesystem::path> shipped_folders = core::installed_folders("worlds");
};

// Called before an edit takes effect. Returns the question for the user's confirmation, or an empty
// text if the edit needs none. Takes some milliseconds.
using EditGuard = std::function<QString(const ParsedWorld& before, const ParsedWorld& after)>;

// State of the file on the disk, compared with the document's last read or write.
enum class DiskState { kSame, kChanged, kRemoved };

using TextPtr = std::shared_ptr<const std::string>;

// A text and its world at the time of an undo step. Parsing the text again may give another world
// if its resources have changed, or an error if they are missing.
struct ShownText {
  TextPtr text;
  ParsedWorldPtr world;
};

// One open world.
class Document : public QObject {
  Q_OBJECT

 public:
  // A small new world without a file.
  explicit Document(DocumentOptions options = {}, QObject* parent = nullptr);
  // Discards unsaved changes and their recovery, so ask the user before.
  ~Document() override;

  // --- The file. A function that fails leaves the document unchanged. Messages name the file.

  // Opens a world file and clears the undo steps. Fails like world::load_world(), and with
  // kInvalidArgument if another editor has it open, unless `share`. A world that comes with psygen
  // opens as a template.
  core::Result<void> open(const std::filesystem::path& file, bool share = false);
  // Replaces the document by a new world without a file: the text with its images, or a small one.
  core::Result<void> make_new(std::string text = {}, handmade::MemoryPicturesPtr pictures = {});
  // Writes the file atomically: after a crash or on a full disk it is the old or the new one. Fails
  // with kIo, and with kInvalidArgument if the document has no file, is a template, or if another
  // program changed it since the last read (reload(), or keep_editor_version() and save again).
  core::Result<void> save();
  // Writes another file, replaces an existing one, and makes it the document's file. Into another
  // folder it first copies the files that the world references (handmade::files_named_by) and
  // returns their names. Fails like save() and files_named_by(), and with kInvalidArgument if other
  // files of these names exist (save again to replace them), or if the file comes with psygen.
  // After a failure no new files are left.
  core::Result<std::vector<std::string>> save_as(const std::filesystem::path& file,
                                                 bool share = false);
  // Restores the text of the last read or save, as an undo step.
  core::Result<void> revert();
  // The file; empty: none.
  const std::filesystem::path& file() const { return file_; }
  // True if the file comes with psygen, links resolved: it is never written.
  bool is_template() const { return is_template_; }
  // True if the file or its folder is not writable, except for a template.
  bool is_read_only() const;
  // True if the text differs from the last read or save, or a painted image is unsaved.
  bool is_modified() const { return *text_ != saved_ || !unsaved_pictures().empty(); }
  // The changes that save() would write, in the format of `diff -u`.
  std::string unsaved_diff() const;

  // Compares the document with the disk and emits disk_changed() for each new state. The document
  // also watches the file; call this function when a window becomes active.
  DiskState check_disk();
  // Replaces the text by that of the disk, as an undo step. Fails like open().
  core::Result<void> reload();
  // Lets the next save() replace the changes of other programs.
  void keep_editor_version();

  // --- The text and its world.

  const std::string& text() const { return *text_; }
  // The world of the text. Views may keep it.
  ParsedWorldPtr parsed() const { return parsed_; }
  const world::World& world() const { return parsed_->world; }
  // All fields (world_schema.hpp), computed on the first call. Valid until the text changes.
  const std::vector<world::WorldSection>& sections() const;
  const world::WorldField* field(const world::TextPath& path) const;

  // --- Edits. Each is one undo step, or none if the text stays the same. They fail like
  // world::parse_world() and the functions of text_edit.hpp; then nothing changes.

  // `step`: name of the undo step.
  core::Result<void> set_text(std::string text, const QString& step);
  // A new name of a species or of a model from a file is also set in the scatters and placed models
  // that use it. A scatter or placed model with another model type loses the parameters that the
  // new type does not have.
  core::Result<void> set_value(const world::TextPath& path, std::string_view toml_value);
  core::Result<void> reset_value(const world::TextPath& path);
  // Resets all fields below `path` that have a default.
  core::Result<void> reset_section(const world::TextPath& path);
  core::Result<void> append_table(const world::TextPath& array, std::string_view table);
  core::Result<void> remove_table(const world::TextPath& path);
  // Moves an item of an array to another index.
  core::Result<void> move_table(const world::TextPath& item, std::size_t to);
  // Adds a copy behind the item; the copy of a species gets another name.
  core::Result<void> duplicate_table(const world::TextPath& item);
  // Changes the text by a function, such as world::with_snippet().
  core::Result<void> edit(const QString& step,
                          const std::function<core::Result<std::string>(std::string_view)>& change);
  // --- Proposed edits. The guard checks all edits except set_text(). An edit that needs
  // confirmation succeeds but takes no effect: it becomes the proposed edit, until it is applied or
  // discarded, or the text changes.

  void set_guard(EditGuard guard) { guard_ = std::move(guard); }
  // The question about the proposed edit; empty: there is none.
  const QString& confirmation() const { return confirmation_; }
  // Applies the proposed edit, if there is one.
  core::Result<void> apply_proposed_edit();
  void discard_proposed_edit() { propose_edit(std::nullopt, {}); }

  // --- Images of the world, such as masks. They are painted in memory; save() writes them as PNG
  // files before the text, each atomically. It fails with kIo, and with kInvalidArgument if another
  // program has replaced an image (save() again overwrites it).

  // The image that the world has under a name; null: none.
  PicturePtr picture(const std::string& name) const;
  // Replaces an image without an undo step, while a stroke is painted.
  core::Result<void> preview_picture(const std::string& name, const PicturePtr& picture);
  // Changes images and the text as one undo step. Fails like the edits.
  core::Result<void> paint(const QString& step, std::vector<PaintChange> changes, std::string text);
  // Unsaved images, for other readers of the text; null: none.
  const handmade::MemoryPicturesPtr& pictures() const { return pictures_; }

  // Edits between these two calls are one step: a drag, or several values at once. begin_drag()
  // returns the number of the drag. set_text() is always a step of its own.
  int begin_drag();
  void end_drag() { drag_ = 0; }
  // Restores the text of the start of the drag, or of the last set_text() during it. Leaves no undo
  // step. The drag continues.
  core::Result<void> cancel_drag();
  // Continues a drag: further edits extend its step, if that is the last one.
  void resume_drag(int drag) { drag_ = drag; }
  QUndoStack& undo_stack() { return undo_; }

  // --- Copies, presets and variations.

  // Copies a value or section as text, and pastes such a text into a section (text_snippet.hpp).
  core::Result<std::string> copy(const world::TextPath& path) const;
  core::Result<void> paste(const world::TextPath& path, std::string_view snippet);
  // Saves a section as a preset file, and applies such a file to a section.
  core::Result<void> save_preset(const world::TextPath& path,
                                 const std::filesystem::path& preset) const;
  core::Result<void> apply_preset(const world::TextPath& path, const std::filesystem::path& preset);
  // Sets random values in all unlocked fields below `path`, as one step. A field keeps its value if
  // several random values are invalid.
  core::Result<void> randomise(const world::TextPath& path, std::mt19937_64& random);
  // Moves the value of a field by some steps (variation.hpp).
  core::Result<void> step_value(const world::TextPath& path, int steps);
  // Fields that randomise() skips. Saved in the state folder with the document, and at its end.
  FieldLocks& locks() { return locks_; }

  // --- After a crash.

  // Recoveries of sessions that crashed, of all files, newest first.
  std::vector<Recovery> recoveries() const { return left_recoveries(options_.state_folder); }
  // Opens the file of a recovery with the recovered text as one undo step, and removes the
  // recovery. If the file cannot be opened, the text becomes a new world.
  core::Result<void> recover(const Recovery& recovery);
  // Writes the recovery file now. The document also writes it some seconds after each change.
  core::Result<void> write_recovery();

 Q_SIGNALS:
  // The text changed by an edit, undo, redo or another file.
  void changed(psygen::editor::Change what);
  void modified_changed(bool modified);
  void file_changed();
  // The proposed edit changed; an empty confirmation: there is none.
  void edit_proposed(const QString& confirmation);
  // Another program changed, removed or restored the file. `conflict`: the document has unsaved
  // changes too.
  void disk_changed(psygen::editor::DiskState state, bool conflict);
  // The recovery file cannot be written. Emitted once until writing works again.
  void autosave_failed(const QString& message);

 private:
  bool is_shipped(const std::filesystem::path& file) const;
  // Locks a file; returns the present session if it is the same file.
  core::Result<std::unique_ptr<RecoverySession>> session_of(const std::filesystem::path& file,
                                                            bool share);
  void set_document_text(const std::filesystem::path& file, std::string text, ParsedWorldPtr parsed,
                         std::unique_ptr<RecoverySession> session,
                         handmade::MemoryPicturesPtr pictures = {});
  // Watches the file on the disk, also for its replacement, removal and creation.
  void watch_disk();
  void note_saved(std::string text);
  void note_written();
  core::Result<void> require_known_disk() const;
  // With painted images, by default those of the document.
  core::Result<ParsedWorldPtr> parse(const std::string& text,
                                     const handmade::MemoryPicturesPtr& pictures) const;
  core::Result<ParsedWorldPtr> parse(const std::string& text) const {
    return parse(text, pictures_);
  }
  std::string name() const;  // for messages
  // An edit with a valid text.
  struct Edit {
    std::string text;
    QString step;
    std::optional<FieldLocks> locks;
    int drag = 0;
    std::vector<PaintChange> paint = {};
  };
  // Fails with the error of the text, or like parse().
  core::Result<void> push(core::Result<std::string> text, const QString& step,
                          std::optional<FieldLocks> locks = {}, bool guarded = true);
  void apply_edit(Edit edit, ParsedWorldPtr parsed);
  void propose_edit(std::optional<Edit> edit, const QString& confirmation);
  void show(const ShownText& shown);
  void note_modified();
  std::vector<std::string> unsaved_pictures() const;  // by name
  handmade::MemoryPicturesPtr with_picture(const std::string& name,
                                           const PicturePtr& picture) const;
  void note_on_disk(const std::string& name);
  void apply_paint(const std::vector<PaintChange>& changes, bool done);
  void end_preview();
  core::Result<void> require_known_pictures(const std::filesystem::path& file);
  core::Result<void> write_pictures(const std::filesystem::path& file) const;
  void note_pictures_written();
  core::Result<void> write_all(const std::filesystem::path& file);
  core::Result<std::vector<std::string>> copy_referenced_files(const std::filesystem::path& file,
                                                               FileCopies& copies);
  core::Result<void> require_free(const std::vector<std::filesystem::path>& taken);
  void autosave();
  void save_locks() const;

  DocumentOptions options_;
  std::filesystem::path file_;
  TextPtr text_;
  ParsedWorldPtr parsed_;
  ParsedWorldPtr next_parsed_;            // of the text that an edit is about to show
  std::string saved_;                     // text of the last read or save
  std::optional<std::string> seen_;       // text of the disk in the last signal; none: no file
  handmade::MemoryPicturesPtr pictures_;  // null: no painted images
  std::optional<handmade::MemoryPicturesPtr> before_preview_;  // set during a preview
  // Hashes of images at the last read or write of their files, by name.
  std::map<std::string, std::uint64_t> disk_pictures_;
  // State of the files that saving has refused to replace, by path.
  std::map<std::string, std::uint64_t> refused_files_;
  bool is_template_ = false;
  bool was_modified_ = false;
  bool autosave_has_failed_ = false;
  int drag_ = 0, last_drag_ = 0;
  TextPtr drag_text_;  // at the start of the last drag
  EditGuard guard_;
  std::optional<Edit> proposed_edit_;
  QString confirmation_;
  FieldLocks locks_, kept_locks_;  // kept_locks_: in the state folder
  QUndoStack undo_;
  QFileSystemWatcher watcher_;
  QTimer disk_timer_;  // other programs write a file in several steps
  QTimer autosave_timer_;
  std::unique_ptr<RecoverySession> session_;
  mutable std::optional<std::vector<world::WorldSection>> sections_;
};

}  // namespace psygen::editor
