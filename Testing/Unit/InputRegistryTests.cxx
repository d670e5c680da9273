// What may be read, and the registry of what has been read.

#include "io/InputRegistry.h"

#include "ErrorChecks.h"
#include "TemporaryFolder.h"
#include "io/Outputs.h"

namespace fenestra::core::InputRegistryTests {
namespace {

namespace fs = std::filesystem;

TEST(Inputs, FilesOutsideArchiveFolderAreRefused) {
  const TemporaryFolder inside, outside;
  const fs::path member = inside.write("member", "1"), secret = outside.write("secret", "2");
  fs::create_symlink(secret, inside / "link");
  const InputConfinement confinement(inside.path());
  requireFile(member, "");
  for (const fs::path& path :
       {secret, inside / "link", inside / ".." / secret.parent_path().filename() / "secret"})
    EXPECT_THROW(requireFile(path, ""), Error) << path;
}

TEST(Inputs, FileAboveSizeLimitIsRefused) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a", std::string(100, 'x'));
  requireFile(file, "", 100);
  EXPECT_THROW(requireFile(file, "", 99), Error);
}

TEST(Inputs, WithoutARegistryFilesAreReadAndReplacedAgain) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a", "old");
  {
    const InputRegistry registry;
    requireFile(file, "");
  }
  for (const char* content : {"new", "newer"}) {
    requireFile(file, "");
    registerInput(file);
    Outputs other;
    other.add(file);
    other.write(file, content);
    other.commit();
    EXPECT_EQ(readBytes(file), content);
    requireFile(file, "");
    EXPECT_FALSE(findInput(*fileId(file)));
  }
}

TEST(Inputs, ARegistryBeginsEmpty) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a", "old");
  const FileId id = *fileId(file);
  for (int i = 0; i < 2; ++i) {
    const InputRegistry registry;
    EXPECT_FALSE(findInput(id));
    requireFile(file, "");
    EXPECT_EQ(findInput(id), file);
  }
}

/// The system ends a path at a zero byte. A folder's path with text after that byte would list the
/// folder's entries, whose paths again resolve to the folder, without end.
TEST(Inputs, ZeroByteInANameIsRefused) {
  const TemporaryFolder folder;
  const InputRegistry registry;
  const fs::path file = folder.write("a", "input");
  const std::string zero(1, '\0');
  const fs::path inFolder = folder.path().native() + zero;
  registerInput(inFolder);
  registerInput(inFolder / "a");
  const Error error = catchError(ErrorKind::input, "invalid-file",
                                 [&] { requireFile(file.native() + zero + "b", ""); });
  EXPECT_EQ(error.message().subject, file);
}

} // namespace
} // namespace fenestra::core::InputRegistryTests
