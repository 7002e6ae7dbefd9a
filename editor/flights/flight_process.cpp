#include "editor/flights/flight_process.hpp"

#include <sys/resource.h>

#include <QCoreApplication>
#include <QFileInfo>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

constexpr int kLowestPriority = 19, kEndMs = 2000;

}  // namespace

QString psygen_program() {
  const QString beside = QCoreApplication::applicationDirPath() + "/psygen";
  return QFileInfo(beside).isExecutable() ? beside : "psygen";
}

FlightProcess::FlightProcess(QObject* parent) : QObject(parent) {
  process_.setChildProcessModifier([] { ::setpriority(PRIO_PROCESS, 0, kLowestPriority); });
  process_.setStandardOutputFile(QProcess::nullDevice());
  connect(&process_, &QProcess::finished, this, &FlightProcess::finish);
  connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error == QProcess::FailedToStart)
      Q_EMIT failed(tr("%1 cannot be started: %2").arg(process_.program(), process_.errorString()));
  });
}

FlightProcess::~FlightProcess() {
  process_.disconnect(this);
  if (!is_flying()) return;
  process_.terminate();
  if (!process_.waitForFinished(kEndMs)) process_.kill();
  process_.waitForFinished(kEndMs);
}

void FlightProcess::fly(const FlightSettings& settings, const std::filesystem::path& world,
                        const std::filesystem::path& path, const std::filesystem::path& out) {
  if (is_flying()) return;
  settings_ = settings;
  out_ = out;
  cancelled_ = false;
  process_.start(psygen_program(), flight_arguments(settings, world, path, out));
}

void FlightProcess::cancel() {
  cancelled_ = is_flying();
  process_.terminate();
}

void FlightProcess::finish(int code, QProcess::ExitStatus status) {
  if (cancelled_) return Q_EMIT failed(tr("The flight was cancelled."));
  if (status != QProcess::NormalExit || code != 0) {
    const QStringList lines =
        QString::fromUtf8(process_.readAllStandardError()).split('\n', Qt::SkipEmptyParts);
    return Q_EMIT failed(
        tr("The flight failed: %1").arg(lines.isEmpty() ? QString::number(code) : lines.last()));
  }
  process_.readAllStandardError();
  const auto run = read_flight_run(out_, settings_);
  if (!run) return Q_EMIT failed(to_qstring(run.error().message));
  Q_EMIT flown(*run);
}

}  // namespace psygen::editor
