#ifndef __qSlicerFenestraPlayer_h
#define __qSlicerFenestraPlayer_h

#include <QTimer>
#include <QWidget>

class QLabel;
class QSlider;
class QSpinBox;
class QToolButton;

/// Plays frames in a loop.
class qSlicerFenestraPlayer : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraPlayer(QWidget* parent = nullptr);

  /// Sets the number of frames, of another animation or of the same one with more frames. Stops
  /// playback.
  void setFrames(int count);
  int frame() const;

signals:
  /// `frame`: index from 0.
  void frameChanged(int frame);

private:
  void play(bool running);
  void step();

  QToolButton* m_play;
  QSlider* m_slider;
  QSpinBox* m_speed;
  QLabel* m_position;
  QTimer m_timer;
};

#endif
