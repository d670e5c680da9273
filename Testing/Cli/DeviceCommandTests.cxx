// --device: GPUs, and the CPU where there is none. Software devices are used if FENESTRA_GPU says
// so.

#include "CommandTesting.h"
#include "WriteResults.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

namespace fenestra::core::DeviceCommandTests {
namespace {

class DeviceCommand : public ::testing::Test {
protected:
  DeviceCommand() { unsetenv("FENESTRA_GPU"); }
  ~DeviceCommand() override { unsetenv("FENESTRA_GPU"); }

  std::string listDevices() const { return run({"--device", "list"}, folder.path()).out; }
  bool hasUsedDevice() const {
    const std::string list = listDevices();
    return list != "no GPU found\n" && list.find("not used") == std::string::npos;
  }

  /// Statistics of a render, which must succeed. `errors` receives standard error.
  nlohmann::json render(Arguments arguments, const std::string& device, std::string& errors) {
    const Arguments more = {"--device",           device,          "--samples",    "2",
                            "--volume-smoothing", "off",           "--size",       "48x48",
                            "--output",           device + ".exr", "--stats-json", "stats.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    errors = outcome.err;
    return nlohmann::json::parse(readBytes(folder / "stats.json"));
  }

  /// Expects that the software device renders the same image twice, without a word about the CPU.
  void expectOnDevice(const Arguments& arguments) {
    setenv("FENESTRA_GPU", "software", 1);
    if (!hasUsedDevice())
      GTEST_SKIP() << "no Vulkan device";
    std::string errors;
    const nlohmann::json stats = render(arguments, "gpu", errors);
    EXPECT_EQ(listDevices(), stats["target"].get<std::string>() + "\n");
    EXPECT_EQ(errors.find("CPU"), std::string::npos) << errors;
    const Image first = readImage(folder / "gpu.exr");
    render(arguments, "gpu", errors);
    const Image again = readImage(folder / "gpu.exr");
    for (const auto& [name, plane] : first.channels)
      EXPECT_EQ(again.channels.at(name), plane) << name;
  }

  TemporaryFolder folder;
};

TEST_F(DeviceCommand, WithoutGpuTheCpuRendersAndSaysSo) {
  if (hasUsedDevice())
    GTEST_SKIP() << "this machine has a GPU";
  writeFile(folder / "volume.nrrd", NrrdText().encode(makeRamp()));
  std::string silent, automatic, warned;
  const nlohmann::json expected = render({"volume.nrrd"}, "cpu", silent);
  EXPECT_EQ(render({"volume.nrrd"}, "auto", automatic)["target"], expected["target"]);
  EXPECT_EQ(render({"volume.nrrd"}, "gpu", warned)["target"], expected["target"]);
  EXPECT_EQ(automatic.find("warning"), silent.find("warning")) << automatic;
  EXPECT_NE(warned.find("no "), std::string::npos) << warned;
  EXPECT_NE(warned, silent);
  const Image image = readImage(folder / "gpu.exr"), cpu = readImage(folder / "cpu.exr");
  for (const auto& [name, plane] : cpu.channels)
    EXPECT_EQ(image.channels.at(name), plane) << name;
}

TEST_F(DeviceCommand, PreviewsAreRenderedOnTheDevice) {
  setenv("FENESTRA_GPU", "software", 1);
  if (!hasUsedDevice())
    GTEST_SKIP() << "no Vulkan device";
  writeFile(folder / "volume.nrrd", NrrdText().encode(makeRamp()));
  const auto findTargets = [&](Arguments arguments) {
    const Arguments all = {"serve", "volume.nrrd", "--size=8x8", "--samples=2", "--output=a.png"};
    arguments.insert(arguments.begin(), all.begin(), all.end());
    Process process(arguments, folder.path());
    EXPECT_TRUE(process.waitForOutput("\"done\":true[^\n]*\n")) << process.messages();
    process.write("{\"id\": 1, \"view\": \"left\"}\n");
    EXPECT_TRUE(process.waitForOutput("\"id\":1,[^\n]*\"done\":true[^\n]*\n"));
    std::set<std::string> targets;
    std::istringstream lines(process.output());
    for (std::string line; std::getline(lines, line);)
      targets.insert(nlohmann::json::parse(line)["target"].get<std::string>() + "\n");
    return targets;
  };
  EXPECT_EQ(findTargets({}), std::set{listDevices()});
  EXPECT_EQ(findTargets({"--device", "cpu"}).count(listDevices()), 0);
}

/// Empty files in place of the Vulkan loader.
TEST_F(DeviceCommand, WithoutLoaderTheCpuRendersAndSaysSo) {
  setenv("FENESTRA_GPU", "software", 1);
  writeFile(folder / "volume.nrrd", NrrdText().encode(makeRamp()));
  for (const char* loader : {"libvulkan.so.1", "libvulkan.so"})
    writeFile(folder / loader, "");
  setenv("LD_LIBRARY_PATH", folder.path().c_str(), 1);
  std::string warned, silent;
  const nlohmann::json stats = render({"volume.nrrd"}, "gpu", warned);
  const nlohmann::json expected = render({"volume.nrrd"}, "cpu", silent);
  unsetenv("LD_LIBRARY_PATH");
  EXPECT_EQ(stats["target"], expected["target"]);
  EXPECT_NE(warned.find("no Vulkan loader"), std::string::npos) << warned;
  EXPECT_EQ(silent.find("Vulkan"), std::string::npos) << silent;
}

TEST_F(DeviceCommand, UnknownDeviceIsRefused) {
  const Outcome outcome = run({"volume.nrrd", "--device", "tpu"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
}

TEST_F(DeviceCommand, ExactSurfaceOfTheKneeRendersOnTheDevice) {
  expectOnDevice({std::string(FENESTRA_TEST_DATA) + "/knee/knee.mrml", "--focus",
                  "FemoralCartilage", "--clip-boundary", "exact", "--materials", "none"});
}

TEST_F(DeviceCommand, DefaultsOfALiverRenderOnTheDevice) {
  const std::string torso = std::string(FENESTRA_DATA) + "/abdomen_ct_totalseg";
  if (!std::filesystem::exists(torso))
    GTEST_SKIP() << "real data not found: " << torso;
  expectOnDevice({torso + "/ct.nii.gz", "--segmentation", torso + "/seg_multiorgan.nii.gz",
                  "--focus", "liver"});
}

} // namespace
} // namespace fenestra::core::DeviceCommandTests
