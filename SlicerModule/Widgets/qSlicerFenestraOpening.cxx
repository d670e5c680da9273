#include "qSlicerFenestraOpening.h"

#include "qSlicerFenestraWidgets.h"
#include "vtkMRMLFenestraOpeningNode.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <vtkCommand.h>

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

qSlicerFenestraOpening::qSlicerFenestraOpening(QWidget* parent)
    : QWidget(parent),
      m_button(new QPushButton(tr("&Open the view"), this)),
      m_image(new QPushButton(tr("&Photorealistic"), this)),
      m_state(new QLabel(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  auto* row = new QHBoxLayout;
  row->addWidget(m_button);
  row->addWidget(m_image);
  column->addLayout(row);
  column->addWidget(m_state);
  m_button->setObjectName("OpenButton");
  m_button->setCheckable(true);
  m_button->setToolTip(
      tr("Cuts the volume rendering in the 3D views in front of the focus, as in an image, at "
         "every turn. Models, markups and segments in front are not cut, and "
         "a click meets the removed tissue. Needs GPU ray casting."));
  m_image->setObjectName("PhotorealisticButton");
  m_image->setCheckable(true);
  m_image->setToolTip(
      tr("Shows a path-traced image in the 3D view while its camera rests. It is refined until its "
         "noise is low. Models and markups are drawn with it, each at its depth."));
  m_state->setObjectName("OpeningStateLabel");
  m_state->setTextFormat(Qt::PlainText);
  m_state->setWordWrap(true);
  connect(m_button, &QPushButton::clicked, this, &qSlicerFenestraOpening::onClicked);
  connect(m_image, &QPushButton::clicked, this, [this](bool isShown) {
    if (isShown)
      m_logic->ShowPhotorealistic(m_settings);
    else
      m_logic->HidePhotorealistic();
  });
}

void qSlicerFenestraOpening::setLogic(vtkSlicerFenestraLogic* logic) {
  m_logic = logic;
  qvtkConnect(logic, vtkSlicerFenestraLogic::OpeningChangedEvent, this, SLOT(onOpeningChanged()));
  onOpeningChanged();
}

void qSlicerFenestraOpening::use(vtkMRMLFenestraRenderNode* settings) {
  m_settings = settings;
  updateWidgetFromMRML();
}

void qSlicerFenestraOpening::onOpeningChanged() {
  vtkMRMLFenestraOpeningNode* opening = m_logic->GetOpening();
  qvtkReconnect(m_opening, opening, vtkCommand::ModifiedEvent, this, SLOT(updateWidgetFromMRML()));
  m_opening = opening;
  updateWidgetFromMRML();
}

void qSlicerFenestraOpening::onClicked(bool isOpen) {
  if (isOpen)
    m_logic->OpenView(m_settings);
  else
    m_logic->CloseView();
}

void qSlicerFenestraOpening::updateWidgetFromMRML() {
  const bool isVisible = m_opening && m_opening->GetVisible();
  m_button->setChecked(isVisible);
  qSlicerFenestraWidgets::setEnabled(m_button,
                                     isVisible || vtkSlicerFenestraLogic::CanOpenView(m_settings),
                                     tr("Choose a volume and a focus first"));
  const bool hasImage = m_opening && m_opening->GetPhotorealistic();
  m_image->setChecked(hasImage);
  qSlicerFenestraWidgets::setEnabled(
      m_image, hasImage || vtkSlicerFenestraLogic::CanShowPhotorealistic(m_settings),
      tr("Choose a volume first"));
  QString state;
  if (isVisible && !m_opening->GetProblem().empty())
    state = QString::fromStdString(m_opening->GetProblem());
  else if (isVisible && m_opening->GetPreparing())
    state = tr("Preparing the focus...");
  m_state->setText(state);
  m_state->setVisible(!state.isEmpty());
}
