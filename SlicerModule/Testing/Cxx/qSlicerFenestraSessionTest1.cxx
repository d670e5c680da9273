// A session without the panel: scene, preview, renders, and results in the scene. Rendering the
// scene that Slicer saves from the command line gives the same image, bit for bit.
// Arguments: the renderer, a folder for files.

#include "FenestraTesting.h"

#include "qSlicerFenestraSession.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <QApplication>
#include <QDir>
#include <QFileInfo>
#include <QProcess>

#include <vtkCallbackCommand.h>
#include <vtkMRMLModelNode.h>
#include <vtkMRMLStorageNode.h>
#include <vtkMRMLSubjectHierarchyNode.h>
#include <vtkMRMLVectorVolumeNode.h>
#include <vtkPolyData.h>

#include <cstring>

namespace {

using FenestraTesting::waitFor;
using Node = vtkMRMLFenestraRenderNode;
using Kind = qFenestraOutcome::Kind;

/// Records the signals of a session.
struct SignalRecorder {
  explicit SignalRecorder(qSlicerFenestraSession& session) {
    QObject::connect(&session, &qSlicerFenestraSession::ended, &session,
                     [this](Node* node, const qFenestraOutcome& outcome) {
                       ++ended;
                       render = node;
                       last = outcome;
                     });
    QObject::connect(&session, &qSlicerFenestraSession::previewReceived, &session,
                     [this](const QImage& picture, const qFenestraPreviewImage&) {
                       ++previews;
                       preview = picture;
                     });
    QObject::connect(&session, &qSlicerFenestraSession::previewRefused, &session,
                     [](const QString& message) {
                       std::cout << "Refused: " << message.toStdString() << std::endl;
                     });
    QObject::connect(&session, &qSlicerFenestraSession::statusChanged, &session,
                     [this](const QString& text) { status = text; });
  }
  int ended = 0, previews = 0;
  Node* render = nullptr;
  qFenestraOutcome last;
  QImage preview;
  QString status;
};

/// Saves a node's data and adds the storage node, as Slicer does.
void store(vtkMRMLScene* scene, vtkMRMLStorableNode* node, const QString& file) {
  const auto storage = vtkSmartPointer<vtkMRMLStorageNode>::Take(node->CreateDefaultStorageNode());
  storage->SetFileName(file.toUtf8().constData());
  scene->AddNode(storage);
  node->SetAndObserveStorageNodeID(storage->GetID());
  storage->WriteData(node);
}

int compareWithCommandLine(vtkMRMLScene* scene, Node* render, const QString& program,
                           const QString& folder) {
  std::vector<vtkMRMLNode*> nodes;
  scene->GetNodesByClass("vtkMRMLStorableNode", nodes);
  for (vtkMRMLNode* node : nodes)
    if (node->IsA("vtkMRMLScalarVolumeNode") || node->IsA("vtkMRMLSegmentationNode"))
      store(scene, vtkMRMLStorableNode::SafeDownCast(node),
            folder + "/" + node->GetName() +
                (node->IsA("vtkMRMLSegmentationNode") ? ".seg.nrrd" : ".nrrd"));
  const QString file = folder + "/scene.mrml";
  scene->SetRootDirectory(folder.toUtf8().constData());
  scene->SetURL(file.toUtf8().constData());
  CHECK_INT(scene->Commit(), 1);
  QProcess child;
  child.setWorkingDirectory(folder);
  child.start(program, {file, "--output", "line.nrrd", "--progress", "none"});
  CHECK_BOOL(child.waitForFinished(60000), true);
  if (child.exitCode() != 0)
    std::cerr << child.readAllStandardError().toStdString();
  CHECK_INT(child.exitCode(), 0);

  const SlicerExport::Image line = SlicerExport::readNrrd((folder + "/line.nrrd").toStdString());
  auto* radiance =
      vtkMRMLVectorVolumeNode::SafeDownCast(render->GetNodeReference(Node::RadianceRole));
  CHECK_NOT_NULL(radiance);
  constexpr size_t pixelBytes = 4 * sizeof(float); // RGBA
  const size_t bytes =
      static_cast<size_t>(radiance->GetImageData()->GetNumberOfPoints()) * pixelBytes;
  CHECK_BOOL(line.bytes() == bytes, true);
  CHECK_INT(std::memcmp(line.data.get(), radiance->GetImageData()->GetScalarPointer(), bytes), 0);
  return EXIT_SUCCESS;
}

int checkResult(vtkMRMLScene* scene, Node* render) {
  for (const char* role : {Node::PictureRole, Node::RadianceRole, Node::DepthRole}) {
    auto* volume = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(role));
    CHECK_NOT_NULL(volume);
    CHECK_INT(volume->GetImageData()->GetDimensions()[0], 48);
    CHECK_NOT_NULL(volume->GetDisplayNode());
  }
  auto* surface = vtkMRMLModelNode::SafeDownCast(render->GetNodeReference(Node::SurfaceRole));
  CHECK_NOT_NULL(surface);
  CHECK_BOOL(surface->GetPolyData()->GetNumberOfCells() > 0, true);
  CHECK_BOOL(std::string(render->GetDescription()).find("samples") != std::string::npos, true);
  CHECK_NOT_NULL(scene);
  return EXIT_SUCCESS;
}

/// Two renders, run one after the other.
int checkTwoRenders(vtkMRMLScene* scene, qSlicerFenestraSession& session, Node* settings,
                    SignalRecorder& recorder) {
  Node* first = session.render(settings);
  CHECK_NOT_NULL(first);
  settings->SetFlag("seed", "5");
  CHECK_NOT_NULL(session.render(settings));
  CHECK_INT(session.waitingCount(), 1);
  CHECK_BOOL(waitFor([&] { return recorder.ended == 2; }), true);
  CHECK_INT(static_cast<int>(recorder.last.kind), static_cast<int>(Kind::done));
  CHECK_EXIT_SUCCESS(checkResult(scene, first));
  CHECK_BOOL(session.results().findFile(first, "exr").isEmpty(), false);
  return EXIT_SUCCESS;
}

/// A stopped render keeps its finished samples.
int checkStop(qSlicerFenestraSession& session, Node* settings, SignalRecorder& recorder) {
  settings->SetFlag("samples", "100000000");
  Node* unlimited = session.render(settings);
  recorder.status.clear();
  CHECK_BOOL(waitFor([&] { return recorder.status.contains("noise"); }), true); // it has an image
  QElapsedTimer watch;
  watch.start();
  session.stop();
  CHECK_BOOL(waitFor([&] { return recorder.ended == 3; }), true);
  std::cout << "Stopped after " << watch.elapsed() << " ms\n";
  CHECK_INT(static_cast<int>(recorder.last.kind), static_cast<int>(Kind::stopped));
  CHECK_POINTER(recorder.render, unlimited);
  return EXIT_SUCCESS;
}

/// Failures leave no node. `ids`: of a segment and of an empty segment.
int checkFailures(qSlicerFenestraSession& session, Node* settings,
                  const std::vector<std::string>& ids, SignalRecorder& recorder) {
  vtkMRMLScene* const scene = settings->GetScene();
  const int nodes = scene->GetNumberOfNodes();
  settings->SetFocus({ids[1]}); // empty
  session.render(settings);
  CHECK_BOOL(waitFor([&] { return recorder.ended == 4; }), true);
  CHECK_INT(static_cast<int>(recorder.last.kind), static_cast<int>(Kind::failed));
  CHECK_STD_STRING(recorder.last.message.toStdString(),
                   "The focus has no voxel (Nothing); choose segments that are not empty");
  CHECK_NULL(recorder.render);
  settings->SetFocus({ids[0]});
  settings->SetFlags({{"size", "0x0"}});
  session.render(settings);
  CHECK_BOOL(waitFor([&] { return recorder.ended == 5; }), true);
  CHECK_INT(static_cast<int>(recorder.last.kind), static_cast<int>(Kind::failed));
  CHECK_INT(scene->GetNumberOfNodes(), nodes);
  return EXIT_SUCCESS;
}

/// Without a session, or without its renderer, nothing is rendered.
int checkWithoutRenderer(vtkSlicerFenestraLogic* logic, Node* settings) {
  TESTING_OUTPUT_ASSERT_ERRORS_BEGIN();
  CHECK_NULL(logic->Render(nullptr));
  CHECK_NULL(logic->Render(settings, true));
  TESTING_OUTPUT_ASSERT_ERRORS_END();
  qSlicerFenestraSession broken(logic, "/nowhere/fenestra");
  SignalRecorder recorder(broken);
  CHECK_NULL(logic->Render(settings, true));
  CHECK_BOOL(recorder.last.message.contains("missing"), true);
  CHECK_INT(settings->GetScene()->GetNumberOfNodesByClass("vtkMRMLFenestraRenderNode"), 1);
  return EXIT_SUCCESS;
}

/// A node of another scene has the ID of a render: it must not show the render's results.
int checkAnotherScene(vtkMRMLScene* scene, qSlicerFenestraSession& session, Node* render) {
  const std::string id = render->GetID();
  const QString file = session.results().findFile(render, "png");
  CHECK_BOOL(file.isEmpty(), false);
  scene->Clear(false);
  Node* other = nullptr;
  for (int i = 0; i < 20 && (!other || id != other->GetID()); ++i)
    other = Node::SafeDownCast(scene->AddNewNodeByClass("vtkMRMLFenestraRenderNode"));
  CHECK_STD_STRING(std::string(other->GetID()), id);
  other->SetFlag("frames", "8");
  CHECK_BOOL(session.results().findFile(other, "png").isEmpty(), true);
  CHECK_BOOL(session.results().findFrames(other).isEmpty(), true);
  CHECK_BOOL(session.canResume(other), false);
  session.closeScene(); // the module does this in Slicer
  CHECK_BOOL(waitFor([&] { return !QFileInfo::exists(file); }), true);
  return EXIT_SUCCESS;
}

/// A finished render has its results in a folder directly below its volume. They are removed with
/// it.
int checkFolder(vtkMRMLScene* scene, Node* render) {
  auto* hierarchy = vtkMRMLSubjectHierarchyNode::GetSubjectHierarchyNode(scene);
  const vtkIdType root = hierarchy->GetSceneItemID();
  const vtkIdType volume = hierarchy->GetItemByDataNode(render->GetNodeReference(Node::VolumeRole));
  const int below = hierarchy->GetItemPositionUnderParent(volume) + 1;
  const vtkIdType folder = hierarchy->GetItemByPositionUnderParent(root, below);
  CHECK_STD_STRING(hierarchy->GetItemName(folder), std::string(render->GetName()));
  std::vector<std::string> results;
  for (const char* role :
       {Node::PictureRole, Node::RadianceRole, Node::DepthRole, Node::SurfaceRole}) {
    vtkMRMLNode* result = render->GetNodeReference(role);
    CHECK_NOT_NULL(result);
    CHECK_BOOL(hierarchy->GetItemParent(hierarchy->GetItemByDataNode(result)) == folder, true);
    results.emplace_back(result->GetID());
  }
  CHECK_INT(hierarchy->GetNumberOfItemChildren(folder), static_cast<int>(results.size()));
  scene->RemoveNode(render);
  for (const std::string& result : results)
    CHECK_NULL(scene->GetNodeByID(result));
  return EXIT_SUCCESS;
}

/// Render, events and removal, as a script uses them.
int checkScript(vtkMRMLScene* scene, vtkSlicerFenestraLogic* logic, Node* settings) {
  CHECK_NULL(logic->AddRender(nullptr));
  settings->SetFlags({{"samples", "8"},
                      {"size", "48x40"},
                      {"transfer", "ct-soft"},
                      {"focus", logic->GetSegmentIDs(settings).front()}});
  Node* render = logic->Render(settings);
  CHECK_NOT_NULL(render);
  CHECK_BOOL(logic->IsRendering(render), true);
  CHECK_INT(render->GetRenderState(), Node::Queued);
  std::map<unsigned long, int> events; // counts
  vtkNew<vtkCallbackCommand> count;
  count->SetCallback([](vtkObject*, unsigned long event, void* data, void*) {
    ++(*static_cast<std::map<unsigned long, int>*>(data))[event];
  });
  count->SetClientData(&events);
  render->AddObserver(vtkCommand::AnyEvent, count);
  CHECK_BOOL(waitFor([&] { return !render->IsRendering(); }), true);
  CHECK_INT(render->GetRenderState(), Node::Ended);
  CHECK_BOOL(events[Node::RenderProgressEvent] > 0, true);
  CHECK_INT(events[Node::RenderEndEvent], 1);
  render->RemoveObserver(count);
  CHECK_STD_STRING(render->GetProblem(), "");
  Node* finished = logic->Render(settings, true);
  CHECK_NOT_NULL(finished);
  return checkFolder(scene, finished);
}

/// The time of the sample is reported at once; a second request meanwhile is ignored.
int checkSample(qSlicerFenestraSession& session) {
  double seconds = -1.0;
  int calls = 0;
  QString scene;
  QObject::connect(&session, &qSlicerFenestraSession::sampleProgressed, &session,
                   [&](double now) { seconds = now; });
  const auto count = [&](const QString& file, const QString&) { scene = file, ++calls; };
  session.makeSample(count);
  CHECK_DOUBLE(seconds, 0.0);
  session.makeSample(count);
  CHECK_BOOL(waitFor([&] { return calls > 0; }), true);
  CHECK_INT(calls, 1);
  CHECK_BOOL(seconds > 0.0, true);
  CHECK_BOOL(QFileInfo::exists(scene), true);
  session.disconnect(SIGNAL(sampleProgressed(double)));
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraSessionTest1(int argc, char* argv[]) {
  QApplication application(argc, argv);
  if (argc < 3)
    return EXIT_FAILURE;
  const QString program = argv[1];
  const QString folder = QString(argv[2]) + "/session";
  QDir(folder).removeRecursively();
  QDir().mkpath(folder);
  FenestraTesting::registerConverters();
  vtkNew<vtkMRMLScene> scene;
  vtkNew<vtkSlicerFenestraLogic> logic;
  logic->SetMRMLScene(scene);
  Node* settings = logic->GetSettings();
  settings->SetNodeReferenceID(Node::VolumeRole, FenestraTesting::addVolume(scene)->GetID());
  vtkMRMLSegmentationNode* segmentation = FenestraTesting::addSegmentation(scene);
  settings->SetNodeReferenceID(Node::SegmentationRole, segmentation->GetID());
  auto* hierarchy = vtkMRMLSubjectHierarchyNode::GetSubjectHierarchyNode(scene);
  for (vtkMRMLNode* node : {settings->GetNodeReference(Node::VolumeRole),
                            static_cast<vtkMRMLNode*>(segmentation)}) // as Slicer does
    hierarchy->CreateItem(hierarchy->GetSceneItemID(), node);
  settings->SetFlags({{"samples", "8"},
                      {"size", "48x40"},
                      {"transfer", "ct-soft"},
                      {"view", "left"},
                      {"background", "0,0,0"}});
  std::vector<std::string> ids;
  segmentation->GetSegmentation()->GetSegmentIDs(ids);

  CHECK_EXIT_SUCCESS(checkWithoutRenderer(logic, settings));
  qSlicerFenestraSession session(logic, program);
  SignalRecorder recorder(session);
  session.preview(settings);
  CHECK_BOOL(waitFor([&] { return recorder.preview.width() > 128; }), true); // after a coarse one
  CHECK_INT(recorder.preview.width(), 256); // the image's aspect ratio
  CHECK_INT(recorder.preview.height(), 213);
  const int before = recorder.previews;
  settings->SetFocus({ids[0]});
  session.refresh();
  CHECK_BOOL(waitFor([&] { return recorder.previews > before; }), true);

  CHECK_EXIT_SUCCESS(checkTwoRenders(scene, session, settings, recorder));
  Node* second = recorder.render;
  CHECK_STD_STRING(second->GetFlag("seed"), "5");
  CHECK_EXIT_SUCCESS(compareWithCommandLine(scene, second, program, folder));
  CHECK_EXIT_SUCCESS(checkStop(session, settings, recorder));
  CHECK_EXIT_SUCCESS(checkFailures(session, settings, ids, recorder));
  CHECK_EXIT_SUCCESS(checkScript(scene, logic, settings));
  CHECK_EXIT_SUCCESS(checkSample(session));
  CHECK_EXIT_SUCCESS(checkAnotherScene(scene, session, second));
  return EXIT_SUCCESS;
}
