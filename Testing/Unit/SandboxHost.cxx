// A program that uses the file readers as a library does: its main does not call serveSandbox.
// Prints the number of files read, or the error. For ReaderProgramTests.
// usage: SandboxHost [in-process] FILE...   FILE: a DICOM file or folder, or a transform (.h5)

#include "base/Error.h"
#include "files/medical/DicomSeries.h"
#include "files/slicer/TransformFile.h"
#include "io/InputRegistry.h"

#include <iostream>
#include <optional>

int main(int argc, char** argv) {
  using namespace fenestra::core;
  std::vector<std::filesystem::path> files(argv + 1, argv + argc);
  std::optional<InProcessReading> inProcess;
  if (!files.empty() && files.front() == "in-process") {
    inProcess.emplace();
    files.erase(files.begin());
  }
  try {
    for (const std::filesystem::path& file : files)
      if (file.extension() != ".dcm" && !isFolder(file))
        readLinearTransform(file);
      else
        readDicomVolume(isFolder(file) ? listFolder(file).files : std::vector{file}, file);
    std::cout << files.size() << " read";
  } catch (const Error& error) {
    std::cout << toString(error.message().code) << ": " << error.what();
  }
}
