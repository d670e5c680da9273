// Locates files of a scene: beside a .mrml, inside a .mrb, and outside either.

#include "SceneTesting.h"

#include <random>

namespace fenestra::core::SceneFilesTests {
namespace {

std::string readLocated(SceneFiles& files, const std::string& name) {
  return readBytes(files.locate(name));
}

TEST(SceneFiles, FindsFilesBesideTheScene) {
  const TemporaryFolder folder;
  folder.write("a b.txt", "escaped");
  folder.write("50%.txt", "percent");
  folder.write("%20.txt", "an escaped escape");
  folder.write("it's <\"x\">.txt", "all six");
  folder.write("plus+%41.txt", "not an escape");
  std::filesystem::create_directory(folder / "sub");
  const auto scene = folder.write("sub/scene.MRML", "<MRML/>");
  SceneFiles files(scene);
  EXPECT_EQ(files.sceneText(), "<MRML/>");
  EXPECT_EQ(readLocated(files, "../a%20b.txt"), "escaped");
  EXPECT_EQ(readLocated(files, "../a b.txt"), "escaped");
  EXPECT_EQ(readLocated(files, "../50%25.txt"), "percent");
  EXPECT_EQ(readLocated(files, "../%2520.txt"), "an escaped escape");
  EXPECT_EQ(readLocated(files, "../it%27s%20%3C%22x%22%3E.txt"), "all six");
  EXPECT_EQ(readLocated(files, "../plus+%41.txt"), "not an escape");
  EXPECT_EQ(readLocated(files, (folder / "a b.txt").string()), "escaped"); // absolute
  expectRefused(scene, "missing-file: nowhere.nrrd", [&] { files.locate("nowhere.nrrd"); });
}

TEST(SceneFiles, FindsFilesInAnArchiveAndRemovesUnpackedOnes) {
  const TemporaryFolder folder;
  const auto archive = folder / "my.mrb";
  writeArchive(archive, {{"Study/Study.mrml", "<MRML/>"},
                         {"Study/Data/a b.txt", "inside"},
                         {"Study/Data/", ""},
                         {"Study/Data/seq.mrml", "<MRML>of a sequence</MRML>"},
                         {"other.txt", "beside"}});
  std::filesystem::path unpacked;
  {
    SceneFiles files(archive);
    EXPECT_EQ(files.sceneText(), "<MRML/>");
    unpacked = files.locate("Data/a%20b.txt");
    EXPECT_EQ(readBytes(unpacked), "inside");
    EXPECT_EQ(unpacked.filename(), "a b.txt"); // readers depend on extensions
    EXPECT_EQ(files.locate("Data/a%20b.txt"), unpacked);
    EXPECT_EQ(readLocated(files, "../other.txt"), "beside");
    EXPECT_EQ(
        std::filesystem::status(unpacked.parent_path().parent_path().parent_path()).permissions() &
            std::filesystem::perms::others_all,
        std::filesystem::perms::none);
    const std::string known = archive.string() + "/Study/Data/a b.txt";
    EXPECT_EQ(files.translatePaths(unpacked.string() + ": odd"), known + ": odd");
    expectRefused(known, "invalid-file", [&] {
      files.read({"Data/a%20b.txt"}, [](const std::vector<std::filesystem::path>& paths) {
        throw inputError(paths.front().string(), "is damaged");
      });
    });
    expectRefused(archive, "outside-archive", [&] { files.locate("../../up.txt"); });
    expectRefused(archive, "outside-archive", [&] { files.locate("/etc/passwd"); });
    expectRefused(archive, "missing-file: Data/missing.txt",
                  [&] { files.locate("Data/missing.txt"); });
  }
  EXPECT_FALSE(std::filesystem::exists(unpacked));
  EXPECT_FALSE(std::filesystem::exists(unpacked.parent_path().parent_path().parent_path()));
}

TEST(SceneFiles, UnpacksFilesNamedInAHeader) {
  const TemporaryFolder folder;
  const auto archive = folder / "my.mrb";
  writeArchive(archive, {{"s/s.mrml", "<MRML/>"},
                         {"s/v.nhdr", "NRRD0004\ndata file: Data/v.raw\n\n"},
                         {"s/Data/v.raw", "samples"},
                         {"s/w.nhdr", "NRRD0004\ndata file: ../../out.raw\n\n"},
                         {"s/b.vtm", "<VTKFile><DataSet file=\"b/1.vtp\"/></VTKFile>"},
                         {"s/b/1.vtp", "surface"}});
  SceneFiles files(archive);
  EXPECT_EQ(readBytes(files.locate("v.nhdr").parent_path() / "Data/v.raw"), "samples");
  EXPECT_EQ(files.locate("Data/v.raw"), files.locate("v.nhdr").parent_path() / "Data/v.raw");
  EXPECT_EQ(readBytes(files.locate("b.vtm").parent_path() / "b/1.vtp"), "surface");
  files.locate("w.nhdr"); // the reader refuses it later
}

TEST(SceneFiles, ErrorIsOneLineForNamesWithLineBreaks) {
  const TemporaryFolder folder;
  writeArchive(folder / "a.mrb", {{"a.mrml", "<MRML/>"}});
  SceneFiles archive(folder / "a.mrb");
  expectRefused(folder / "a.mrb", "missing-file: a b", [&] { archive.locate("a\nb"); });
  expectRefused(folder / "a.mrb", "outside-archive: ../a b", [&] { archive.locate("../a\nb"); });
  const auto scene = folder.write("a.mrml", "<MRML/>");
  SceneFiles beside(scene);
  expectRefused(scene, "missing-file: a b", [&] { beside.locate("a\nb"); });
}

TEST(SceneFiles, UnpacksAFileOnlyOnRequest) {
  const TemporaryFolder folder;
  const TemporaryFolder temporary;
  setenv("TMPDIR", temporary.path().c_str(), 1);
  writeArchive(folder / "a.mrb", {{"a.mrml", "<MRML/>"}, {"big", std::string(1000, 'x')}});
  {
    SceneFiles files(folder / "a.mrb");
    EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
    files.locate("big");
    EXPECT_FALSE(std::filesystem::is_empty(temporary.path()));
    removeAllTempFiles(); // as the signal handler does
    EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
  }
  unsetenv("TMPDIR");
}

TEST(SceneFiles, ChoosesTheMainSceneAsSlicerDoes) {
  const TemporaryFolder folder;
  const auto readMainScene = [&](const std::map<std::string, std::string>& files) {
    writeArchive(folder / "case.mrb", files);
    return SceneFiles(folder / "case.mrb").sceneText();
  };
  EXPECT_EQ(readMainScene({{"a/deep/z.mrml", "deep"}, {"z/main.mrml", "main"}}), "main");
  EXPECT_EQ(readMainScene({{"x/case.mrml", "named"}, {"x/other.mrml", "other"}}), "named");
  EXPECT_EQ(readMainScene({{"x/x.mrml", "like its folder"}, {"x/other.mrml", "other"}}),
            "like its folder");
  expectRefused(folder / "case.mrb", "ambiguous-name | x/a.mrml, x/b.mrml", [&] {
    readMainScene({{"x/a.mrml", ""}, {"x/b.mrml", ""}});
  });
  expectRefused(folder / "case.mrb", "unsupported-file", [&] { readMainScene({{"x/a.txt", ""}}); });
}

TEST(SceneFiles, RefusesDamagedAndEscapingArchives) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::map<std::string, std::string>& files,
                          const std::string& reason) {
    writeArchive(folder / "bad.mrb", files);
    expectRefused(folder / "bad.mrb", reason, [&] { SceneFiles(folder / "bad.mrb"); });
  };
  refuse({{"a.mrml", "<MRML/>"}, {"../../evil", "x"}}, "outside-archive");
  refuse({{"a.mrml", "<MRML/>"}, {"/etc/evil", "x"}}, "outside-archive");
  refuse({{"a.mrml", "<MRML/>"}, {"x/../../evil", "x"}}, "outside-archive");

  const auto textFile = folder.write("words.mrb", "not an archive");
  expectRefused(textFile, "damaged-file", [&] { SceneFiles files(textFile); });
  writeArchive(folder / "whole.mrb", {{"a.mrml", "<MRML/>" + std::string(5000, ' ')}});
  const std::string bytes = readBytes(folder / "whole.mrb");
  const auto truncated = folder.write("half.mrb", bytes.substr(0, bytes.size() / 2));
  expectRefused(truncated, "damaged-file", [&] { SceneFiles files(truncated); });
}

TEST(SceneFiles, RefusesNamesThatAreTooLong) {
  const TemporaryFolder folder;
  std::string deep;
  for (int i = 0; i < 60; ++i)
    deep += std::string(100, 'd') + "/";
  for (const std::string& name : {deep + "a.nrrd", std::string(300, 'n')}) {
    writeArchive(folder / "long.mrb", {{"a.mrml", "<MRML/>"}, {name, "x"}});
    SceneFiles files(folder / "long.mrb");
    expectRefused(folder / "long.mrb", "limit-exceeded", [&] { files.locate(name); });
  }
}

TEST(SceneFiles, RefusesEntriesBeyondTheSizeLimit) {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  std::string noise(2'000'000, '\0');
  for (char& byte : noise)
    byte = static_cast<char>(random());
  writeArchive(folder / "a.mrb", {{"a.mrml", "<MRML/>"}, {"big", noise}});
  std::string bytes = readBytes(folder / "a.mrb");
  const std::size_t entry = bytes.rfind("PK\1\2"); // last entry of the central directory
  ASSERT_EQ(bytes.substr(entry + 46, 3), "big");
  for (const char* size : {"\0\0\0\x60", "\0\0\0\x70"}) { // 1.6 and 1.9 GB
    bytes.replace(entry + 24, 4, size, 4);                // its unpacked size
    folder.write("b.mrb", bytes);
    SceneFiles files(folder / "b.mrb");
    expectRefused(folder / "b.mrb", "limit-exceeded", [&] { files.locate("big"); });
  }
}

TEST(SceneFiles, RefusesDamagedAndOversizedEntries) {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  std::string noise(4000, ' '); // incompressible, hence stored
  std::generate(noise.begin(), noise.end(), [&] { return static_cast<char>(random() & 0xff); });
  writeArchive(folder / "a.mrb", {{"a.mrml", "<MRML/>"}, {"data", noise}});
  std::string bytes = readBytes(folder / "a.mrb");
  const std::size_t at = bytes.find(noise.substr(2000, 8));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  const auto damaged = folder.write("damaged.mrb", bytes);
  SceneFiles files(damaged);
  expectRefused(damaged, "damaged-file: data", [&] { files.locate("data"); });

  // Sets the uncompressed size in the central directory to almost 4 GB.
  bytes = readBytes(folder / "a.mrb");
  const std::size_t directory = bytes.find("PK\x01\x02", bytes.find("PK\x01\x02") + 4);
  ASSERT_NE(directory, std::string::npos);
  bytes.replace(directory + 24, 4, "\xfe\xff\xff\xff");
  const auto boundless = folder.write("oversized.mrb", bytes);
  expectRefused(boundless, "", [&] {
    SceneFiles archive(boundless);
    archive.locate("data");
  });
}

} // namespace
} // namespace fenestra::core::SceneFilesTests
