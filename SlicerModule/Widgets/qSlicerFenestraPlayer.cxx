#include "qSlicerFenestraPlayer.h"

#include "ui_qSlicerFenestraPlayer.h"

#include <QStyle>
#include <QTimer>

#include <algorithm>

class qSlicerFenestraPlayerPrivate : public Ui_qSlicerFenestraPlayer {
public:
  void play(bool running);
  void step();

  QTimer timer;
};

void qSlicerFenestraPlayerPrivate::play(bool running) {
  PlayButton->setIcon(
      PlayButton->style()->standardIcon(running ? QStyle::SP_MediaPause : QStyle::SP_MediaPlay));
  if (running)
    timer.start(1000 / SpeedBox->value());
  else
    timer.stop();
}

void qSlicerFenestraPlayerPrivate::step() {
  const int frame = FrameSlider->value();
  FrameSlider->setValue(frame == FrameSlider->maximum() ? 0 : frame + 1);
  timer.start(1000 / SpeedBox->value());
}

qSlicerFenestraPlayer::qSlicerFenestraPlayer(QWidget* parent)
    : QWidget(parent), d_ptr(new qSlicerFenestraPlayerPrivate) {
  Q_D(qSlicerFenestraPlayer);
  d->setupUi(this);
  // The timer restarts after each frame is drawn, so that a slow display is not overloaded.
  d->timer.setSingleShot(true);
  connect(&d->timer, &QTimer::timeout, this, [d] { d->step(); });
  connect(d->PlayButton, &QToolButton::toggled, this, [d](bool running) { d->play(running); });
  connect(d->FrameSlider, &QSlider::valueChanged, this, [this, d](int frame) {
    d->FrameLabel->setText(tr("%1 of %2").arg(frame + 1).arg(d->FrameSlider->maximum() + 1));
    emit frameChanged(frame);
  });
  d->play(false);
}

qSlicerFenestraPlayer::~qSlicerFenestraPlayer() = default;

void qSlicerFenestraPlayer::setFrames(int count) {
  Q_D(qSlicerFenestraPlayer);
  d->PlayButton->setChecked(false);
  d->FrameSlider->setRange(0, std::max(0, count - 1));
  d->FrameLabel->setText(tr("%1 of %2").arg(frame() + 1).arg(count));
}

int qSlicerFenestraPlayer::frame() const {
  Q_D(const qSlicerFenestraPlayer);
  return d->FrameSlider->value();
}
