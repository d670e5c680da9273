#ifndef __qSlicerFenestraPreviewLabel_h
#define __qSlicerFenestraPreviewLabel_h

#include <QLabel>

/// Shows an image as wide as the panel, but not higher than wide; or a text.
class qSlicerFenestraPreviewLabel : public QLabel {
public:
  explicit qSlicerFenestraPreviewLabel(QWidget* parent = nullptr);

  QSize minimumSizeHint() const override;
  int heightForWidth(int width) const override;

protected:
  void paintEvent(QPaintEvent* event) override;
};

#endif
