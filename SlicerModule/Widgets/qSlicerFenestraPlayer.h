#ifndef __qSlicerFenestraPlayer_h
#define __qSlicerFenestraPlayer_h

#include <QScopedPointer>
#include <QWidget>

class qSlicerFenestraPlayerPrivate;

/// Plays frames in a loop.
class qSlicerFenestraPlayer : public QWidget {
  Q_OBJECT

public:
  explicit qSlicerFenestraPlayer(QWidget* parent = nullptr);
  ~qSlicerFenestraPlayer() override;

  /// Sets the number of frames, of another animation or of the same one with more frames. Stops
  /// playback.
  void setFrames(int count);
  int frame() const;

signals:
  /// `frame`: index from 0.
  void frameChanged(int frame);

protected:
  QScopedPointer<qSlicerFenestraPlayerPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraPlayer)
  Q_DISABLE_COPY(qSlicerFenestraPlayer)
};

#endif
