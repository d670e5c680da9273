// Patient data: a session's private folder and its removal, and copies that the user saves.

#include "TemporaryFolder.h"

#include "qFenestraCopies.h"
#include "qFenestraFolder.h"

#include <QDir>
#include <gtest/gtest.h>

#include <csignal>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fenestra::core {
namespace {

QString toQString(const std::filesystem::path& path) {
  return QString::fromStdString(path.string());
}

/// Another session, in a process that runs until it is killed.
class OtherSession {
public:
  explicit OtherSession(const TemporaryFolder& parent) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    m_process = ::fork();
    if (m_process == 0) {
      const qFenestraFolder folder(toQString(parent.path()), "session-");
      std::ofstream(folder.filePath("patient.nrrd").toStdString()) << "voxels";
      const std::string path = folder.path().toStdString();
      [[maybe_unused]] const auto written = ::write(ends[1], path.data(), path.size());
      for (;;)
        ::pause();
    }
    char path[4096] = {};
    EXPECT_GT(::read(ends[0], path, sizeof path - 1), 0);
    folder = path;
    ::close(ends[0]);
    ::close(ends[1]);
  }
  ~OtherSession() { crash(); }
  OtherSession(const OtherSession&) = delete;
  OtherSession& operator=(const OtherSession&) = delete;

  void crash() {
    if (m_process > 0) {
      ::kill(m_process, SIGKILL);
      ::waitpid(m_process, nullptr, 0);
    }
    m_process = -1;
  }

  std::filesystem::path folder;

private:
  pid_t m_process = -1;
};

TEST(SlicerFolder, IsPrivateAndRemovedWithItsSession) {
  const TemporaryFolder parent;
  QString path;
  {
    const qFenestraFolder folder(toQString(parent.path()), "session-");
    path = folder.path();
    ASSERT_TRUE(folder.isValid());
    EXPECT_EQ(std::filesystem::status(path.toStdString()).permissions(),
              std::filesystem::perms::owner_all);
    EXPECT_TRUE(QDir(path).mkpath("1"));
  }
  EXPECT_FALSE(QDir(path).exists());
}

/// In another container, the number in a folder's name may belong to no process or to another one.
TEST(SlicerFolder, OnlyFoldersOfCrashedSessionsAreRemoved) {
  const TemporaryFolder parent;
  OtherSession other(parent);
  const std::filesystem::path renamed = parent / "session-999999999-a"; // no process has this id
  std::filesystem::rename(other.folder, renamed);
  { const qFenestraFolder own(toQString(parent.path()), "session-"); }
  EXPECT_TRUE(std::filesystem::exists(renamed / "patient.nrrd"));
  other.crash();
  { const qFenestraFolder own(toQString(parent.path()), "session-"); }
  EXPECT_FALSE(std::filesystem::exists(renamed));
}

TEST(SlicerFolder, ForeignFoldersAndLinksAreLeftAlone) {
  const TemporaryFolder parent;
  // A young folder has no lock file yet.
  for (const char* name : {"session-young", "other-a", "elsewhere"})
    std::filesystem::create_directory(parent / name);
  parent.write("other-a/lock", "");
  parent.write("elsewhere/lock", "");
  std::filesystem::create_directory_symlink(parent / "elsewhere", parent / "session-link");
  std::filesystem::create_directory(parent / "session-trap");
  std::filesystem::create_symlink(parent / "elsewhere/lock", parent / "session-trap/lock");
  { const qFenestraFolder own(toQString(parent.path()), "session-"); }
  for (const char* name : {"session-young", "other-a/lock", "elsewhere/lock", "session-trap/lock"})
    EXPECT_TRUE(std::filesystem::exists(parent / name)) << name;
}

class SlicerCopies : public ::testing::Test {
protected:
  SlicerCopies() {
    folder.write("new.png", std::string(10000, 'n'));
    folder.write("old.png", "old");
  }
  QString path(const char* name) const { return toQString(folder / name); }

  TemporaryFolder folder;
};

TEST_F(SlicerCopies, CompleteCopyReplacesTheOldFile) {
  EXPECT_EQ(qFenestraCopies::picture(path("new.png"), path("old.png"), ".png").write(), "");
  EXPECT_EQ(readBytes(folder / "old.png").size(), 10000u);
}

TEST_F(SlicerCopies, FailedCopyKeepsTheOldFileAndLeavesNoPartialFile) {
  EXPECT_EQ(qFenestraCopies::picture(path("gone.png"), path("old.png"), ".png").write(),
            path("old.png"));
  EXPECT_EQ(readBytes(folder / "old.png"), "old");

  struct rlimit before = {};
  ::getrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, SIG_IGN);
  struct rlimit limited = before;
  limited.rlim_cur = 4096; // like a full disk
  ::setrlimit(RLIMIT_FSIZE, &limited);
  const QString failed = qFenestraCopies::picture(path("new.png"), path("old.png"), ".png").write();
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, SIG_DFL);
  EXPECT_EQ(failed.toStdString(), path("old.png").toStdString());
  EXPECT_EQ(readBytes(folder / "old.png").size(), 3u);
  EXPECT_EQ(QDir(toQString(folder.path())).entryList(QDir::Files | QDir::Hidden),
            (QStringList{"new.png", "old.png"}));
}

TEST_F(SlicerCopies, ExistingListsTheFilesThatWriteWouldReplace) {
  EXPECT_EQ(qFenestraCopies::picture(path("new.png"), path("old"), ".png").existingTargets(),
            QStringList{path("old.png")});
  EXPECT_EQ(qFenestraCopies::picture(path("new.png"), path("old.PNG"), ".png").existingTargets(),
            QStringList());
  EXPECT_EQ(qFenestraCopies::picture(path("new.png"), path("old"), ".exr").existingTargets(),
            QStringList());

  const QStringList sources = {path("frame_0000.png"), path("frame_0001.png"),
                               path("frame_0002.png")};
  for (const QString& source : sources)
    folder.write(QFileInfo(source).fileName().toStdString(), "frame");
  folder.write("turn_0001.png", "old");
  std::filesystem::create_symlink(folder / "nowhere", folder / "turn_0002.png");
  for (const char* chosen : {"turn", "turn.png"}) {
    const qFenestraCopies frames = qFenestraCopies::frames(sources, path(chosen));
    EXPECT_EQ(frames.existingTargets(),
              (QStringList{path("turn_0001.png"), path("turn_0002.png")}));
    EXPECT_EQ(frames.names(), path("turn_0000.png") + " to turn_0002.png");
  }
  EXPECT_EQ(qFenestraCopies::frames(sources, path("turn")).write(), "");
  EXPECT_EQ(readBytes(folder / "turn_0001.png"), "frame");
}

} // namespace
} // namespace fenestra::core
