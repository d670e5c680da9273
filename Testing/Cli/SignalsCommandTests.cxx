// Signals that stop a render: exit status 5 at once, with complete files of the finished passes.
// "At once" is a limit of processor time, so that a busy machine passes.

#include "CommandTesting.h"
#include "RunSettings.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

namespace fenestra::core::SignalsCommandTests {
namespace {

/// Limit of the processor time in seconds from the signal to the end: about 0.1 is needed, more by
/// slow builds.
const double cpuLimit = 2.0 * static_cast<double>(testing::slowdownFactor());

class SignalsCommand : public SmallScene, public ::testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(All, SignalsCommand, ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT),
                         [](const auto& info) { return ::sigabbrev_np(info.param); });

TEST_P(SignalsCommand, FirstSignalWritesFinishedPasses) {
  Process process({"volume.nrrd", "--size", "64x64", "--samples", "20000", "--threads", "2",
                   "--progress", "xml", "--output", "a.exr", "--output", "a.png", "--stats-json",
                   "a.json"},
                  folder.path());
  ASSERT_TRUE(process.waitForOutput("<filter-progress>0\\.0*[1-9]"));
  process.send(GetParam());
  process.send(GetParam()); // a terminal may send a signal twice
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_LT(outcome.cpuSeconds, cpuLimit);
  EXPECT_NE(outcome.result.find("stopped on request"), std::string::npos) << outcome.messages;
  const Image image = readImage(folder / "a.exr");
  const auto samples = std::stoull(image.header.at("samples"));
  EXPECT_GE(samples, 1u);
  EXPECT_LT(samples, 20000u);
  for (const float count : *image.find("samples.N"))
    EXPECT_GE(count, static_cast<float>(samples));
  EXPECT_EQ(readImage(folder / "a.png").width, 64);
  EXPECT_EQ(nlohmann::json::parse(readBytes(folder / "a.json"))["samplesPerPixel"]["min"], samples);
  EXPECT_EQ(listFiles(folder.path()).size(), 5u); // two inputs, three results
}

TEST_P(SignalsCommand, SecondSignalEndsImmediatelyWithoutWriting) {
  folder.write("a.exr", "old");
  const auto before = listFiles(folder.path());
  // Neither a pass nor a path ends during the test: the medium scatters without absorption.
  folder.write("dense.json", R"({"extinction": [[0, 1e4], [64, 1e4]], "albedo": [[0, 1, 1, 1]]})");
  Process process({"volume.nrrd", "--transfer", "dense.json", "--size", "1024x1024", "--samples",
                   "100000", "--bounces", "1000000", "--threads", "2", "--progress", "xml",
                   "--output", "a.exr"},
                  folder.path());
  ASSERT_TRUE(process.waitForOutput("<filter-start>"));
  process.send(GetParam());
  std::this_thread::sleep_for(std::chrono::milliseconds(400)); // an earlier one is a repetition
  process.send(GetParam());
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_LT(outcome.cpuSeconds, cpuLimit);
  EXPECT_EQ(readBytes(folder / "a.exr"), "old");
  std::filesystem::remove(folder / "dense.json");
  EXPECT_EQ(listFiles(folder.path()), before);
}

TEST_P(SignalsCommand, SignalIgnoredAtStartStaysIgnored) {
  std::signal(GetParam(), SIG_IGN); // as set by nohup and for background jobs
  Process process({"volume.nrrd", "--size", "64x64", "--samples", "500", "--progress", "xml",
                   "--output", "a.png"},
                  folder.path());
  std::signal(GetParam(), SIG_DFL);
  ASSERT_TRUE(process.waitForOutput("<filter-progress>0\\.0*[1-9]"));
  process.send(GetParam());
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
}

TEST_P(SignalsCommand, SignalRemovesUnpackedFilesOfAnArchive) {
  const std::filesystem::path& knee = kneeFolder().path();
  const TemporaryFolder temporary;
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  Process process({"knee/knee.mrb", "--size", "256x256", "--samples", "100000", "--progress", "xml",
                   "--output", "never.png"},
                  knee);
  ::unsetenv("TMPDIR");
  ASSERT_TRUE(process.waitForOutput("<filter-start>"));
  process.send(GetParam());
  EXPECT_EQ(process.wait().status, 5);
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
  std::filesystem::remove(knee / "never.png"); // exists if a pass was finished
}

TEST_P(SignalsCommand, SignalBeforeTheFirstPassWritesNothing) {
  const auto before = listFiles(kneeFolder().path());
  Process process({"knee/knee.nrrd", "--size", "1024x1024", "--samples", "1000000",
                   "--density-scale", "1000", "--threads", "2", "--progress", "xml"},
                  kneeFolder().path()); // its first pass takes minutes
  ASSERT_TRUE(process.waitForOutput("<filter-start>"));
  process.send(GetParam());
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_LT(outcome.cpuSeconds, cpuLimit);
  EXPECT_EQ(outcome.err,
            "fenestra: stopped on request before the first pass; no image was written\n");
  EXPECT_EQ(listFiles(kneeFolder().path()), before);
}

TEST_P(SignalsCommand, SignalWhileLoadingWritesNothing) {
  folder.write("large.nrrd", NrrdText{"800 800 400", "uint8"}.encode(""));
  std::filesystem::resize_file(folder / "large.nrrd",
                               std::filesystem::file_size(folder / "large.nrrd") + 256'000'000);
  const auto before = listFiles(folder.path());
  Process process({"large.nrrd", "--size", "16x16", "--samples", "1"}, folder.path());
  ASSERT_TRUE(process.waitUntilOpen(folder / "large.nrrd"));
  process.send(GetParam());
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_LT(outcome.cpuSeconds, cpuLimit);
  EXPECT_EQ(outcome.err, "fenestra: stopped on request; nothing was written\n");
  EXPECT_EQ(listFiles(folder.path()), before);
}

TEST_P(SignalsCommand, SignalRemovesFilesOfAnUnfinishedPhantom) {
  const auto before = listFiles(folder.path());
  Process process({"phantom", "knee"}, folder.path());
  ASSERT_TRUE(process.waitUntilHandling(GetParam()));
  process.send(GetParam());
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_LT(outcome.cpuSeconds, cpuLimit);
  EXPECT_EQ(listFiles(folder.path()), before);
}

class BrokenPipe : public SmallScene {};

/// Text that was asked for: whoever closes the pipe, such as `head`, has seen enough.
TEST_F(BrokenPipe, EndsTextQuietlyWithStatus0) {
  ASSERT_EQ(renderVolume({"--output", "a.exr"}).status, 0);
  for (const auto handler : {SIG_DFL, SIG_IGN}) {
    std::signal(SIGPIPE, handler); // ignored by some shells and by Python
    for (const Arguments& arguments : {Arguments{"inspect", "volume.nrrd"},
                                       {"inspect", "volume.nrrd", "--json"},
                                       {"compare", "a.exr", "a.exr"},
                                       {"describe", "man"},
                                       {"--help"},
                                       {"help", "all"},
                                       {"turntable", "--help"},
                                       {"--version"},
                                       {"--xml"}}) {
      Process process(arguments, folder.path(), Stdout::closedPipe);
      std::signal(SIGPIPE, SIG_DFL);
      const Outcome outcome = process.wait();
      EXPECT_EQ(outcome.status, 0) << arguments.front() << outcome.messages;
      EXPECT_EQ(outcome.messages, "") << arguments.front();
    }
  }
}

TEST_F(BrokenPipe, EndsTheRenderWithStatus4) {
  folder.write("a.png", "old");
  const auto before = listFiles(folder.path());
  Process process({"volume.nrrd", "--size", "64x64", "--samples", "1000000", "--progress", "xml",
                   "--output", "a.png"},
                  folder.path(), Stdout::closedPipe); // without the pipe it would take hours
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 4) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_EQ(listFiles(folder.path()), before);
}

} // namespace
} // namespace fenestra::core::SignalsCommandTests
