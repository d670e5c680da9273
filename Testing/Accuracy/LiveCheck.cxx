// Compares the live clipping surface with that of stills, and measures how it changes while the
// camera turns, and its processor time.
// usage: LiveCheck [FOLDER_OF_DATA]

#include "LiveMeasure.h"
#include "Subjects.h"
#include "TemporaryFolder.h"

#include <cstdio>

using namespace fenestra::core;
using namespace fenestra::core::accuracy;

namespace {

void print(const char* part, const LiveError& error) {
  std::printf(" %s mean %.3f p95 %.3f (%zu)", part, error.mean, error.p95, error.count);
}

void check(const Subject& subject) {
  const LiveSubject live(subject);
  std::printf("%s: %zu triangles\n", subject.name.c_str(), live.triangleCount());
  for (const bool isPerspective : {false, true})
    for (int number = 0; number < 4; ++number) {
      const View view = live.makeView(number, 4, 512, isPerspective);
      const LiveDifference difference = live.compare(view);
      std::printf("  view %d%s, mm:", number, isPerspective ? ", perspective" : "");
      print("focus", difference.focus);
      print("context", difference.context);
      std::printf(", per 0.1 degrees %.3f mm\n", live.measureTurn(number));
    }
  std::printf("  %.1f ms of one core per camera of 512 x 512\n", 1e3 * live.measureSeconds());
}

} // namespace

int main(int argc, char** argv) {
  const TemporaryFolder folder;
  check(makeKnee(folder.path(), ""));
  const std::filesystem::path data = argc > 1 ? argv[1] : FENESTRA_DATA;
  const std::filesystem::path torso = data / "abdomen_ct_totalseg";
  if (std::filesystem::exists(torso))
    check({"liver", torso / "ct.nii.gz", torso / "seg_multiorgan.nii.gz", "liver", 5, 1.25});
}
