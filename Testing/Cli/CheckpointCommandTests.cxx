// Checkpoint files: the same command resumes from them, and any other command is rejected.

#include "CommandTesting.h"
#include "ImageTesting.h"

#include <csignal>

namespace fenestra::core::CheckpointCommandTests {
namespace {

class CheckpointCommand : public SmallScene {
protected:
  CheckpointCommand() {
    const Outcome outcome = renderCheckpoint();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }

  Outcome renderCheckpoint(const Arguments& more = {}) const {
    Arguments all = {"--checkpoint", "a.film", "--output", "a.exr"};
    all.insert(all.end(), more.begin(), more.end());
    return renderVolume(all);
  }
  /// Error of a command with checkpoint a.film and these arguments.
  ExpectedError makeError(const std::string& name, const Arguments& arguments,
                          const std::string& text, int status = 2) const {
    Arguments all = {"volume.nrrd", "--checkpoint", "a.film", "--output", "a.exr"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return {name, all, status, text};
  }

  const Arguments sizeOfCheckpoint = {"--size", "16x16", "--samples", "2"};
};

TEST_F(CheckpointCommand, MoreSamplesResumeFromTheCheckpoint) {
  const Outcome more = run({"volume.nrrd", "--size", "16x16", "--samples", "9", "--checkpoint",
                            "a.film", "--output", "more.exr", "--threads", "1"},
                           folder.path());
  ASSERT_EQ(more.status, 0) << more.err;
  const Outcome once = run(
      {"volume.nrrd", "--size", "16x16", "--samples", "9", "--output", "once.exr"}, folder.path());
  ASSERT_EQ(once.status, 0) << once.err;
  expectSameImage(folder / "once.exr", folder / "more.exr");
}

TEST_F(CheckpointCommand, FinishedCheckpointGivesTheSameImage) {
  const std::string checkpoint = readBytes(folder / "a.film"), image = readBytes(folder / "a.exr");
  const Outcome again = renderCheckpoint({"--output", "a.png", "--denoise", "on"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(readBytes(folder / "a.film") == checkpoint);
  EXPECT_EQ(renderCheckpoint().status, 0);
  EXPECT_TRUE(readBytes(folder / "a.exr") == image);
  EXPECT_EQ(listFiles(folder.path()), (std::set<std::string>{"a.exr", "a.film", "a.png",
                                                             "segments.seg.nrrd", "volume.nrrd"}));
}

TEST_F(CheckpointCommand, StoppedRenderResumesBitIdentically) {
  const auto arguments = [](const std::string& name) {
    return Arguments{"volume.nrrd", "--size",       "64x64",          "--samples", "600",
                     "--noise",     "0.1",          "--noise-target", "raw",       "--progress",
                     "xml",         "--checkpoint", name + ".film",   "--output",  name + ".exr"};
  };
  const Outcome once = run(arguments("once"), folder.path());
  ASSERT_EQ(once.status, 0) << once.err;
  Process process(arguments("two"), folder.path());
  ASSERT_TRUE(process.waitForOutput("<filter-progress>0\\.[2-9]"));
  process.send(SIGTERM);
  const Outcome stopped = process.wait();
  ASSERT_EQ(stopped.status, 5) << stopped.err;
  EXPECT_TRUE(stopped.result.starts_with("two.exr: ")) << stopped.result;
  const Outcome rest = run(arguments("two"), folder.path());
  ASSERT_EQ(rest.status, 0) << rest.err;
  expectSameImage(folder / "once.exr", folder / "two.exr");
}

TEST_F(CheckpointCommand, CheckpointOfAnotherRenderIsRejected) {
  folder.write("other.json", R"({"extinction": [[0, 0], [64, 1]], "albedo": [[0, 1, 1, 1]]})");
  const auto addSize = [this](Arguments arguments) {
    arguments.insert(arguments.end(), sizeOfCheckpoint.begin(), sizeOfCheckpoint.end());
    return arguments;
  };
  std::vector<ExpectedError> errors = {
      makeError("seed", addSize({"--seed", "3"}), "a.film: | --seed"),
      makeError("size", {"--size", "16x17", "--samples", "2"}, "a.film: | --size | 16x16 | 16x17"),
      makeError("view", addSize({"--view", "left"}), "a.film: | --view | left"),
      makeError("transfer", addSize({"--transfer", "other.json"}), "a.film: | --transfer | other"),
      makeError("bounces", addSize({"--bounces", "1"}), "a.film: | --bounces"),
      makeError("sampling", addSize({"--sampling", "independent"}), "a.film: | --sampling"),
      makeError("fewer samples", {"--size", "16x16", "--samples", "1"},
                "--samples: | a.film | 2 samples"),
      makeError("turntable", {}, "--checkpoint: not needed"),
  };
  errors.back().arguments.insert(errors.back().arguments.begin(), "turntable");
  for (ExpectedError& one : errors)
    one.arguments.insert(one.arguments.end(), {"--progress", "xml"});
  expectErrors(errors, folder.path());
}

TEST_F(CheckpointCommand, ChangedInputsAreRejected) {
  std::string samples = makeRamp();
  samples[77] = 9;
  folder.write("volume.nrrd", NrrdText().encode(samples));
  const Outcome outcome = renderCheckpoint();
  EXPECT_EQ(outcome.status, 2);
  expectErrorLine(outcome.err, "a.film: | volume.nrrd");
}

TEST_F(CheckpointCommand, RawNoiseTargetCannotBeAddedAfter16Samples) {
  const Arguments arguments = {"volume.nrrd",  "--size", "16x16",    "--samples", "20",
                               "--checkpoint", "b.film", "--output", "b.exr"};
  ASSERT_EQ(run(arguments, folder.path()).status, 0);
  Arguments planned = arguments;
  planned.insert(planned.end(), {"--noise", "1e-4"});
  const Outcome outcome = run(planned, folder.path());
  EXPECT_EQ(outcome.status, 2);
  expectErrorLine(outcome.err, "--noise: | b.film");
}

TEST_F(CheckpointCommand, OtherInstructionSetIsRejected) {
  ::setenv("FENESTRA_INSTRUCTIONS", "SCALAR", 1);
  const Outcome outcome = renderCheckpoint();
  ::unsetenv("FENESTRA_INSTRUCTIONS");
  EXPECT_EQ(outcome.status, 2);
  expectErrorLine(outcome.err, "a.film: | SCALAR");
}

TEST_F(CheckpointCommand, DamagedCheckpointIsRejectedAndKept) {
  const std::string checkpoint = readBytes(folder / "a.film");
  for (const std::size_t at : {std::size_t{3}, checkpoint.size() / 2, checkpoint.size() - 2}) {
    std::string damaged = checkpoint;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    folder.write("a.film", damaged);
    const Outcome outcome = renderCheckpoint();
    EXPECT_EQ(outcome.status, 3);
    expectErrorLine(outcome.err, "a.film:");
    EXPECT_TRUE(readBytes(folder / "a.film") == damaged);
  }
  folder.write("a.film", "a user's notes");
  EXPECT_EQ(renderCheckpoint().status, 3);
  EXPECT_EQ(readBytes(folder / "a.film"), "a user's notes");
  folder.write("a.film", "");
  EXPECT_EQ(renderCheckpoint().status, 0);
  EXPECT_EQ(readBytes(folder / "a.film").size(), checkpoint.size());
}

TEST_F(CheckpointCommand, CheckpointOfARunningRenderIsRejected) {
  const Arguments arguments = {"volume.nrrd", "--size",     "64x64", "--samples",
                               "1000000",     "--progress", "xml",   "--checkpoint",
                               "c.film",      "--output",   "c.exr"};
  Process process(arguments, folder.path());
  ASSERT_TRUE(process.waitForOutput("<filter-start>"));
  const Outcome second = run(arguments, folder.path());
  EXPECT_EQ(second.status, 2);
  expectErrorLine(second.err, "c.film:");
}

TEST_F(CheckpointCommand, UnwritableCheckpointGivesOneWarning) {
  Process process({"volume.nrrd", "--size", "64x64", "--samples", "1000000", "--seconds", "1.6",
                   "--threads", "1", "--progress", "xml", "--checkpoint", "c.film", "--output",
                   "c.exr"},
                  folder.path());
  ASSERT_TRUE(process.waitForOutput("<filter-start>"));
  std::filesystem::create_directory(folder / "c.film"); // makes writing fail
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("fenestra: warning: c.film: ")) << outcome.err;
  EXPECT_EQ(readImage(folder / "c.exr").width, 64);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "c.film"));
}

} // namespace
} // namespace fenestra::core::CheckpointCommandTests
