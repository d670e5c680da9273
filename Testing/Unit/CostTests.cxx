// Cost of reading n items compared with 2 n, in instructions counted by valgrind, which unlike time
// are reproducible. Skipped without valgrind.

#include "files/medical/MedicalHeader.h"
#include "files/slicer/ScenePlan.h"
#include "io/JsonNode.h"

#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <functional>

#if __has_include(<valgrind/callgrind.h>)
#include <hwy/nanobenchmark.h>
#include <valgrind/callgrind.h>

#include <sys/wait.h>

/// Replaces libhwy's measurement of its timer, which runs when the library is loaded: its
/// instruction (rdtscp) ends valgrind on a processor that does not announce it, as virtual ones do.
uint64_t hwy::platform::TimerResolution() {
  return 1;
}

namespace fenestra::core::CostTests {
namespace {

constexpr const char* countsVariable = "FENESTRA_COUNTS"; ///< files written by valgrind

/// Counts the instructions of one call.
double countInstructions(const std::function<void()>& work) {
  static int dumps = 0;
  CALLGRIND_ZERO_STATS;
  work();
  CALLGRIND_DUMP_STATS;
  std::ifstream counts(std::string(std::getenv(countsVariable)) + "." + std::to_string(++dumps));
  for (std::string word; counts >> word;)
    if (double count = 0.0; (word == "totals:" || word == "summary:") && counts >> count)
      return count;
  throw std::runtime_error("valgrind reported no instruction count");
}

std::string repeat(int n, const std::function<std::string(const std::string&)>& item) {
  std::string text;
  for (int i = 0; i < n; ++i)
    text += item(std::to_string(i));
  return text;
}

/// Prepares an input of n items; returns the function that reads it.
using Prepare = std::function<std::function<void()>(int n)>;

std::function<void()> makePlan(const std::string& nodes) {
  const auto text = std::make_shared<std::string>("<MRML>" + nodes + "</MRML>");
  return [text] {
    const MrmlDocument document(*text, "test");
    planRender(document, {"v0", {}, false});
  };
}

struct Case {
  const char* name;
  int n;
  Prepare prepare;
};

std::vector<Case> makeCases(const TemporaryFolder& folder) {
  return {
      {"volumes of a scene", 2000,
       [](int n) {
         return makePlan(repeat(n, [](const std::string& i) {
           return "<Volume id='v" + i + "' displayNodeRef='d" + i + "'/><VolumeRendering id='d" +
                  i + "'/><Selection id='s" + i + "' activeVolumeID='v" + i + "'/>";
         }));
       }},
      {"views of a rendering", 2000,
       [](int n) {
         return makePlan(
             "<Volume id='v0' displayNodeRef='d'/><VolumeRendering id='d' viewNodeIDs='" +
             repeat(n, [](const std::string& i) { return "w" + i + " "; }) + "'/>" +
             repeat(n, [](const std::string& i) { return "<View id='w" + i + "'/>"; }));
       }},
      {"files of a node", 2000,
       [&folder](int n) {
         folder.write(
             "s.mrml",
             "<MRML><N id='n' storageNodeRef='s'/><S id='s' " + repeat(n, [](const std::string& i) {
               return "fileListMember" + i + "='file" + i + "' ";
             }) + "/></MRML>");
         const auto scene = std::make_shared<MrmlScene>(folder / "s.mrml");
         return [scene] { listStorageFiles(*scene, *scene->document.find("n")); };
       }},
      {"escapes of a name", 20000,
       [](int n) {
         const auto name = repeat(n, [](const std::string&) { return "%20"; });
         return [name] { decodeUrl(name); };
       }},
      {"values of JSON", 20000,
       [](int n) {
         const auto text =
             "[0" + repeat(n, [](const std::string& i) { return ",[" + i + "]"; }) + "]";
         return [text] { JsonNode(parseJson(text, "test"), "test").elements(); };
       }},
      {"lines of a header", 2000,
       [&folder](int n) {
         const auto path = folder.write(
             std::string("v").append(std::to_string(n)) + ".nrrd",
             "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n" +
                 repeat(n, [](const std::string& i) { return "key" + i + ":=value\n"; }) + "\nx");
         return [path] { locateSamples(path, MedicalFormat::nrrd); };
       }},
  };
}

/// Runs this test again under valgrind; false if valgrind cannot run.
bool runUnderValgrind(const TemporaryFolder& folder) {
  const std::string counts = folder / "counts";
  const pid_t child = ::fork();
  if (child == 0) {
    ::setenv(countsVariable, counts.c_str(), 1);
    const std::string out = "--callgrind-out-file=" + counts;
    const std::string self = std::filesystem::read_symlink("/proc/self/exe");
    ::execlp("valgrind", "valgrind", "--tool=callgrind", "-q", out.c_str(), self.c_str(),
             "--gtest_filter=Cost.*", nullptr);
    ::_exit(127);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    return false;
  EXPECT_EQ(status, 0) << "see the output of the valgrind process above";
  return true;
}

TEST(Cost, GrowsNoFasterThanNLogN) {
  const TemporaryFolder folder;
  if (!RUNNING_ON_VALGRIND) {
    if (!runUnderValgrind(folder))
      GTEST_SKIP() << "valgrind is not installed";
    return;
  }
  constexpr double maxGrowth = 2.5; // 2 (1 + 1 / log2 n) for n log n
  for (const Case& item : makeCases(folder)) {
    const double once = countInstructions(item.prepare(item.n));
    const double twice = countInstructions(item.prepare(2 * item.n));
    std::cout << item.name << ": " << once / item.n << " instructions for each of " << item.n
              << ", growing by a factor of " << twice / once << '\n';
    EXPECT_LT(twice / once, maxGrowth) << item.name;
  }
}

} // namespace
} // namespace fenestra::core::CostTests
#else
TEST(Cost, GrowsNoFasterThanNLogN) {
  GTEST_SKIP() << "valgrind is not installed";
}
#endif
