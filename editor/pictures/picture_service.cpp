#include "editor/pictures/picture_service.hpp"

#include <unistd.h>

#include <QFile>
#include <algorithm>

#include "editor/document/paint_change.hpp"
#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

constexpr const char* kChild = "PSYGEN_EDITOR_PICTURES";  // environment variable of the process

constexpr int kPatienceMs = 1000;
constexpr int kExportTimes = 10;  // limit of an export, in limits of an image
constexpr int kMaxOverdue = 10;   // limits until a sleeping process is ended too
constexpr int kEndMs = 200;       // for a normal exit

// Processor time of all threads of a process.
double processor_ms(qint64 process) {
  QFile file(QString("/proc/%1/stat").arg(process));
  if (process <= 0 || !file.open(QIODevice::ReadOnly)) return 0;
  const QByteArray stat = file.readAll();
  // After the name, which may contain anything: fields 14 and 15 of proc(5).
  const QList<QByteArray> fields = stat.mid(stat.lastIndexOf(')') + 2).split(' ');
  if (fields.size() < 13) return 0;
  return (fields[11].toDouble() + fields[12].toDouble()) * 1000 /
         static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace

PictureService::PictureService(QString program, QStringList arguments, QObject* parent,
                               int limit_ms)
    : QObject(parent),
      program_(std::move(program)),
      arguments_(std::move(arguments)),
      limit_ms_(limit_ms) {
  limit_.setSingleShot(true);
  patience_.setSingleShot(true);
  connect(&limit_, &QTimer::timeout, this, [this] {
    if (!process_) return;
    // On a busy machine the process gets little processor time, which is no fault.
    const double worked_ms = processor_ms(process_->processId()) - worked_before_ms_;
    if (++overdue_ < kMaxOverdue && worked_ms < limit_ms_) return limit_.start(limit_ms_);
    process_->kill();  // ended() follows
  });
  connect(&patience_, &QTimer::timeout, this, &PictureService::send_next);
}

PictureService::~PictureService() {
  if (!process_) return;
  process_->disconnect(this);
  process_->closeWriteChannel();
  if (!process_->waitForFinished(kEndMs)) {
    process_->kill();
    process_->waitForFinished(kEndMs);
  }
}

bool PictureService::is_picture(const PictureRequest& request) {
  return request.kind == PictureKind::kPicture || request.kind == PictureKind::kPortrait;
}

// Writes unsaved images to temporary files, which the service keeps until its end.
void PictureService::attach_pictures(PictureRequest& request) {
  const handmade::MemoryPicturesPtr pictures = ask_pictures_ ? ask_pictures_() : nullptr;
  if (!pictures) return;
  for (const auto& [name, picture] : pictures->in_place) {
    const QString file =
        folder_.filePath(QString("painted_%1.png").arg(picture->hash, 16, 16, QChar('0')));
    if (QFile::exists(file) || write_picture_file(file.toStdString(), *picture))
      request.pictures[name] = file.toStdString();
  }
}

void PictureService::ask(PictureRequest request, int batch, double rank, QObject* owner,
                         Done done) {
  attach_pictures(request);
  request.id = ++last_id_;
  if (request.out.empty() && is_picture(request))
    request.out = folder_.filePath(QString("%1.png").arg(request.id)).toStdString();
  queue_.push_back({std::move(request), batch, rank, owner, std::move(done)});
  QMetaObject::invokeMethod(this, &PictureService::send_next, Qt::QueuedConnection);
}

void PictureService::cancel(const QObject* owner) {
  std::erase_if(queue_, [&](const Job& job) { return job.owner == owner || !job.owner; });
  if (current_ && current_->owner == owner) current_->cancelled = true;
}

void PictureService::set_busy(bool busy) {
  if (std::exchange(busy_, busy) == busy) return;
  if (!busy) {
    patience_.stop();
    send_next();
  }
}

void PictureService::send_next() {
  std::erase_if(queue_, [](const Job& job) { return !job.owner; });
  if (queue_.empty()) return;
  // One at a time, but the process drops a cancelled image for the next request.
  const bool replaces = current_ && current_->cancelled && is_picture(current_->request);
  if (current_ && !replaces) return;
  const auto next = std::ranges::min_element(queue_, [](const Job& a, const Job& b) {
    const bool drawn_a = is_picture(a.request), drawn_b = is_picture(b.request);
    if (drawn_a != drawn_b) return drawn_b;
    if (a.batch != b.batch) return a.batch > b.batch;
    return a.rank < b.rank;
  });
  if (busy_ && is_picture(next->request)) {
    if (patience_.isActive()) return;
    if (std::exchange(patient_, !patient_)) return patience_.start(kPatienceMs);
  }
  if (!process_) start();
  if (!process_) return;
  current_ = std::move(*next);
  queue_.erase(next);
  process_->write(to_line(current_->request));
  ++unanswered_;
  overdue_ = 0;
  worked_before_ms_ = processor_ms(process_->processId());
  const bool exports = current_->request.kind == PictureKind::kExportModel ||
                       current_->request.kind == PictureKind::kExportBlock;
  limit_.start(exports ? limit_ms_ * kExportTimes : limit_ms_);
}

void PictureService::start() {
  // Prevents a program without the option from starting itself recursively.
  if (qEnvironmentVariableIsSet(kChild)) return;
  process_ = std::make_unique<QProcess>();
  process_->setProcessChannelMode(QProcess::SeparateChannels);
  process_->setStandardErrorFile(QProcess::nullDevice());
  connect(process_.get(), &QProcess::readyReadStandardOutput, this, &PictureService::read);
  connect(process_.get(), &QProcess::finished, this, &PictureService::ended, Qt::QueuedConnection);
  connect(
      process_.get(), &QProcess::errorOccurred, this,
      [this](QProcess::ProcessError error) {
        if (error == QProcess::FailedToStart) ended();
      },
      Qt::QueuedConnection);
  input_.clear();
  QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
  environment.insert(kChild, "1");
  process_->setProcessEnvironment(environment);
  process_->start(program_, arguments_);
}

void PictureService::read() {
  input_ += process_->readAllStandardOutput();
  while (true) {
    const qsizetype end = input_.indexOf('\n');
    if (end < 0) return;
    auto reply = reply_from(input_.left(end));
    input_.remove(0, end + 1);
    if (!reply) continue;
    --unanswered_;
    take(*std::move(reply));
  }
}

void PictureService::take(PictureReply reply) {
  // Ignores replies to replaced requests.
  if (!current_ || current_->request.id != reply.id) return;
  Job job = std::move(*current_);
  current_.reset();
  limit_.stop();
  if (is_picture(job.request)) {
    const QString file = to_qstring(job.request.out);
    if (reply.error.empty() && !reply.dropped && !job.cancelled) reply.image.load(file);
    if (file.startsWith(folder_.path())) QFile::remove(file);
  }
  if (!job.cancelled && job.owner && !reply.dropped) job.done(reply);
  send_next();
}

void PictureService::ended() {
  if (!process_) return;
  read();  // replies from before the end
  const bool killed = !limit_.isActive() && current_.has_value();
  const bool started = process_->error() != QProcess::FailedToStart;
  const QString how = process_->exitStatus() == QProcess::CrashExit
                          ? tr("signal %1").arg(process_->exitCode())
                          : tr("exit code %1").arg(process_->exitCode());
  process_->disconnect(this);
  process_.release()->deleteLater();
  if (started) ++restarts_;
  // The replaced request may have crashed it, so the present one is queued again.
  if (current_ && unanswered_ > 1) queue_.push_back(*std::exchange(current_, std::nullopt));
  unanswered_ = 0;
  limit_.stop();
  if (!current_) return send_next();
  const QString error = !started ? tr("the rendering process cannot be started")
                        : killed ? tr("rendering took more than %1 s").arg(limit_ms_ / 1000)
                                 : tr("the rendering process crashed (%1)").arg(how);
  PictureReply reply;
  reply.id = current_->request.id;
  reply.error = error.toStdString();
  take(std::move(reply));
}

}  // namespace psygen::editor
