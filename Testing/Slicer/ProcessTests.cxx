// Renders and previews as the extension runs them, with the real renderer: their output and how
// they end.

#include "TemporaryFolder.h"

#include "qFenestraPreview.h"
#include "qFenestraQueue.h"

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QFile>
#include <QFileInfo>
#include <QTimer>
#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <sys/wait.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

using Kind = qFenestraOutcome::Kind;

const QString program = FENESTRA_EXECUTABLE;

/// Runs the event loop until the condition holds; false after minutes, as of a program that hangs.
bool waitFor(const std::function<bool()>& condition) {
  constexpr int timeoutMs = 300'000;
  QElapsedTimer watch;
  watch.start();
  while (!condition()) {
    if (watch.elapsed() > timeoutMs)
      return false;
    QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents, 10);
  }
  return true;
}

class SlicerProcess : public ::testing::Test {
protected:
  SlicerProcess() {
    std::string samples;
    for (char value = 0; value < 64; ++value)
      samples += {value, 0};
    folder.write("volume.nrrd",
                 "NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\n"
                 "sizes: 4 4 4\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
                 "endian: little\nencoding: raw\n\n" +
                     samples);
  }

  QString path() const { return QString::fromStdString(folder.path().string()); }
  bool exists(const char* name) const { return std::filesystem::exists(folder / name); }
  qFenestraJob job(int id, const QStringList& more = {}) const {
    return {id, QStringList{"volume.nrrd", "--size", "16x16"} + more, path()};
  }

  TemporaryFolder folder;
};

struct Ended {
  int id;
  qFenestraOutcome outcome;
};

/// Records the signals of a queue.
struct SignalRecorder {
  std::vector<int> started;
  std::vector<double> progress;
  std::vector<Ended> ended;

  explicit SignalRecorder(qFenestraQueue& queue) {
    QObject::connect(&queue, &qFenestraQueue::started, [this](int id) { started.push_back(id); });
    QObject::connect(&queue, &qFenestraQueue::progressed,
                     [this](int, double fraction) { progress.push_back(fraction); });
    QObject::connect(&queue, &qFenestraQueue::ended,
                     [this](int id, const qFenestraOutcome& outcome) {
                       ended.push_back({id, outcome});
                     });
  }
};

TEST_F(SlicerProcess, QueueRunsJobsInOrder) {
  qFenestraQueue queue(program);
  const SignalRecorder recorder(queue);
  for (int id = 1; id <= 3; ++id)
    queue.add(job(id, {"--samples", "4", "--output", QString("%1.png").arg(id)}));
  EXPECT_EQ(queue.waiting(), 2);
  ASSERT_TRUE(waitFor([&] { return recorder.ended.size() == 3; }));
  EXPECT_EQ(recorder.started, (std::vector<int>{1, 2, 3}));
  for (int id = 1; id <= 3; ++id) {
    const Ended& ended = recorder.ended[static_cast<std::size_t>(id - 1)];
    EXPECT_EQ(ended.id, id);
    EXPECT_EQ(ended.outcome.kind, Kind::done) << ended.outcome.details.toStdString();
    EXPECT_TRUE(exists(QString("%1.png").arg(id).toUtf8().constData()));
  }
  ASSERT_FALSE(recorder.progress.empty());
  EXPECT_EQ(recorder.progress.back(), 1.0);
}

TEST_F(SlicerProcess, StopKeepsFinishedPassesAndSkipsWaitingJobs) {
  qFenestraQueue queue(program);
  const SignalRecorder recorder(queue);
  queue.add(job(1, {"--samples", "100000000", "--output", "long.png"})); // hours
  queue.add(job(2, {"--output", "never.png"}));
  queue.add(job(3, {"--samples", "1", "--output", "after.png"}));
  ASSERT_TRUE(
      waitFor([&] { return !recorder.progress.empty() && recorder.progress.back() > 0.0; }));
  queue.stop(2);
  queue.stop(1);
  ASSERT_TRUE(waitFor([&] { return recorder.ended.size() == 3; }));
  EXPECT_EQ(recorder.ended[0].id, 2);
  EXPECT_EQ(recorder.ended[1].id, 1);
  EXPECT_EQ(recorder.ended[1].outcome.kind, Kind::stopped);
  EXPECT_TRUE(exists("long.png"));
  EXPECT_FALSE(exists("never.png"));
  EXPECT_TRUE(exists("after.png"));
}

TEST_F(SlicerProcess, FailureHasTheRenderersMessage) {
  qFenestraQueue queue(program);
  const SignalRecorder recorder(queue);
  queue.add({1, {"missing.nrrd"}, path()});
  queue.add(job(2, {"--samples", "none"}));
  ASSERT_TRUE(waitFor([&] { return recorder.ended.size() == 2; }));
  for (const Ended& ended : recorder.ended)
    EXPECT_EQ(ended.outcome.kind, Kind::failed);
  EXPECT_TRUE(recorder.ended[0].outcome.message.startsWith("missing.nrrd: "))
      << recorder.ended[0].outcome.message.toStdString();
  EXPECT_TRUE(recorder.ended[1].outcome.message.startsWith("--samples: "));
  EXPECT_TRUE(recorder.ended[1].outcome.details.startsWith("fenestra: error: --samples: "));
}

TEST_F(SlicerProcess, MissingRendererFailsEachJobOnce) {
  qFenestraQueue queue(path() + "/nowhere/fenestra");
  const SignalRecorder recorder(queue);
  queue.add(job(1));
  queue.add(job(2));
  ASSERT_TRUE(waitFor([&] { return recorder.ended.size() == 2; }));
  for (const Ended& ended : recorder.ended) {
    EXPECT_EQ(ended.outcome.kind, Kind::failed);
    EXPECT_TRUE(ended.outcome.message.contains("could not be started"));
    EXPECT_TRUE(ended.outcome.details.contains("nowhere"));
  }
}

TEST_F(SlicerProcess, KilledRendererIsReportedAsFailed) {
  qFenestraProgram child;
  std::vector<qFenestraOutcome> outcomes;
  QObject::connect(&child, &qFenestraProgram::ended,
                   [&](const qFenestraOutcome& outcome) { outcomes.push_back(outcome); });
  child.run(program, job(1, {"--samples", "100000000"}).arguments, path());
  ASSERT_TRUE(child.waitForStarted());
  ::kill(static_cast<pid_t>(child.processId()), SIGKILL); // as the kernel does if memory runs out
  ASSERT_TRUE(waitFor([&] { return !outcomes.empty(); }));
  EXPECT_EQ(outcomes[0].kind, Kind::failed);
  EXPECT_TRUE(outcomes[0].message.contains("memory"));
}

/// Starts a shell script in place of the renderer, which handles the stop signal, and stops it.
struct StoppedChild {
  explicit StoppedChild(const TemporaryFolder& folder, const char* onStop) {
    QObject::connect(&child, &qFenestraProgram::ended,
                     [this](const qFenestraOutcome& ended) { outcomes.push_back(ended); });
    bool ready = false;
    const auto connection =
        QObject::connect(&child, &qFenestraProgram::lineReceived, [&] { ready = true; });
    child.run(
        "/bin/sh",
        {"-c", QString("trap '%1' TERM; echo ready; while :; do sleep 0.02; done").arg(onStop)},
        QString::fromStdString(folder.path().string()));
    EXPECT_TRUE(waitFor([&] { return ready; }));
    QObject::disconnect(connection);
    child.stop();
  }
  Kind kind() {
    EXPECT_TRUE(waitFor([this] { return !outcomes.empty(); }));
    return outcomes.empty() ? Kind::done : outcomes[0].kind;
  }

  std::vector<qFenestraOutcome> outcomes;
  qFenestraProgram child;
};

/// Writing takes longer than any plausible timeout; meanwhile the window must respond.
TEST_F(SlicerProcess, StopWaitsForARendererThatWrites) {
  StoppedChild stopped(folder, "sleep 2; echo picture >kept.png; exit 5");
  bool responded = false;
  QTimer::singleShot(0, [&] { responded = true; });
  QCoreApplication::processEvents();
  EXPECT_TRUE(responded);
  EXPECT_FALSE(exists("kept.png")) << "Stop waits for the renderer";
  EXPECT_EQ(stopped.kind(), Kind::stopped);
  EXPECT_TRUE(exists("kept.png"));
}

TEST_F(SlicerProcess, SecondStopKillsTheRenderer) {
  StoppedChild stopped(folder, ":");
  QCoreApplication::processEvents(QEventLoop::AllEvents, 50);
  EXPECT_TRUE(stopped.outcomes.empty());
  stopped.child.stop();
  EXPECT_EQ(stopped.kind(), Kind::killed);
}

TEST_F(SlicerProcess, FailureWhileStoppingIsReported) {
  EXPECT_EQ(StoppedChild(folder, "kill -SEGV $$").kind(), Kind::failed);
  EXPECT_EQ(StoppedChild(folder, "echo fenestra: full >&2; exit 4").kind(), Kind::failed);
  EXPECT_EQ(StoppedChild(folder, "exit 0").kind(), Kind::done); // finished before the stop
}

TEST_F(SlicerProcess, StopRightAfterTheStartEndsTheProgram) {
  qFenestraProgram child;
  std::vector<qFenestraOutcome> outcomes;
  QObject::connect(&child, &qFenestraProgram::ended,
                   [&](const qFenestraOutcome& ended) { outcomes.push_back(ended); });
  child.run("/bin/sleep", {"100"}, path());
  child.stop();
  ASSERT_TRUE(waitFor([&] { return !outcomes.empty(); }));
  EXPECT_EQ(outcomes[0].kind, Kind::stopped);
}

TEST_F(SlicerProcess, ProgressIsReadFromValidTagsOnly) {
  EXPECT_EQ(qFenestraQueue::parseProgress("<filter-progress>0.25</filter-progress>"), 0.25);
  EXPECT_EQ(qFenestraQueue::parseProgress("<filter-progress>7</filter-progress>"), 1.0);
  for (const char* line :
       {"", "0.5", "<filter-progress>", "<filter-progress>x</filter-progress>",
        "<filter-progress>-1</filter-progress>", "<filter-progress>nan</filter-progress>",
        "<filter-progress></filter-progress>", "<filter-start>", "</filter-progress>"})
    EXPECT_EQ(qFenestraQueue::parseProgress(line), -1.0) << line;
}

TEST_F(SlicerProcess, EnvironmentOfAChildOmitsLibraryPaths) {
  QProcessEnvironment inherited;
  inherited.insert("LD_LIBRARY_PATH", "/opt/slicer/lib");
  inherited.insert("QT_PLUGIN_PATH", "/opt/slicer/plugins");
  inherited.insert("HOME", "/home/somebody");
  const QProcessEnvironment environment = qFenestraProgram::removeLibraryPaths(inherited);
  EXPECT_EQ(environment.keys(), QStringList{"HOME"});
}

/// A child ends with its object and, by a parent-death signal, with its parent process.
TEST_F(SlicerProcess, ChildEndsWithItsObjectAndWithItsParent) {
  qint64 id = 0;
  {
    qFenestraProgram child;
    child.run(program, job(1, {"--samples", "100000000"}).arguments, path());
    ASSERT_TRUE(child.waitForStarted());
    id = child.processId();
  }
  EXPECT_NE(::kill(static_cast<pid_t>(id), 0), 0);

  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t parent = ::fork();
  if (parent == 0) { // simulates a crash of Slicer
    qFenestraProgram child;
    child.run(program, job(1, {"--samples", "100000000"}).arguments, path());
    child.waitForStarted();
    const pid_t grandchild = static_cast<pid_t>(child.processId());
    [[maybe_unused]] const auto written = ::write(ends[1], &grandchild, sizeof grandchild);
    ::kill(::getpid(), SIGKILL);
  }
  pid_t orphan = 0;
  ASSERT_EQ(::read(ends[0], &orphan, sizeof orphan), static_cast<ssize_t>(sizeof orphan));
  ::close(ends[0]);
  ::close(ends[1]);
  ::waitpid(parent, nullptr, 0);
  ASSERT_GT(orphan, 0);
  const auto hasEnded = [&] {
    QFile status(QString("/proc/%1/stat").arg(orphan)); // no process, or a zombie, has ended
    return !status.open(QIODevice::ReadOnly) || status.readAll().contains(") Z ");
  };
  EXPECT_TRUE(waitFor(hasEnded));
}

class SlicerPreview : public SlicerProcess {
protected:
  SlicerPreview() {
    QObject::connect(&preview, &qFenestraPreview::refreshed,
                     [this](const qFenestraPreviewImage& image) { images.push_back(image); });
    QObject::connect(&preview, &qFenestraPreview::refused,
                     [this](const QString& message) { refusals << message; });
    QObject::connect(&preview, &qFenestraPreview::ended,
                     [this](const qFenestraOutcome& outcome) { outcomes.push_back(outcome); });
  }

  void start(const char* samples) {
    preview.start(program, {"volume.nrrd", "--size", "16x16", "--samples", samples}, path());
  }
  /// Waits for the last image of the last change.
  bool waitForDone() {
    return waitFor([this] {
      return !images.empty() && images.back().isCurrent && images.back().frame->isLast;
    });
  }

  qFenestraPreview preview;
  std::vector<qFenestraPreviewImage> images;
  QStringList refusals;
  std::vector<qFenestraOutcome> outcomes;
};

TEST_F(SlicerPreview, FastChangesAreSentAsOne) {
  start("8");
  ASSERT_TRUE(waitForDone());
  EXPECT_EQ(images.back().frame->samples, 8U);
  EXPECT_EQ(images.back().frame->width, 16);
  images.clear();
  // Of fast changes, one is sent, with the last value of each flag.
  for (const char* view : {"left", "right", "superior"}) {
    preview.change({{"view", view}});
    preview.change({{"samples", 4}});
  }
  ASSERT_TRUE(waitForDone());
  EXPECT_EQ(images.back().frame->samples, 4U);
  for (const qFenestraPreviewImage& image : images)
    EXPECT_TRUE(!image.isCurrent || image.frame->samples <= 4U);
  EXPECT_TRUE(refusals.isEmpty());
}

/// Changes that come faster than an image is rendered, like those of a dragged camera.
TEST_F(SlicerPreview, ImagesArriveDuringFastChanges) {
  preview.start(program, {"volume.nrrd", "--size=256x256", "--samples=100000000"}, path());
  ASSERT_TRUE(waitFor([this] { return !images.empty(); }));
  images.clear();
  int changes = 0;
  QTimer drag;
  QObject::connect(&drag, &QTimer::timeout, [&] {
    preview.change({{"scale", QString::number(2.0 + 0.01 * ++changes)}});
  });
  drag.start(1);
  EXPECT_TRUE(waitFor([&] { return images.size() > 2; })) << refusals.join(" ").toStdString();
  EXPECT_GT(changes, 3);
}

/// A pause is sent at once, and no reply is waited for afterwards.
TEST_F(SlicerPreview, PausePrecedesChangesThatWait) {
  const QString log = path() + "/lines.txt", silent = path() + "/silent.sh";
  QFile script(silent);
  ASSERT_TRUE(script.open(QIODevice::WriteOnly));
  script.write("#!/bin/sh\nexec cat > lines.txt\n");
  script.close();
  ASSERT_TRUE(script.setPermissions(QFile::ReadOwner | QFile::ExeOwner));
  const auto lines = [&log] {
    QFile file(log);
    return file.open(QIODevice::ReadOnly) ? file.readAll().split('\n') : QList<QByteArray>();
  };
  preview.start(silent, {}, path());
  ASSERT_TRUE(waitFor([this] { return preview.running(); }));
  preview.change({{"view", "left"}});
  ASSERT_TRUE(waitFor([&] { return lines().size() == 2; }));
  preview.change({{"view", "right"}}); // waits for the reply
  preview.pause();
  preview.change({{"samples", 4}});
  ASSERT_TRUE(waitFor([&] { return lines().size() == 4; }));
  EXPECT_TRUE(lines()[0].contains("left"));
  EXPECT_TRUE(lines()[1].contains("pause"));
  EXPECT_TRUE(lines()[2].contains("right") && lines()[2].contains("samples"));
}

TEST_F(SlicerPreview, ChangesContinueAfterAPause) {
  start("100000000");
  ASSERT_TRUE(waitFor([this] { return !images.empty(); }));
  preview.change({{"view", "left"}});
  QCoreApplication::processEvents(); // sends it; the pause may come before its image
  preview.pause();
  images.clear();
  preview.change({{"view", "right"}, {"samples", 4}});
  ASSERT_TRUE(waitForDone());
  EXPECT_EQ(images.back().frame->samples, 4U);
  EXPECT_TRUE(refusals.isEmpty());
}

/// The file of the images grows, and is mapped again.
TEST_F(SlicerPreview, LargerImagesFollowSmallerOnes) {
  start("1");
  ASSERT_TRUE(waitForDone());
  for (const int size : {90, 420, 40, 600}) {
    images.clear();
    preview.change({{"size", QString("%1x%1").arg(size)}});
    ASSERT_TRUE(waitForDone()) << refusals.join(" ").toStdString();
    EXPECT_EQ(images.back().frame->width, size);
    EXPECT_EQ(images.back().frame->fullHeight, size);
  }
  EXPECT_TRUE(refusals.isEmpty());
}

TEST_F(SlicerPreview, RefusedChangeKeepsThePreviewRunning) {
  start("2");
  ASSERT_TRUE(waitForDone());
  preview.change({{"focus", "Femur"}});
  ASSERT_TRUE(waitFor([this] { return !refusals.isEmpty(); }));
  EXPECT_TRUE(refusals[0].contains("--focus")) << refusals[0].toStdString();
  images.clear();
  preview.change({{"view", "left"}});
  ASSERT_TRUE(waitForDone());
  EXPECT_TRUE(preview.running());
}

TEST_F(SlicerPreview, StopReturnsImmediately) {
  start("100000000");
  ASSERT_TRUE(waitFor([this] { return !images.empty(); }));
  preview.stop();
  EXPECT_FALSE(preview.running());
  const auto children = preview.findChildren<qFenestraProgram*>();
  ASSERT_EQ(children.size(), 1);
  EXPECT_EQ(children[0]->state(), QProcess::Running) << "stop() has waited for the child";
  // The child ends on its own, without further signals.
  EXPECT_TRUE(waitFor([this] { return preview.findChildren<qFenestraProgram*>().isEmpty(); }));
  EXPECT_TRUE(outcomes.empty());
}

TEST_F(SlicerPreview, FilesAreKeptUntilTheChildHasEnded) {
  auto files = std::make_shared<int>();
  const std::weak_ptr<int> held = files;
  preview.start(program, {"volume.nrrd", "--size=16x16", "--samples=100000000"}, path(),
                std::move(files));
  ASSERT_TRUE(waitFor([this] { return !images.empty(); }));
  preview.stop();
  EXPECT_FALSE(held.expired());
  EXPECT_TRUE(waitFor([&] { return held.expired(); }));
  EXPECT_TRUE(preview.findChildren<qFenestraProgram*>().isEmpty());
}

TEST_F(SlicerPreview, FailedStartHasTheRenderersMessage) {
  preview.start(program, {"missing.nrrd"}, path());
  ASSERT_TRUE(waitFor([this] { return !outcomes.empty(); }));
  EXPECT_EQ(outcomes[0].kind, Kind::failed);
  EXPECT_TRUE(outcomes[0].message.startsWith("missing.nrrd: "));
}

} // namespace
} // namespace fenestra::core
