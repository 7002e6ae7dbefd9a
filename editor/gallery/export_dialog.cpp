#include "editor/gallery/export_dialog.hpp"

#include <QApplication>
#include <QClipboard>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QPushButton>
#include <QRadioButton>
#include <QSettings>
#include <QSpinBox>
#include <QStandardPaths>
#include <QVBoxLayout>

#include "editor/document/qt_text.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

constexpr const char* kFolderKey = "export/folder";
constexpr int kMaxLevel = 6;

QString quoted(const QString& word) {
  return word.contains(' ') ? "'" + word + "'" : word;
}

// The parameters of a model as options --set.
QString settings_of(const models::ModelType& type, const models::Parameters& p) {
  QString text;
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const std::string value = specs[i].type == models::ParameterType::kReal
                                  ? world::toml_number(p.real(i))
                                  : std::to_string(p.integer(i));
    text += QString(" --set %1=%2").arg(to_qstring(specs[i].name), to_qstring(value));
  }
  return text;
}

// The command line that exports a block or a model from the saved file.
QString export_command(const std::filesystem::path& world_file, const PictureRequest& request,
                       const models::Registry& registry,
                       const std::optional<Selection>& selection) {
  QString line = "psygen export --world " + quoted(to_qstring(world_file.string()));
  if (request.kind == PictureKind::kExportModel && selection) {
    const models::ModelType& type = registry[selection->model];
    line += QString(" --model %1").arg(quoted(to_qstring(type.name()))) +
            settings_of(type, selection->parameters);
  } else {
    line += QString(" --block=%1,%2").arg(request.block_x).arg(request.block_z);
  }
  if (request.level > 0) line += QString(" --level %1").arg(request.level);
  return line + " --out " + quoted(to_qstring(request.out));
}

}  // namespace

std::optional<PictureRequest> ask_export(QWidget* parent, const Document& document,
                                         const std::optional<Selection>& selection,
                                         core::BlockCoord block) {
  const bool has_model = selection && selection->kind == query::HitKind::kModel;
  if (selection) block = selection->block;
  const ParsedWorldPtr parsed = document.parsed();
  QString name = "block";
  if (has_model) name = to_qstring(parsed->registry[selection->model].name());

  QDialog dialog(parent);
  dialog.setWindowTitle(tr("Export"));
  auto* model = new QRadioButton(has_model ? tr("Selected model: %1").arg(name)
                                           : tr("Selected model (none)"));
  auto* whole = new QRadioButton(tr("Block %1, %2 with all models").arg(block.x).arg(block.z));
  model->setEnabled(has_model);
  (has_model ? model : whole)->setChecked(true);
  auto* level = new QSpinBox;
  level->setRange(0, kMaxLevel);
  level->setSpecialValueText(tr("0, full"));
  QString folder =
      QSettings()
          .value(kFolderKey, QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation))
          .toString();
  if (!QDir(folder).exists()) folder = QDir::homePath();
  auto* file = new QLineEdit(folder + "/" + name + ".glb");
  auto* browse = new QPushButton(tr("…"));
  auto* command = new QLineEdit;
  command->setReadOnly(true);
  auto* copy = new QPushButton(tr("Copy"));
  const auto line_of = [](QLineEdit* edit, QPushButton* button) {
    auto* line = new QHBoxLayout;
    line->addWidget(edit, 1);
    line->addWidget(button);
    return line;
  };
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Cancel);
  auto* form = new QFormLayout;
  form->addRow(tr("Object"), model);
  form->addRow(QString(), whole);
  form->addRow(tr("Level of detail"), level);
  form->addRow(tr("File"), line_of(file, browse));
  form->addRow(tr("Command"), line_of(command, copy));
  auto* layout = new QVBoxLayout(&dialog);
  layout->addLayout(form);
  layout->addWidget(buttons);
  dialog.resize(560, 0);

  const auto make_request = [&] {
    PictureRequest request;
    request.kind = model->isChecked() ? PictureKind::kExportModel : PictureKind::kExportBlock;
    request.text = document.text();
    request.file = document.file().string();
    request.out = file->text().toStdString();
    request.block_x = block.x;
    request.block_z = block.z;
    request.index = has_model ? selection->index : 0;
    request.level = level->value();
    return request;
  };
  const auto update = [&] {
    command->setText(export_command(document.file(), make_request(), parsed->registry, selection));
    command->setCursorPosition(0);
    command->setToolTip(document.is_modified()
                            ? tr("The command exports the saved file, without unsaved changes.")
                            : QString());
    const bool known = file->text().endsWith(".glb") || file->text().endsWith(".obj");
    buttons->button(QDialogButtonBox::Save)->setEnabled(known);
    file->setToolTip(known ? QString() : tr("The name must end in .glb or .obj."));
  };
  QObject::connect(model, &QRadioButton::toggled, &dialog, update);
  QObject::connect(level, &QSpinBox::valueChanged, &dialog, update);
  QObject::connect(file, &QLineEdit::textChanged, &dialog, update);
  QObject::connect(copy, &QPushButton::clicked, &dialog,
                   [&] { QApplication::clipboard()->setText(command->text()); });
  QObject::connect(browse, &QPushButton::clicked, &dialog, [&] {
    const QString chosen = QFileDialog::getSaveFileName(
        &dialog, tr("Export as"), file->text(), tr("Binary glTF (*.glb);;Wavefront OBJ (*.obj)"));
    if (!chosen.isEmpty()) file->setText(chosen);
  });
  QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  update();
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  QSettings().setValue(kFolderKey, QFileInfo(file->text()).absolutePath());
  return make_request();
}

}  // namespace psygen::editor
