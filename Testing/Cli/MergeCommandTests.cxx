// Merging separately rendered shards gives the image of a single run.

#include "CommandTesting.h"
#include "ImageTesting.h"
#include "RunSettings.h"

#include <csignal>
#include <random>

namespace fenestra::core::MergeCommandTests {
namespace {

class MergeCommand : public SmallScene {
protected:
  /// Renders shard `number` of `count` to a checkpoint file; returns its name.
  std::string renderShard(int number, int count, const Arguments& more = {}) const {
    const std::string name = std::to_string(number) + "of" + std::to_string(count) + ".film";
    Arguments all = {"volume.nrrd",
                     "--size",
                     "64x64",
                     "--samples",
                     "9",
                     "--segmentation",
                     "segments.seg.nrrd",
                     "--focus",
                     "A",
                     "--shard",
                     std::to_string(number) + "/" + std::to_string(count),
                     "--checkpoint",
                     name,
                     "--progress",
                     "none"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return name;
  }
  Arguments renderShards(int count) const {
    Arguments shards;
    for (int number = 1; number <= count; ++number)
      shards.push_back(renderShard(number, count));
    return shards;
  }
  Outcome merge(const Arguments& shards, const Arguments& more) const {
    Arguments all = {"merge"};
    all.insert(all.end(), shards.begin(), shards.end());
    all.insert(all.end(), more.begin(), more.end());
    return run(all, folder.path());
  }
};

TEST_F(MergeCommand, ShardsInAnyOrderGiveTheImageOfASingleRun) {
  const Outcome once =
      run({"volume.nrrd", "--size", "64x64", "--samples", "9", "--segmentation",
           "segments.seg.nrrd", "--focus", "A", "--denoise", "on", "--output", "once.exr",
           "--output", "once.png", "--surface", "once.ply", "--annotate", "orientation"},
          folder.path());
  ASSERT_EQ(once.status, 0) << once.err;
  std::mt19937 random(5);
  std::vector<int> counts = {1, 3, 7};
  if (testing::isLongRun())
    counts.push_back(16);
  for (const int count : counts) {
    SCOPED_TRACE(count);
    Arguments shards = renderShards(count);
    std::ranges::shuffle(shards, random);
    const Outcome merged = merge(shards, {"--denoise", "on", "--output", "merged.exr", "--output",
                                          "merged.png", "--surface", "merged.ply", "--stats-json",
                                          "merged.json", "--annotate", "orientation"});
    ASSERT_EQ(merged.status, 0) << merged.err;
    expectSameImage(folder / "once.exr", folder / "merged.exr");
    expectSameImage(folder / "once.png", folder / "merged.png");
    EXPECT_TRUE(readBytes(folder / "once.ply") == readBytes(folder / "merged.ply"));
    EXPECT_EQ(readImage(folder / "merged.exr").header.at("command").find("fenestra volume.nrrd"),
              0U);
  }
}

TEST_F(MergeCommand, StoppedShardResumes) {
  const Arguments arguments = {"volume.nrrd", "--size",     "64x64", "--samples",
                               "200",         "--shard",    "2/2",   "--checkpoint",
                               "2of2.film",   "--progress", "xml"};
  Process process(arguments, folder.path());
  ASSERT_TRUE(process.waitForOutput("<filter-progress>0\\.0*[1-9]"));
  process.send(SIGTERM);
  const Outcome stopped = process.wait();
  EXPECT_EQ(stopped.status, 5) << stopped.err;
  expectStated(stopped.result, "2of2.film: | 2/2 | 64x64");
  Arguments first = arguments;
  first[6] = "1/2";       // of --shard
  first[8] = "1of2.film"; // of --checkpoint
  for (const Arguments& one : {first, arguments})
    EXPECT_EQ(run(one, folder.path()).status, 0);
  ASSERT_EQ(merge({"1of2.film", "2of2.film"}, {"--output", "merged.exr"}).status, 0);
  ASSERT_EQ(run({"volume.nrrd", "--size", "64x64", "--samples", "200", "--output", "once.exr"},
                folder.path())
                .status,
            0);
  expectSameImage(folder / "once.exr", folder / "merged.exr");
}

TEST_F(MergeCommand, ErrorNamesShardsThatDoNotBelongTogether) {
  const Arguments shards = renderShards(3);
  const std::string foreign = renderShard(1, 2);
  std::filesystem::copy(folder / shards[1], folder / "copy.film");
  folder.write("cut.film", readBytes(folder / shards[1]).substr(0, 5000));
  const auto renderOther = [&](const char* name, const Arguments& more) {
    std::filesystem::rename(folder / shards[1], folder / "kept.film");
    renderShard(2, 3, more);
    std::filesystem::rename(folder / shards[1], folder / name);
    std::filesystem::rename(folder / "kept.film", folder / shards[1]);
  };
  std::vector<ExpectedError> refusals = {
      {"missing", {shards[0], shards[2]}, 2, "PART: | 3 shards | number 2"},
      {"doubled", {shards[0], shards[1], shards[2], "copy.film"}, 2, shards[1] + ": | copy.film"},
      {"of another count", {shards[0], foreign, shards[2]}, 2, foreign + ": | 1/2"},
      {"truncated", {shards[0], "cut.film", shards[2]}, 3, "cut.film:"},
      {"no checkpoint", {shards[0], "volume.nrrd", shards[2]}, 3, "volume.nrrd:"},
      {"absent", {shards[0], "none.film", shards[2]}, 3, "none.film:"},
      {"nothing", {}, 2, "PART:"},
      {"option of render", {shards[0], "--seed", "3"}, 2, "--seed:"},
      {"shard as output", {shards[0], shards[1], shards[2], "--output", "1of3.film"}, 2, ""},
  };
  const std::pair<const char*, Arguments> others[] = {{"seed.film", {"--seed", "4"}},
                                                      {"view.film", {"--view", "left"}}};
  for (const auto& [name, more] : others) {
    renderOther(name, more);
    refusals.push_back(
        {name, {shards[0], name, shards[2]}, 2, std::string(name) + ": | 1of3.film | " + more[0]});
  }
  for (ExpectedError& refusal : refusals)
    refusal.arguments.insert(refusal.arguments.begin(), "merge");
  expectErrors(refusals, folder.path());
}

TEST_F(MergeCommand, ErrorNamesFewerSamplesOrAChangedInput) {
  const Arguments shards = renderShards(2);
  std::filesystem::remove(folder / shards[1]);
  ASSERT_EQ(run({"volume.nrrd", "--size", "64x64", "--samples", "4", "--segmentation",
                 "segments.seg.nrrd", "--focus", "A", "--shard", "2/2", "--checkpoint", shards[1]},
                folder.path())
                .status,
            0);
  const Outcome fewer = merge(shards, {"--output", "merged.exr"});
  EXPECT_EQ(fewer.status, 2);
  expectErrorLine(fewer.err, shards[1] + ": | 4 | " + shards[0]);
  std::filesystem::remove(folder / shards[1]);
  renderShard(2, 2);
  std::string samples = makeRamp();
  samples[40] = 9;
  folder.write("volume.nrrd", NrrdText().encode(samples));
  const Outcome changed = merge(shards, {"--output", "merged.exr"});
  EXPECT_EQ(changed.status, 2);
  expectErrorLine(changed.err, " | volume.nrrd");
}

TEST_F(MergeCommand, ShardsRejectOptionsOfTheCompleteImage) {
  const auto refusal = [](const char* name, Arguments arguments, const char* text) {
    arguments.insert(arguments.begin(), {"volume.nrrd", "--shard", "1/2"});
    return ExpectedError{name, arguments, 2, text};
  };
  const Arguments checkpoint = {"--checkpoint", "a.film"};
  const auto withCheckpoint = [&](Arguments arguments) {
    arguments.insert(arguments.begin(), checkpoint.begin(), checkpoint.end());
    return arguments;
  };
  expectErrors(
      {refusal("no checkpoint", {}, "--shard:"),
       refusal("noise", withCheckpoint({"--noise", "0.1"}), "--noise: | --samples"),
       refusal("seconds", withCheckpoint({"--seconds", "1"}), "--seconds: | --samples"),
       refusal("output", withCheckpoint({"--output", "a.png"}), "--output: | fenestra merge"),
       refusal("stats", withCheckpoint({"--stats-json", "a.json"}),
               "--stats-json: | fenestra merge")},
      folder.path());
  for (const char* text : {"0/3", "4/3", "1", "1/0", "1/2x", "-1/2", "1/20000"})
    expectErrors({{text,
                   {"volume.nrrd", std::string("--shard=") + text, "--checkpoint", "a.film"},
                   2,
                   "--shard:"}},
                 folder.path());
}

} // namespace
} // namespace fenestra::core::MergeCommandTests
