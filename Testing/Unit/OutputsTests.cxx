// Output files: what they may replace, their joint commit, and the state after a failure or another
// run.

#include "ErrorChecks.h"
#include "TemporaryFolder.h"
#include "io/InputRegistry.h"
#include "io/Outputs.h"
#include "io/platform/Folders.h"
#include "io/platform/Locks.h"
#include "io/platform/TemporaryFile.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fenestra::core::OutputsTests {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

class OutputFiles : public ::testing::Test {
protected:
  std::size_t fileCount() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
  }
  /// Writes a file and opens it, which registers it as an input.
  fs::path readInput(const std::string& name, const std::string& content = "input") const {
    requireFile(folder.write(name, content), "");
    return folder / name;
  }
  static mode_t readMode(const fs::path& path) {
    struct stat status = {};
    EXPECT_EQ(::lstat(path.c_str(), &status), 0) << path;
    return status.st_mode & 07777;
  }

  TemporaryFolder folder;
  const InputRegistry registry;
  Outputs outputs;
};

TEST_F(OutputFiles, CommitPlacesAllFilesTogether) {
  folder.write("a", "old");
  outputs.add(folder / "a");
  outputs.add(folder / "b");
  outputs.write(folder / "a", "new");
  outputs.write(folder / "b", "new");
  EXPECT_EQ(readBytes(folder / "a"), "old");
  EXPECT_FALSE(fs::exists(folder / "b"));
  outputs.commit();
  EXPECT_EQ(readBytes(folder / "a"), "new");
  EXPECT_EQ(readBytes(folder / "b"), "new");
  EXPECT_EQ(fileCount(), 2u);
}

TEST_F(OutputFiles, WithoutCommitNothingRemains) {
  folder.write("a", "old");
  {
    Outputs uncommitted;
    uncommitted.add(folder / "a");
    EXPECT_EQ(fileCount(), 1u);
    uncommitted.write(folder / "a", "half");
  }
  EXPECT_EQ(readBytes(folder / "a"), "old");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(OutputFiles, FailedCommitRestoresPreviousFiles) {
  folder.write("a", "old");
  outputs.add(folder / "a");
  outputs.add(folder / "b");
  outputs.add(folder / "c");
  for (const char* name : {"a", "b", "c"})
    outputs.write(folder / name, "new");
  fs::create_directory(folder / "c");
  catchError(ErrorKind::output, "not-a-file", [&] { outputs.commit(); });
  EXPECT_EQ(readBytes(folder / "a"), "old");
  EXPECT_FALSE(fs::exists(folder / "b"));
  EXPECT_TRUE(fs::is_directory(folder / "c"));
}

TEST_F(OutputFiles, InputIsNotReplacedUnderAnyOfItsNames) {
  readInput("volume");
  fs::create_symlink("volume", folder / "link");
  fs::create_hard_link(folder / "volume", folder / "hard");
  fs::create_symlink(folder.path(), folder / "here");
  const std::string upAndDown = "../" + folder.path().filename().string() + "/link";
  for (const std::string& name : {"volume"s, "link"s, "hard"s, "here/volume"s, upAndDown})
    catchError(ErrorKind::request, "output-conflict: " + name, [&] { outputs.add(folder / name); });
}

TEST_F(OutputFiles, FileThatBecameAnInputIsNotReplaced) {
  folder.write("a", "old");
  outputs.add(folder / "a");
  outputs.checkInputs();
  readInput("a", "old");
  catchError(ErrorKind::request, "output-conflict", [&] { outputs.checkInputs(); });
  outputs.write(folder / "a", "new");
  catchError(ErrorKind::request, "output-conflict", [&] { outputs.commit(); });
  EXPECT_EQ(readBytes(folder / "a"), "old");
}

TEST_F(OutputFiles, OwnOutputIsRefusedAsInput) {
  outputs.add(folder / "a");
  outputs.write(folder / "a", "new");
  outputs.commit();
  requireFile(folder / "a", "");
  catchError(ErrorKind::request, "output-conflict", [&] { outputs.checkInputs(); });
  outputs.unregisterInputs(); // the request that reads it was refused
  outputs.checkInputs();
}

TEST_F(OutputFiles, DuplicateOutputIsRefused) {
  folder.write("a", "old");
  fs::create_hard_link(folder / "a", folder / "hard");
  fs::create_symlink("none", folder / "link");
  outputs.add(folder / "a");
  outputs.add(folder / "none");
  for (const char* name : {"a", "hard", "link", "./none"})
    catchError(ErrorKind::request,
               std::string("output-conflict: ") + std::filesystem::path(name).filename().string(),
               [&] { outputs.add(folder / name); });
}

TEST_F(OutputFiles, LinksAreFollowedAndPreserved) {
  folder.write("real", "old");
  fs::create_symlink("real", folder / "link");
  fs::create_symlink("later", folder / "dangling");
  for (const char* name : {"link", "dangling"}) {
    outputs.add(folder / name);
    outputs.write(folder / name, "new");
  }
  outputs.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
  EXPECT_EQ(readBytes(folder / "real"), "new");
  EXPECT_EQ(readBytes(folder / "later"), "new");
}

TEST_F(OutputFiles, FoldersDevicesAndProtectedFilesAreRefused) {
  fs::create_directory(folder / "folder.png");
  fs::create_symlink("/dev/full", folder / "device.png");
  folder.write("protected.png", "old");
  fs::permissions(folder / "protected.png", fs::perms::owner_read);
  for (const fs::path& path :
       {folder / "folder.png", folder / "folder.png/", folder / "device.png",
        folder / "missing/a.png", folder / "protected.png",
        folder / (std::string(300, 'n') + ".png"), fs::path("/dev/null"), fs::path("/proc/a.png")})
    catchError(ErrorKind::output, ": " + path.string(), [&] { outputs.add(path); });
  EXPECT_EQ(fileCount(), 3u);
}

TEST_F(OutputFiles, FileOfAnotherUserInStickyFolderIsRefused) {
  if (::geteuid() != 0)
    GTEST_SKIP() << "requires root, to change the owner of a file";
  constexpr uid_t owner = 1234, other = 1235;
  folder.write("theirs.png", "old");
  ::chmod((folder / "theirs.png").c_str(), 0666);
  ::chmod(folder.path().c_str(), 01777);
  ASSERT_EQ(::chown((folder / "theirs.png").c_str(), owner, owner), 0);
  outputs.add(folder / "theirs.png"); // allowed for root
  ASSERT_EQ(::seteuid(other), 0);
  catchError(ErrorKind::output, "unwritable-file", [&] { Outputs().add(folder / "theirs.png"); });
  EXPECT_EQ(::seteuid(0), 0);
}

TEST_F(OutputFiles, NameOf255BytesIsWritten) {
  const std::string name = std::string(251, 'n') + ".png"; // 255 bytes
  outputs.add(folder / name);
  outputs.write(folder / name, "new");
  outputs.commit();
  EXPECT_EQ(readBytes(folder / name), "new");
}

TEST_F(OutputFiles, ReplacedFileKeepsModeAndOwner) {
  folder.write("private", "old");
  ::chmod((folder / "private").c_str(), 0600);
  const bool isRoot = ::geteuid() == 0;
  if (isRoot) {
    ASSERT_EQ(::chown((folder / "private").c_str(), 1234, 1235), 0);
  }
  for (const char* name : {"private", "fresh"}) {
    outputs.add(folder / name);
    outputs.write(folder / name, "new");
  }
  outputs.commit();
  EXPECT_EQ(readMode(folder / "private"), 0600u);
  struct stat status = {};
  ASSERT_EQ(::stat((folder / "private").c_str(), &status), 0);
  if (isRoot) {
    EXPECT_EQ(status.st_uid, 1234u);
    EXPECT_EQ(status.st_gid, 1235u);
  }
  const fs::path usual = folder.write("usual", "");
  EXPECT_EQ(readMode(folder / "fresh"), readMode(usual));
}

TEST_F(OutputFiles, ReplacementOfAPrivateFileIsPrivateMeanwhile) {
  folder.write("private", "old");
  ::chmod((folder / "private").c_str(), 0600);
  outputs.add(folder / "private");
  outputs.write(folder / "private", "new");
  EXPECT_EQ(fileCount(), 2u);
  for (const auto& entry : fs::directory_iterator(folder.path()))
    EXPECT_EQ(readMode(entry.path()), 0600u) << entry.path();
}

TEST_F(OutputFiles, DefaultNameReplacesOnlyTaggedFiles) {
  folder.write("theirs", "file of another program");
  const std::string ours = sealProvenanceTag("x " + std::string(blankProvenanceTag) + "12345 y");
  folder.write("ours", ours);
  folder.write("ours.end",
               sealProvenanceTag(std::string(1 << 20, 'x') + std::string(blankProvenanceTag)));
  for (const std::size_t before : {9U, 19U, 25U}) // the tag crosses the end of a 1 MB block
    folder.write("ours." + std::to_string(before),
                 sealProvenanceTag(std::string((1 << 20) - before, 'x') +
                                   std::string(blankProvenanceTag) + "1 2"));
  folder.write("edited", "an" + ours);
  folder.write("edited.end", ours + " and more");
  folder.write("claimed", std::string(blankProvenanceTag));
  std::string many; // each tag would need a checksum of the complete file
  for (int i = 0; i < 100; ++i)
    many += blankProvenanceTag;
  folder.write("many", many);
  for (const char* name : {"theirs", "edited", "edited.end", "claimed", "many"})
    catchError(ErrorKind::request, "foreign-output",
               [&] { outputs.add(folder / name, hasProvenanceTag); });
  outputs.add(folder / "ours", hasProvenanceTag);
  outputs.add(folder / "ours.end", hasProvenanceTag);
  for (const char* name : {"ours.9", "ours.19", "ours.25"})
    outputs.add(folder / name, hasProvenanceTag);
  outputs.add(folder / "new", hasProvenanceTag);
}

TEST_F(OutputFiles, FileCreatedMeanwhileIsNotReplaced) {
  outputs.add(folder / "a", hasProvenanceTag);
  outputs.write(folder / "a", "new");
  folder.write("a", "another program's");
  catchError(ErrorKind::request, "foreign-output", [&] { outputs.commit(); });
  EXPECT_EQ(readBytes(folder / "a"), "another program's");
}

TEST_F(OutputFiles, DescriptorsAndPipesAreWrittenAtCommit) {
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  const int file = ::open((folder / "open").c_str(), O_RDWR | O_CREAT, 0600);
  const std::string descriptor = "/dev/fd/" + std::to_string(file);
  outputs.add(pipe);
  outputs.add(descriptor);
  outputs.write(pipe, "piped");
  outputs.write(descriptor, "described");
  EXPECT_EQ(readBytes(folder / "open"), "");
  outputs.commit();
  char text[16] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 5);
  EXPECT_STREQ(text, "piped");
  EXPECT_EQ(readBytes(folder / "open"), "described");
  ::close(reader);
  ::close(file);
  outputs.write(pipe, "no reader");
  catchError(ErrorKind::output, "unwritable-file", [&] { outputs.commit(); });
  catchError(ErrorKind::output, "unwritable-file: /dev/fd/987",
             [&] { outputs.add("/dev/fd/987"); });
}

TEST_F(OutputFiles, CleanupPreservesFilesOfCommittingRun) {
  folder.write("a", "old");
  TemporaryFile file(folder / "a");
  file.write("new");
  file.finish(Durability::none);
  file.place();
  removeStaleTempFiles(folder.path(), tempFilePrefix,
                       TempFileGuard::Kind::file); // as another run does
  file.undoPlace();
  EXPECT_EQ(readBytes(folder / "a"), "old");
}

TEST_F(OutputFiles, NextRunRemovesFilesOfKilledRuns) {
  const std::string stale = makeTempName(tempFilePrefix);
  const std::string inUse = makeTempName(tempFilePrefix);
  folder.write(stale, "stale");
  for (const char* name : {".fenestra-notes", ".fenestra-0123456789ab"})
    folder.write(name, "of a user");
  const int active = ::open(folder.write(inUse, "in use").c_str(), O_RDONLY);
  ASSERT_EQ(::flock(active, LOCK_EX), 0);
  outputs.add(folder / "a");
  EXPECT_FALSE(fs::exists(folder / stale));
  EXPECT_TRUE(fs::exists(folder / inUse));
  for (const char* name : {".fenestra-notes", ".fenestra-0123456789ab"})
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  ::close(active);
}

TEST_F(OutputFiles, NamesOfTemporaryFilesAreRefused) {
  const fs::path path = folder / makeTempName(tempFilePrefix);
  catchError(ErrorKind::request, "output-conflict", [&] { outputs.add(path); });
}

TEST_F(OutputFiles, CommitWaitsForFolderLock) {
  outputs.add(folder / "a");
  outputs.write(folder / "a", "new");
  const int other = ::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  std::future<void> commit = std::async(std::launch::async, [this] { outputs.commit(); });
  EXPECT_EQ(commit.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  EXPECT_FALSE(fs::exists(folder / "a"));
  ::close(other);
  commit.get();
  EXPECT_EQ(readBytes(folder / "a"), "new");
}

TEST_F(OutputFiles, WrittenReturnsStateAtCommit) {
  for (const char* name : {"a", "b"})
    outputs.add(folder / name);
  outputs.write(folder / "a", "new");
  outputs.commit();
  folder.write("a", "another's");
  EXPECT_EQ(outputs.writtenDigest(folder / "a"), digestContent("new"));
  EXPECT_EQ(outputs.writtenDigest(folder / "b"), std::nullopt);
}

TEST_F(OutputFiles, NameLockIsExclusive) {
  const fs::path name = folder / "turn.turntable.json";
  {
    const NameLock first(name);
    EXPECT_TRUE(first.isHeld());
    EXPECT_FALSE(NameLock(name).isHeld());
    EXPECT_TRUE(NameLock(folder / "others.turntable.json").isHeld());
    removeStaleTempFiles(folder.path(), tempFilePrefix, TempFileGuard::Kind::file);
    EXPECT_FALSE(NameLock(name).isHeld()) << "after another run removed stale files";
    EXPECT_EQ(fileCount(), 1u);
  }
  EXPECT_EQ(fileCount(), 0u);
  EXPECT_TRUE(NameLock(name).isHeld());
  catchError(ErrorKind::output, "unwritable-file", [&] { NameLock(folder / "nowhere/a"); });
}

/// Paths in archives may be longer than file names.
TEST_F(OutputFiles, OverlongNameIsNotReportedAsRemaining) {
  { const TempFileGuard file(folder / std::string(300, 'x'), TempFileGuard::Kind::file); }
  EXPECT_EQ(remainingTempFiles(), std::vector<fs::path>());
}

TEST_F(OutputFiles, LockedTemporaryFileIsNotRemoved) {
  const TemporaryFile file(folder / "a");
  removeStaleTempFiles(
      folder.path(), tempFilePrefix,
      TempFileGuard::Kind::file); // another descriptor and lock, as in another process
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(OutputFiles, NewFilesFollowTheUmaskOfTheMoment) {
  for (const mode_t mask : {0027U, 0U}) {
    const mode_t before = ::umask(mask);
    const std::string name = std::to_string(mask);
    outputs.add(folder / name);
    outputs.write(folder / name, "new");
    outputs.commit();
    EXPECT_EQ(::umask(before), mask);
    EXPECT_EQ(readMode(folder / name), 0666 & ~mask);
  }
}

TEST(PrivateFolders, ANewFolderRemovesThoseOfKilledRuns) {
  const TemporaryFolder temporary;
  const std::string before = std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/tmp";
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  const fs::path stale = temporary / makeTempName("fenestra-scene-");
  fs::create_directory(stale);
  fs::permissions(stale, fs::perms::owner_all);
  const PrivateFolder folder;
  ::setenv("TMPDIR", before.c_str(), 1);
  EXPECT_FALSE(fs::exists(stale));
}

TEST(PrivateFolders, NextRunRemovesFoldersOfKilledRuns) {
  const TemporaryFolder temporary;
  const std::string before = std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/tmp";
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  const std::string stale = makeTempName("fenestra-scene-");
  fs::create_directories(temporary / stale / "Data");
  fs::permissions(temporary / stale, fs::perms::owner_all);
  temporary.write(stale + "/Data/patient.nrrd", "stale");
  const std::string shared = makeTempName("fenestra-scene-");
  const std::vector<std::string> others = {"fenestra-others", "fenestra-scene-of-mine",
                                           "fenestra-scene-0123456789ab", shared};
  for (const std::string& name : others) {
    fs::create_directory(temporary / name);
    if (name != shared)
      fs::permissions(temporary / name, fs::perms::owner_all);
  }
  PrivateFolder active;
  const fs::path file = active.add("Data/a.nrrd");
  removeStaleFolders();
  EXPECT_FALSE(fs::exists(temporary / stale));
  EXPECT_TRUE(fs::exists(file));
  for (const std::string& name : others)
    EXPECT_TRUE(fs::exists(temporary / name));
  ::setenv("TMPDIR", before.c_str(), 1);
}

TEST(PrivateFolders, FolderIsRemovedWithContent) {
  fs::path path;
  {
    PrivateFolder folder;
    path = folder.path();
    folder.add("a/b/c.nrrd");
    folder.add("a/d.nrrd");
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
  }
  EXPECT_FALSE(fs::exists(path));
}

} // namespace
} // namespace fenestra::core::OutputsTests
