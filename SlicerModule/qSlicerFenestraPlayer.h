#ifndef __qSlicerFenestraPlayer_h
#define __qSlicerFenestraPlayer_h

#include <QTimer>
#include <QWidget>

class QLabel;
class QSlider;
class QSpinBox;
class QToolButton;

/// Goes through frames, one after the other and around.
class qSlicerFenestraPlayer : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraPlayer(QWidget* parent = nullptr);

  /// Of another animation, or one that has grown; it stands still then.
  void setFrames(int count);
  int frame() const;

signals:
  /// From 0.
  void frameChanged(int frame);

private:
  void play(bool running);
  void step();

  QToolButton* m_play;
  QSlider* m_slider;
  QSpinBox* m_speed;
  QLabel* m_where;
  QTimer m_timer;
};

#endif
