#ifndef __qSlicerFenestraPreviewLabel_h
#define __qSlicerFenestraPreviewLabel_h

#include <QLabel>

/// Shows an image as wide as the panel, but not higher than wide, and smaller where the rest of the
/// panel needs the height; or a text.
class qSlicerFenestraPreviewLabel : public QLabel {
public:
  explicit qSlicerFenestraPreviewLabel(QWidget* parent = nullptr);

  void showImage(const QImage& image);
  void showText(const QString& text);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

private:
  void limitHeight();
};

#endif
