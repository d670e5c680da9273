// Parts of a picture, rendered by themselves, are merged to the picture of one machine.

#include "CommandTesting.h"
#include "PictureTesting.h"
#include "RunSettings.h"

#include <csignal>
#include <random>

namespace fenestra::MergeCommandTests {
namespace {

class MergeCommand : public SmallScene {
protected:
  /// Renders part `number` of `count` into a film; returns its name.
  std::string part(int number, int count, const Arguments& more = {}) const {
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
  Arguments parts(int count) const {
    Arguments films;
    for (int number = 1; number <= count; ++number)
      films.push_back(part(number, count));
    return films;
  }
  Outcome merge(const Arguments& films, const Arguments& more) const {
    Arguments all = {"merge"};
    all.insert(all.end(), films.begin(), films.end());
    all.insert(all.end(), more.begin(), more.end());
    return run(all, folder.path());
  }
};

TEST_F(MergeCommand, PartsInAnyOrderGiveThePictureOfOneMachine) {
  const Outcome once = run({"volume.nrrd", "--size", "64x64", "--samples", "9", "--segmentation",
                            "segments.seg.nrrd", "--focus", "A", "--denoise", "on", "--output",
                            "once.exr", "--output", "once.png", "--surface", "once.ply"},
                           folder.path());
  ASSERT_EQ(once.status, 0) << once.err;
  std::mt19937 random(5);
  std::vector<int> counts = {1, 3, 7};
  if (testing::isLongRun())
    counts.push_back(16);
  for (const int count : counts) {
    SCOPED_TRACE(count);
    Arguments films = parts(count);
    std::ranges::shuffle(films, random);
    const Outcome merged =
        merge(films, {"--denoise", "on", "--output", "merged.exr", "--output", "merged.png",
                      "--surface", "merged.ply", "--stats", "merged.json"});
    ASSERT_EQ(merged.status, 0) << merged.err;
    expectSamePicture(folder / "once.exr", folder / "merged.exr");
    expectSamePicture(folder / "once.png", folder / "merged.png");
    EXPECT_TRUE(readBytes(folder / "once.ply") == readBytes(folder / "merged.ply"));
    EXPECT_EQ(readImage(folder / "merged.exr").header.at("command").find("fenestra volume.nrrd"),
              0U);
  }
}

TEST_F(MergeCommand, PartThatWasStoppedGoesOn) {
  const Arguments words = {"volume.nrrd", "--size",     "64x64", "--samples",
                           "200",         "--shard",    "2/2",   "--checkpoint",
                           "2of2.film",   "--progress", "xml"};
  Process process(words, folder.path());
  ASSERT_TRUE(process.waitForOutput("<filter-progress>0\\.0*[1-9]"));
  process.send(SIGTERM);
  const Outcome stopped = process.wait();
  EXPECT_EQ(stopped.status, 5) << stopped.err;
  EXPECT_NE(stopped.out.find("2of2.film: part 2/2 of 64x64 pixels"), std::string::npos);
  Arguments first = words;
  first[6] = "1/2";
  first[8] = "1of2.film";
  for (const Arguments& one : {first, words})
    EXPECT_EQ(run(one, folder.path()).status, 0);
  ASSERT_EQ(merge({"1of2.film", "2of2.film"}, {"--output", "merged.exr"}).status, 0);
  ASSERT_EQ(run({"volume.nrrd", "--size", "64x64", "--samples", "200", "--output", "once.exr"},
                folder.path())
                .status,
            0);
  expectSamePicture(folder / "once.exr", folder / "merged.exr");
}

TEST_F(MergeCommand, PartsThatDoNotBelongTogetherAreNamed) {
  const Arguments films = parts(3);
  const std::string foreign = part(1, 2);
  std::filesystem::copy(folder / films[1], folder / "copy.film");
  folder.write("cut.film", readBytes(folder / films[1]).substr(0, 5000));
  const auto other = [&](const char* name, const Arguments& more) {
    std::filesystem::rename(folder / films[1], folder / "kept.film");
    part(2, 3, more);
    std::filesystem::rename(folder / films[1], folder / name);
    std::filesystem::rename(folder / "kept.film", folder / films[1]);
  };
  std::vector<ExcludedOptions> refusals = {
      {"missing", {films[0], films[2]}, 2, "PART: of 3 parts, number 2 is missing"},
      {"doubled", {films[0], films[1], films[2], "copy.film"}, 2, "is part 2/3, as is "},
      {"of another count", {films[0], foreign, films[2]}, 2, foreign + ": is part 1/2"},
      {"truncated", {films[0], "cut.film", films[2]}, 3, "cut.film: is a damaged film"},
      {"no film", {films[0], "volume.nrrd", films[2]}, 3, "volume.nrrd: is no film"},
      {"absent", {films[0], "none.film", films[2]}, 3, "none.film: there is no such file"},
      {"nothing", {}, 2, "PART: is missing"},
      {"flag of the samples", {films[0], "--seed", "3"}, 2, "--seed: no such flag"},
      {"part as a result", {films[0], films[1], films[2], "--output", "1of3.film"}, 2, ""},
  };
  const std::pair<const char*, Arguments> others[] = {{"seed.film", {"--seed", "4"}},
                                                      {"view.film", {"--view", "left"}}};
  for (const auto& [name, more] : others) {
    other(name, more);
    refusals.push_back({name,
                        {films[0], name, films[2]},
                        2,
                        std::string(name) + ": is not of the picture of 1of3.film: " + more[0]});
  }
  for (ExcludedOptions& refusal : refusals)
    refusal.arguments.insert(refusal.arguments.begin(), "merge");
  expectRefused(refusals, folder.path());
}

TEST_F(MergeCommand, FewerSamplesOrAChangedInputAreNamed) {
  const Arguments films = parts(2);
  std::filesystem::remove(folder / films[1]);
  ASSERT_EQ(run({"volume.nrrd", "--size", "64x64", "--samples", "4", "--segmentation",
                 "segments.seg.nrrd", "--focus", "A", "--shard", "2/2", "--checkpoint", shards[1]},
                folder.path())
                .status,
            0);
  const Outcome fewer = merge(films, {"--output", "merged.exr"});
  EXPECT_EQ(fewer.status, 2);
  EXPECT_NE(fewer.err.find(shards[1] + ": has 4 samples a pixel"), std::string::npos) << fewer.err;
  std::filesystem::remove(folder / films[1]);
  part(2, 2);
  std::string samples = ramp();
  samples[40] = 9;
  folder.write("volume.nrrd", NrrdText().with(samples));
  const Outcome changed = merge(films, {"--output", "merged.exr"});
  EXPECT_EQ(changed.status, 2);
  EXPECT_NE(changed.err.find("volume.nrrd has changed since"), std::string::npos) << changed.err;
}

TEST_F(MergeCommand, PartsTakeNoFlagsOfTheWholePicture) {
  const auto refused = [](const char* name, Arguments words, const char* text) {
    words.insert(words.begin(), {"volume.nrrd", "--shard", "1/2"});
    return ExcludedOptions{name, words, 2, text};
  };
  const Arguments film = {"--checkpoint", "a.film"};
  const auto with = [&](Arguments words) {
    words.insert(words.begin(), film.begin(), film.end());
    return words;
  };
  expectRefused({refused("no film", {}, "--shard: needs --checkpoint"),
                 refused("noise", with({"--noise", "0.1"}), "give --samples N"),
                 refused("seconds", with({"--seconds", "1"}), "give --samples N"),
                 refused("output", with({"--output", "a.png"}), "give it to fenestra merge"),
                 refused("stats", with({"--stats", "a.json"}), "give it to fenestra merge")},
                folder.path());
  for (const char* text : {"0/3", "4/3", "1", "1/0", "1/2x", "-1/2", "1/20000"})
    expectRefused({{text,
                    {"volume.nrrd", std::string("--shard=") + text, "--checkpoint", "a.film"},
                    2,
                    "--shard: expected K/N"}},
                  folder.path());
}

} // namespace
} // namespace fenestra::MergeCommandTests
