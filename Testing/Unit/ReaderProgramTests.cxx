// Programs that use the file readers as a library: they start fenestra-reader, which must be
// complete, in its place, and of the same build. SandboxHost is such a program.

#include "io/ReaderProgram.h"

#include "DicomSliceFiles.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>
#include <itkAffineTransform.h>
#include <itkHDF5TransformIO.h>
#include <itkTransformFileWriter.h>

#include <array>
#include <cstdio>

namespace fenestra::core::ReaderProgramTests {
namespace {

using Path = std::filesystem::path;

Path findBuiltProgram(const std::string& name) {
  return std::filesystem::canonical("/proc/self/exe").parent_path() / name;
}

/// A DICOM series and a transform, which need different libraries; as arguments.
std::string writeInputs(const TemporaryFolder& folder) {
  std::filesystem::create_directory(folder / "dicom");
  for (int i = 0; i < 2; ++i)
    folder.write("dicom/" + std::to_string(i),
                 dicomSlices::makeSlice({.value = 5.0, .position = Vec3(0, 0, i), .instance = i}));
  const auto transform = itk::AffineTransform<double, 3>::New();
  const auto writer = itk::TransformFileWriterTemplate<double>::New();
  writer->SetTransformIO(itk::HDF5TransformIOTemplate<double>::New());
  writer->SetFileName((folder / "t.h5").string());
  writer->SetInput(transform);
  writer->Update();
  return " '" + (folder / "dicom").string() + "' '" + (folder / "t.h5").string() + "'";
}

/// Standard output and error of a command.
std::string runCommand(const std::string& command) {
  std::string output;
  std::array<char, 4096> part;
  std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), count);
  ::pclose(pipe);
  return output;
}

/// Copies of SandboxHost, and of a reader, in a folder of their own.
struct Installation {
  TemporaryFolder folder;
  Path host = folder / "host";

  Installation() { std::filesystem::copy_file(findBuiltProgram("SandboxHost"), host); }
  void installReader(const Path& name) const {
    std::filesystem::create_directories((folder.path() / name).parent_path());
    std::filesystem::copy_file(findBuiltProgram(readerName), folder.path() / name);
  }
  /// A program that tells `build` and ends.
  void installOtherReader(const std::string& build) const {
    const char size[] = {'\\', static_cast<char>('0' + build.size() / 8),
                         static_cast<char>('0' + build.size() % 8), '\0'};
    folder.write(readerName, "#!/bin/sh\nprintf '" + std::string(size) +
                                 R"(\000\000\000\000\000\000\000)" + build + "' >&3\n");
    std::filesystem::permissions(folder / readerName, std::filesystem::perms::owner_all);
  }
  std::string run(const std::string& arguments) const {
    return runCommand("'" + host.string() + "' " + arguments);
  }
};

TEST(ReaderProgram, ServesAllReadersFromTheFoldersOfTheLibrary) {
  const TemporaryFolder folder;
  const std::string inputs = writeInputs(folder);
  EXPECT_EQ(runCommand("'" + findBuiltProgram("SandboxHost").string() + "'" + inputs), "2 read");
  for (const char* place : {readerName, "fenestra/fenestra-reader"}) {
    const Installation installation;
    installation.installReader(place);
    EXPECT_EQ(installation.run(inputs), "2 read") << place;
  }
}

TEST(ReaderProgram, IsFoundFromAnyFolderByAnyName) {
  const TemporaryFolder folder;
  const std::string inputs = writeInputs(folder);
  const Installation installation;
  installation.installReader(readerName);
  std::filesystem::create_symlink(installation.host, folder / "link");
  EXPECT_EQ(runCommand("cd / && PATH='" + folder.path().string() + "' link" + inputs), "2 read");
}

TEST(ReaderProgram, IsNotNeededInProcess) {
  const TemporaryFolder folder;
  const std::string inputs = writeInputs(folder);
  const Installation installation;
  EXPECT_EQ(installation.run("in-process" + inputs + inputs), "4 read");
}

TEST(ReaderProgram, DamagedFilesGiveTheSameErrorInProcess) {
  const TemporaryFolder folder;
  writeInputs(folder);
  const std::string slice = readBytes(folder / "dicom/0"), transform = readBytes(folder / "t.h5");
  folder.write("damaged.dcm", slice.substr(0, slice.size() - 4));
  folder.write("damaged.h5", transform.substr(0, transform.size() / 2));
  const Installation alone, complete;
  complete.installReader(readerName);
  for (const char* name : {"damaged.dcm", "damaged.h5"}) {
    const std::string argument = "'" + (folder / name).string() + "'";
    const std::string output = alone.run("in-process " + argument);
    EXPECT_NE(output.find(name), std::string::npos) << output;
    EXPECT_EQ(output, complete.run(argument));
  }
}

/// Expects the error of this code, which names `place`.
void expectRefusal(const Installation& installation, const std::string& code, const Path& place) {
  const TemporaryFolder folder;
  const std::string output = installation.run(writeInputs(folder));
  EXPECT_TRUE(output.starts_with(code + ": ")) << output;
  EXPECT_NE(output.find(place.string()), std::string::npos) << output;
  EXPECT_EQ(output.find('\n'), std::string::npos) << output;
}

TEST(ReaderProgram, AMissingReaderIsAnErrorThatNamesThePlace) {
  const Installation installation;
  expectRefusal(installation, "missing-file", installation.host);
}

TEST(ReaderProgram, AReaderOfAnotherBuildIsAnError) {
  const Installation installation;
  installation.installOtherReader("0.0.1 x");
  expectRefusal(installation, "invalid-file", installation.folder / readerName);
  installation.installOtherReader(""); // does not know the job
  expectRefusal(installation, "invalid-file", installation.folder / readerName);
}

TEST(ReaderProgram, AProgramThatIsNoReaderIsAnError) {
  const Installation installation;
  installation.folder.write(readerName, "#!/bin/sh\nexit 0\n");
  expectRefusal(installation, "unreadable-file", installation.folder / readerName);
  std::filesystem::permissions(installation.folder / readerName, std::filesystem::perms::owner_all);
  expectRefusal(installation, "out-of-memory", installation.folder / readerName);
}

} // namespace
} // namespace fenestra::core::ReaderProgramTests
