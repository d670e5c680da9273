#include "qSlicerFenestraPlayer.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QSlider>
#include <QSpinBox>
#include <QStyle>
#include <QToolButton>

#include <algorithm>

qSlicerFenestraPlayer::qSlicerFenestraPlayer(QWidget* parent) : QWidget(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  m_play = new QToolButton;
  m_play->setObjectName("PlayButton");
  m_play->setCheckable(true);
  m_play->setToolTip(tr("Plays the frames in a loop"));
  m_slider = new QSlider(Qt::Horizontal);
  m_slider->setObjectName("FrameSlider");
  m_slider->setToolTip(tr("Current frame"));
  m_position = new QLabel;
  m_position->setObjectName("FrameLabel");
  m_speed = new QSpinBox;
  m_speed->setObjectName("SpeedBox");
  m_speed->setRange(1, 60);
  m_speed->setValue(12);
  m_speed->setSuffix(tr(" / s"));
  m_speed->setToolTip(tr("Frames per second"));
  row->addWidget(m_play);
  row->addWidget(m_slider, 1);
  row->addWidget(m_position);
  row->addWidget(m_speed);
  // The timer restarts after each frame is drawn, so that a slow display is not overloaded.
  m_timer.setSingleShot(true);
  connect(&m_timer, &QTimer::timeout, this, &qSlicerFenestraPlayer::step);
  connect(m_play, &QToolButton::toggled, this, &qSlicerFenestraPlayer::play);
  connect(m_slider, &QSlider::valueChanged, this, [this](int frame) {
    m_position->setText(tr("%1 of %2").arg(frame + 1).arg(m_slider->maximum() + 1));
    emit frameChanged(frame);
  });
  play(false);
}

void qSlicerFenestraPlayer::setFrames(int count) {
  m_play->setChecked(false);
  m_slider->setRange(0, std::max(0, count - 1));
  m_position->setText(tr("%1 of %2").arg(frame() + 1).arg(count));
}

int qSlicerFenestraPlayer::frame() const {
  return m_slider->value();
}

void qSlicerFenestraPlayer::play(bool running) {
  m_play->setIcon(style()->standardIcon(running ? QStyle::SP_MediaPause : QStyle::SP_MediaPlay));
  if (running)
    m_timer.start(1000 / m_speed->value());
  else
    m_timer.stop();
}

void qSlicerFenestraPlayer::step() {
  m_slider->setValue(frame() == m_slider->maximum() ? 0 : frame() + 1);
  m_timer.start(1000 / m_speed->value());
}
