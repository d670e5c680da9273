#include "qSlicerFenestraPreviewLabel.h"

#include <QPainter>

qSlicerFenestraPreviewLabel::qSlicerFenestraPreviewLabel(QWidget* parent) : QLabel(parent) {
  setWordWrap(true); // the height depends on the width
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
}

QSize qSlicerFenestraPreviewLabel::minimumSizeHint() const {
  return {1, 1};
}

int qSlicerFenestraPreviewLabel::heightForWidth(int width) const {
  const QSize image = pixmap(Qt::ReturnByValue).size();
  return image.isEmpty() ? QLabel::heightForWidth(width)
                         : qMin(width, width * image.height() / image.width());
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
