// One small image with a caption, which the user can click. Shows a placeholder, the image or an
// error. Main thread.
#pragma once

#include <QImage>
#include <QWidget>

namespace psygen::editor {

// The image keeps its aspect ratio.
class PictureCell final : public QWidget {
  Q_OBJECT

 public:
  // Empty at first.
  explicit PictureCell(QWidget* parent = nullptr);

  // The caption below the image: the value and its cost.
  void set_caption(const QString& value, const QString& cost);
  void set_image(const QImage& image);
  void set_error(const QString& error);
  // Highlights the cell with the values of the present world.
  void set_present(bool present);
  const QImage& image() const { return image_; }
  // Size of the image area.
  QSize picture_size() const { return picture_area().size(); }
  QSize sizeHint() const override { return {192, 150}; }
  QSize minimumSizeHint() const override { return {96, 84}; }

 Q_SIGNALS:
  // The user clicked the cell, or pressed Return or Space.
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
  QString value_, cost_, error_;
  bool present_ = false, hovered_ = false;
};

}  // namespace psygen::editor
