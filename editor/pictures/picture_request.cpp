#include "editor/pictures/picture_request.hpp"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <algorithm>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

constexpr int kMaxPixels = 8192;  // per side
constexpr int kKinds = static_cast<int>(PictureKind::kExportBlock) + 1;

QByteArray json_line(const QJsonObject& object) {
  return QJsonDocument(object).toJson(QJsonDocument::Compact) + '\n';
}

std::optional<QJsonObject> object_from(const QByteArray& line) {
  const QJsonDocument document = QJsonDocument::fromJson(line);
  if (!document.isObject() || !document.object().contains("id")) return std::nullopt;
  return document.object();
}

std::uint64_t id_of(const QJsonObject& object) {
  return static_cast<std::uint64_t>(std::max<qint64>(object["id"].toInteger(), 0));
}

}  // namespace

QByteArray to_line(const PictureRequest& r) {
  QJsonObject o{{"id", static_cast<qint64>(r.id)},
                {"kind", static_cast<int>(r.kind)},
                {"text", to_qstring(r.text)},
                {"file", to_qstring(r.file)},
                {"out", to_qstring(r.out)},
                {"width", static_cast<qint64>(r.size.width)},
                {"height", static_cast<qint64>(r.size.height)},
                {"now_s", r.now_s},
                {"distance_m", r.distance_m},
                {"block", QJsonArray{r.block_x, r.block_z}},
                {"index", static_cast<qint64>(r.index)},
                {"level", r.level}};
  if (r.place) {
    const PicturePlace& p = *r.place;
    o["place"] = QJsonObject{{"at_m", QJsonArray{p.at_m.x, p.at_m.y, p.at_m.z}},
                             {"yaw", p.yaw},
                             {"pitch", p.pitch},
                             {"above_ground", p.above_ground}};
  }
  QJsonObject pictures;
  for (const auto& [name, file] : r.pictures)
    pictures[to_qstring(name)] = to_qstring(file);
  if (!pictures.isEmpty()) o["pictures"] = pictures;
  return json_line(o);
}

std::optional<PictureRequest> request_from(const QByteArray& line) {
  const auto o = object_from(line);
  if (!o) return std::nullopt;
  PictureRequest r;
  r.id = id_of(*o);
  const int kind = (*o)["kind"].toInt(-1);
  if (kind < 0 || kind >= kKinds) return std::nullopt;
  r.kind = static_cast<PictureKind>(kind);
  r.text = (*o)["text"].toString().toStdString();
  r.file = (*o)["file"].toString().toStdString();
  r.out = (*o)["out"].toString().toStdString();
  r.size = {static_cast<std::uint32_t>(std::clamp((*o)["width"].toInt(), 1, kMaxPixels)),
            static_cast<std::uint32_t>(std::clamp((*o)["height"].toInt(), 1, kMaxPixels))};
  r.now_s = (*o)["now_s"].toDouble();
  r.distance_m = (*o)["distance_m"].toDouble();
  r.block_x = (*o)["block"].toArray().at(0).toInt();
  r.block_z = (*o)["block"].toArray().at(1).toInt();
  r.index = static_cast<std::uint32_t>((*o)["index"].toInteger());
  r.level = std::clamp((*o)["level"].toInt(), 0, 31);
  const QJsonObject pictures = (*o)["pictures"].toObject();
  for (auto it = pictures.begin(); it != pictures.end(); ++it)
    r.pictures[it.key().toStdString()] = it.value().toString().toStdString();
  if (const QJsonObject p = (*o)["place"].toObject(); !p.isEmpty()) {
    const QJsonArray at = p["at_m"].toArray();
    r.place = PicturePlace{.at_m = {at.at(0).toDouble(), at.at(1).toDouble(), at.at(2).toDouble()},
                           .yaw = p["yaw"].toDouble(),
                           .pitch = p["pitch"].toDouble(),
                           .above_ground = p["above_ground"].toBool()};
  }
  return r;
}

QByteArray to_line(const PictureReply& r) {
  QJsonObject o{{"id", static_cast<qint64>(r.id)}};
  if (!r.error.empty()) o["error"] = to_qstring(r.error);
  if (r.dropped) o["dropped"] = true;
  if (r.distance_m > 0) o["distance_m"] = r.distance_m;
  if (!r.note.empty()) o["note"] = to_qstring(r.note);
  if (r.cost) {
    o["cost"] = QJsonObject{{"models", r.cost->models},
                            {"triangles", r.cost->triangles},
                            {"bytes", r.cost->bytes},
                            {"seconds", r.cost->seconds}};
  }
  return json_line(o);
}

std::optional<PictureReply> reply_from(const QByteArray& line) {
  const auto o = object_from(line);
  if (!o) return std::nullopt;
  PictureReply r;
  r.id = id_of(*o);
  r.error = (*o)["error"].toString().toStdString();
  r.dropped = (*o)["dropped"].toBool();
  r.distance_m = (*o)["distance_m"].toDouble();
  r.note = (*o)["note"].toString().toStdString();
  if (const QJsonObject c = (*o)["cost"].toObject(); !c.isEmpty()) {
    r.cost = BlockCost{.models = c["models"].toDouble(),
                       .triangles = c["triangles"].toDouble(),
                       .bytes = c["bytes"].toDouble(),
                       .seconds = c["seconds"].toDouble()};
  }
  return r;
}

}  // namespace psygen::editor
