#include "qSlicerFenestraPreviewLabel.h"

#include <QPainter>

qSlicerFenestraPreviewLabel::qSlicerFenestraPreviewLabel(QWidget* parent) : QLabel(parent) {
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Expanding);
}

void qSlicerFenestraPreviewLabel::showImage(const QImage& image) {
  setPixmap(QPixmap::fromImage(image));
  limitHeight();
}

void qSlicerFenestraPreviewLabel::showText(const QString& text) {
  setText(text);
  limitHeight();
}

QSize qSlicerFenestraPreviewLabel::sizeHint() const {
  constexpr int least = 180; // pixels
  const bool hasImage = !pixmap(Qt::ReturnByValue).isNull();
  return {1, hasImage ? qMin(least, maximumHeight()) : QLabel::sizeHint().height()};
}

/// Leaves no empty space above and below the image.
void qSlicerFenestraPreviewLabel::limitHeight() {
  const QSize image = pixmap(Qt::ReturnByValue).size();
  setMaximumHeight(image.isEmpty() ? QLabel::sizeHint().height()
                                   : qMin(width(), width() * image.height() / image.width()));
}

void qSlicerFenestraPreviewLabel::resizeEvent(QResizeEvent* event) {
  QLabel::resizeEvent(event);
  limitHeight();
}

void qSlicerFenestraPreviewLabel::paintEvent(QPaintEvent* event) {
  const QPixmap image = pixmap(Qt::ReturnByValue);
  if (image.isNull())
    return QLabel::paintEvent(event);
  QRect area({}, image.size().scaled(size(), Qt::KeepAspectRatio));
  area.moveCenter(rect().center());
  QPainter painter(this);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawPixmap(area, image);
}
