// The program fenestra-reader: reads files for programs that use Fenestra as a library, in a
// sandboxed process of its own (io/Sandbox.h).

#include "files/medical/DicomFields.h"
#include "files/medical/DicomObjects.h"
#include "files/medical/SliceFile.h"
#include "files/slicer/TransformFile.h"

#include <iostream>

int main(int argc, char** argv) {
  using namespace fenestra::core;
  serveSandbox(argc, argv);
  std::cerr << "fenestra-reader: is started by the library Fenestra, to read:";
  // Naming the jobs links them.
  for (const SandboxJob* job : {&dicomJob, &dicomFramesJob, &objectJob, &sliceJob, &transformJob})
    std::cerr << ' ' << job->name;
  std::cerr << '\n';
  return 2;
}
