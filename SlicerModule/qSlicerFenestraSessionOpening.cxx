// The session's opened view: makes the triangles of the focus, again after every change.

#include "qSlicerFenestraSession.h"

#include "FenestraFlags.h"
#include "vtkMRMLFenestraOpeningNode.h"

#include <vtkMRMLDisplayableNode.h>
#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>

#include <vtkCellArray.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkXMLPolyDataReader.h>

#include <QDebug>
#include <QFileInfo>

#include <sstream>

namespace {

using Node = vtkMRMLFenestraRenderNode;
using Opening = vtkMRMLFenestraOpeningNode;

/// Flags of the settings on which the focus depends.
std::map<std::string, std::string> takeFocusFlags(Node* settings) {
  std::map<std::string, std::string> flags;
  for (const char* name : {"focus", "preset", "margin", "labelsmoothing"})
    if (const std::string value = settings->GetFlag(name); !value.empty())
      flags[name] = value;
  return flags;
}

/// Key of everything on which the triangles depend.
std::string makeFocusKey(const SlicerExport::Contents& contents,
                         const std::map<std::string, std::string>& flags) {
  std::ostringstream text;
  text.precision(17);
  text << contents.volumeKey << '\n' << contents.segmentationKey << '\n';
  for (const SlicerExport::Matrix& matrix : {contents.volumeToWorld, contents.segmentation.toWorld})
    for (const double element : matrix)
      text << element << ' ';
  for (const auto& [name, value] : flags)
    text << '\n' << name << '=' << value;
  return text.str();
}

/// Corners of the volume's box, which reaches half a voxel beyond the outermost centers, RAS mm.
fenestra::core::BoxCorners findCorners(const SlicerExport::Contents& contents) {
  const auto transform = [](const SlicerExport::Matrix& matrix, const std::array<double, 3>& at) {
    std::array<double, 3> result;
    for (std::size_t row = 0; row < 3; ++row)
      result[row] = matrix[4 * row] * at[0] + matrix[4 * row + 1] * at[1] +
                    matrix[4 * row + 2] * at[2] + matrix[4 * row + 3];
    return result;
  };
  fenestra::core::BoxCorners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    std::array<double, 3> index;
    for (std::size_t axis = 0; axis < 3; ++axis)
      index[axis] =
          (i >> axis & 1U) == 0 ? -0.5 : static_cast<double>(contents.volume.size[axis]) - 0.5;
    corners[i] = transform(contents.volumeToWorld, transform(contents.volume.ijkToRas, index));
  }
  return corners;
}

/// Reads the triangles of the focus, and makes them fewer where they are too many to be drawn for
/// every camera.
Opening::Focus readTriangles(const QString& file) {
  constexpr double maxTriangles = 100000.0; // about 10 ms of one core per camera
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.toUtf8());
  reader->Update();
  vtkSmartPointer<vtkPolyData> mesh = reader->GetOutput();
  if (const auto count = static_cast<double>(mesh->GetNumberOfCells()); count > maxTriangles) {
    vtkNew<vtkQuadricDecimation> decimation;
    decimation->SetInputData(mesh);
    decimation->SetTargetReduction(1.0 - maxTriangles / count);
    decimation->VolumePreservationOn();
    decimation->Update();
    mesh = decimation->GetOutput();
  }
  fenestra::core::SurfaceTriangles triangles;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i) {
    double point[3];
    mesh->GetPoint(i, point);
    for (const double coordinate : point)
      triangles.points.push_back(static_cast<float>(coordinate));
  }
  vtkIdType size = 0;
  const vtkIdType* corners = nullptr;
  vtkCellArray* const cells = mesh->GetPolys();
  cells->InitTraversal();
  while (cells->GetNextCell(size, corners))
    triangles.corners.insert(triangles.corners.end(), corners, corners + size);
  return std::make_shared<const fenestra::core::ClosedSurface>(std::move(triangles));
}

} // namespace

void qSlicerFenestraSession::onOpeningChanged() {
  Opening* opening = m_logic->GetOpening();
  qvtkReconnect(m_opening, opening, vtkCommand::ModifiedEvent, this, SLOT(refreshOpening()));
  m_opening = opening;
  m_focusKey.clear();
  refreshOpening();
}

void qSlicerFenestraSession::refreshOpening() {
  if (m_opening && m_opening->GetVisible() && !m_openingTimer.isActive())
    m_openingTimer.start();
  if (m_opening && !m_opening->GetVisible() && !m_focusProblem.empty())
    m_focusKey.clear(); // so that opening it again tries again
}

void qSlicerFenestraSession::onOpenedDataChanged() {
  m_isOpenedDataChanged = true;
  refreshOpening();
}

/// Observes the nodes on which the focus depends, instead of those observed before.
void qSlicerFenestraSession::observeOpening(Node* settings) {
  const auto observe = [this](vtkWeakPointer<vtkMRMLNode>& observed, vtkMRMLNode* node) {
    if (observed == node)
      return;
    for (const unsigned long event : vtkSlicerFenestraLogic::GetDataEvents()) {
      const bool isDisplay = event == vtkMRMLDisplayableNode::DisplayModifiedEvent;
      qvtkReconnect(observed, node, event, this,
                    isDisplay ? SLOT(refreshOpening()) : SLOT(onOpenedDataChanged()));
    }
    observed = node;
    m_focusKey.clear(); // the focus is another one
  };
  if (m_openedSettings != settings)
    qvtkReconnect(m_openedSettings, settings, vtkCommand::ModifiedEvent, this,
                  SLOT(refreshOpening()));
  m_openedSettings = settings;
  observe(m_openedVolume, settings ? settings->GetNodeReference(Node::VolumeRole) : nullptr);
  observe(m_openedSegmentation,
          settings ? settings->GetNodeReference(Node::SegmentationRole) : nullptr);
}

void qSlicerFenestraSession::updateOpening() {
  if (!m_opening || !m_opening->GetScene() || !m_opening->GetVisible())
    return;
  if (m_opening->GetPreparing() || m_opening->GetScene()->IsBatchProcessing())
    return m_openingTimer.start();
  Node* const settings = m_opening->GetSettings();
  observeOpening(settings);
  try {
    if (!settings)
      throw SlicerExport::UserError("The settings of the opened view were removed. Open it again.");
    if (!vtkSlicerFenestraLogic::HasFocus(settings))
      throw SlicerExport::UserError("There is no focus. Choose a segment.");
    const Flags flags = takeFocusFlags(settings);
    if (!m_isOpenedDataChanged && flags == m_focusFlags && !m_focusKey.empty())
      return showOpeningProblem();
    const SlicerExport::Contents contents =
        m_logic->Snapshot(settings, m_files->folder.path().toStdString());
    m_isOpenedDataChanged = false;
    const std::string key = makeFocusKey(contents, flags);
    if (key == m_focusKey)
      return showOpeningProblem();
    if (flags != m_focusFlags || m_focusKey.empty())
      m_opening->SetFocus(nullptr, {}); // of something else
    m_focusKey = key;
    m_focusFlags = flags;
    startFocus(contents, flags);
  } catch (const SlicerExport::UserError& error) {
    m_focusKey.clear();
    m_opening->SetFocus(nullptr, {});
    setOpeningProblem(error.what());
  }
}

/// That of the focus, or else of the settings.
void qSlicerFenestraSession::showOpeningProblem() {
  setOpeningProblem(m_focusProblem.empty()
                        ? vtkSlicerFenestraLogic::FindOpeningProblem(m_opening->GetSettings())
                        : m_focusProblem);
}

/// Logs another problem than before.
void qSlicerFenestraSession::setOpeningProblem(const std::string& problem) {
  if (!problem.empty() && problem != m_opening->GetProblem())
    qWarning().noquote() << "Fenestra:" << QString::fromStdString(problem);
  m_opening->SetProblem(problem);
}

/// Lets the renderer write the triangles, since it smooths and trims the focus of images.
void qSlicerFenestraSession::startFocus(const SlicerExport::Contents& contents,
                                        const Flags& flags) {
  m_focusProblem.clear();
  showOpeningProblem();
  m_opening->SetPreparing(true);
  const auto end = [this, opening = m_opening, corners = findCorners(contents)](
                       const Opening::Focus& focus, const QString& problem) {
    if (opening) // else its scene was closed
      endFocus(opening, focus, corners, problem);
  };
  write(contents,
        [this, flags, end, files = m_files](const QString& scene, const QString& message) {
          if (!message.isEmpty())
            return end({}, message);
          const QString folder = QFileInfo(scene).absolutePath();
          QStringList arguments = {"mesh", scene, "--quiet", "--output=focus.vtp"};
          for (const std::string& argument : SlicerExport::toArguments(flags))
            arguments << QString::fromStdString(argument);
          auto* child = new qFenestraProgram(this);
          m_focusProgram = child;
          connect(child, &qFenestraProgram::ended, this,
                  [this, child, folder, files, end](const qFenestraOutcome& outcome) {
                    child->deleteLater();
                    if (outcome.kind == qFenestraOutcome::Kind::done)
                      return readFocus(folder, files, end);
                    removeFolder(folder);
                    const QString problem = toUserText(outcome.message, files->folder.path());
                    end({}, problem.isEmpty() ? tr("The focus could not be prepared.") : problem);
                  });
          arguments << qSlicerFenestraApplicationSettings::makeThreadArguments();
          child->run(program(), arguments, folder);
        });
}

/// `files`: keeps the folder until it was read.
void qSlicerFenestraSession::readFocus(
    const QString& folder, const std::shared_ptr<Files>& files,
    const std::function<void(const Opening::Focus& focus, const QString& problem)>& then) {
  runInWorker([this, folder, files, then] {
    const Opening::Focus focus = readTriangles(folder + "/focus.vtp");
    removeFolder(folder);
    runInMainThread([focus, then] {
      then(focus, focus->corners().empty() ? tr("The focus has no surface.") : QString());
    });
  });
}

void qSlicerFenestraSession::endFocus(Opening* opening, const Opening::Focus& focus,
                                      const fenestra::core::BoxCorners& corners,
                                      const QString& problem) {
  opening->SetPreparing(false);
  if (opening != m_opening)
    return;
  m_focusProblem = problem.toStdString();
  opening->SetFocus(focus, corners);
  showOpeningProblem();
  refreshOpening(); // changes since
}
