// One small picture with a caption, which can be clicked: waiting, drawn, or failed with a
// sentence. Main thread.
#pragma once

#include <QImage>
#include <QWidget>

namespace psygen::editor {

class PictureCell final : public QWidget {
  Q_OBJECT

 public:
  explicit PictureCell(QWidget* parent = nullptr);

  // What is under the picture: the value, and what it costs.
  void set_caption(const QString& value, const QString& cost);
  void set_image(const QImage& image);
  void set_failure(const QString& sentence);
  // A frame: this is how the world is now.
  void set_present(bool present);
  const QImage& image() const { return image_; }
  // Of the place for a picture.
  QSize picture_size() const { return picture_area().size(); }
  QSize sizeHint() const override { return {192, 150}; }
  QSize minimumSizeHint() const override { return {96, 84}; }

 Q_SIGNALS:
  void clicked();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void enterEvent(QEnterEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  QRect picture_area() const;

  QImage image_;
  QString value_, cost_, failure_;
  bool present_ = false, hovered_ = false;
};

}  // namespace psygen::editor
