// A device that fails at any point of a render, that is stopped, or that is absent: the result is a
// CPU image, or the samples so far. Functions of Vulkan are replaced by ones that fail.

#include "Gpu/GpuTesting.h"

#include <future>
#include <set>
#include <thread>

namespace fenestra::core::testing::FailureTests {
namespace {

/// Calls of the replaced function, and the first of them that fails.
std::atomic<int> calls, firstFailure;

bool isFailureDue() {
  return ++calls >= firstFailure;
}

/// Replaces a function of Vulkan: calls from the `first` on return `result`, after the call itself
/// if `isCalled`.
template <auto function, VkResult result, bool isCalled>
class FailingCalls {
public:
  explicit FailingCalls(int first) {
    calls = 0;
    firstFailure = first;
    original = *function;
    *function = makeReplacement(original);
  }
  ~FailingCalls() { *function = original; }
  FailingCalls(const FailingCalls&) = delete;
  FailingCalls& operator=(const FailingCalls&) = delete;

private:
  using Function = std::remove_pointer_t<decltype(function)>;

  template <typename... Arguments>
  static Function makeReplacement(VkResult(VKAPI_PTR*)(Arguments...)) {
    return [](Arguments... arguments) -> VkResult {
      const bool isFailure = isFailureDue();
      const VkResult own = isFailure && !isCalled ? result : original(arguments...);
      return isFailure ? result : own;
    };
  }

  static inline Function original = nullptr;
};

using NoMemory = FailingCalls<&vkAllocateMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY, false>;
using NoPipeline = FailingCalls<&vkCreateComputePipelines, VK_ERROR_INITIALIZATION_FAILED, false>;
using LostAtSubmit = FailingCalls<&vkQueueSubmit, VK_ERROR_DEVICE_LOST, false>;
using LostAtWait = FailingCalls<&vkWaitForFences, VK_ERROR_DEVICE_LOST, true>;
using NoDevice = FailingCalls<&vkCreateDevice, VK_ERROR_INITIALIZATION_FAILED, false>;

TestScene makeScene() {
  TestScene scene = makeWavyScene();
  scene.transfer.shading.reset();
  return scene;
}

RenderSettings makeSettings() {
  RenderSettings settings;
  settings.samples = 4;
  settings.passSamples = 1;
  settings.threads = 2;
  // Several batches and dispatches, so that a device can fail between two of them.
  settings.batchLimits = gpu::BatchLimits{.threads = 64, .paths = 256, .maxSteps = 64};
  return settings;
}

RenderResult render(Integrator integrator, std::optional<RenderResult> resumed = {}) {
  RenderSettings settings = makeSettings();
  settings.integrator = integrator;
  RenderMonitor monitor;
  return makeScene().visitView([&](const SceneView& scene) {
    return core::render(scene, settings, monitor, std::move(resumed));
  });
}

void expectCpuImage(const RenderResult& result) {
  static const RenderResult expected = render(Integrator::simd);
  EXPECT_EQ(result.target, instructionSet());
  EXPECT_EQ(result.reason, StopReason::samples);
  expectIdentical(result.film, expected.film);
  expectEqualCounters(result.counters, expected.counters);
}

class GpuFailure : public GpuTest {};

template <typename Failing>
void expectFallback(int first, const std::string& message) {
  SCOPED_TRACE(first);
  const Failing failing(first);
  const RenderResult result = render(Integrator::gpu);
  EXPECT_NE(result.gpuFailure.find(message), std::string::npos) << result.gpuFailure;
  EXPECT_GE(calls, first);
  expectCpuImage(result);
}

TEST_F(GpuFailure, WithoutAFailureTheGpuRenders) {
  const RenderResult result = render(Integrator::gpu);
  EXPECT_EQ(result.target, findDeviceTarget());
  EXPECT_EQ(result.gpuFailure, "");
}

TEST_F(GpuFailure, OfAnAllocationGivesTheCpuImage) {
  for (const int first : {1, 4, 9, 20})
    expectFallback<NoMemory>(first, "too little memory");
}

TEST_F(GpuFailure, OfThePipelineGivesTheCpuImage) {
  expectFallback<NoPipeline>(1, "compiling the shader failed");
}

TEST_F(GpuFailure, OfALostDeviceGivesTheCpuImage) {
  for (const int first : {1, 3, 6, 7, 8, 12, 40})
    expectFallback<LostAtSubmit>(first, "starting the device failed");
  for (const int first : {1, 7, 11, 39})
    expectFallback<LostAtWait>(first, "waiting for the device failed");
}

/// A driver that compiles the shader wrongly: it ignores the constants of the scene.
class WrongShader {
public:
  WrongShader() : m_original(vkCreateComputePipelines) {
    original = m_original;
    vkCreateComputePipelines = create;
  }
  ~WrongShader() { vkCreateComputePipelines = m_original; }
  WrongShader(const WrongShader&) = delete;
  WrongShader& operator=(const WrongShader&) = delete;

private:
  static VKAPI_ATTR VkResult VKAPI_CALL create(VkDevice device, VkPipelineCache,
                                               std::uint32_t count,
                                               const VkComputePipelineCreateInfo* info,
                                               const VkAllocationCallbacks* callbacks,
                                               VkPipeline* pipelines) {
    VkComputePipelineCreateInfo changed = *info;
    changed.stage.pSpecializationInfo = nullptr;
    return original(device, VK_NULL_HANDLE, count, &changed, callbacks, pipelines);
  }
  static inline PFN_vkCreateComputePipelines original = nullptr;
  PFN_vkCreateComputePipelines m_original;
};

TEST_F(GpuFailure, OfTheShaderGivesTheCpuImage) {
  const WrongShader wrong;
  const RenderResult result = render(Integrator::gpu);
  EXPECT_EQ(result.gpuFailure, "its results differ from those of the CPU");
  expectCpuImage(result);
}

TEST_F(GpuFailure, OfAResumedRenderGivesTheCpuImage) {
  RenderSettings settings = makeSettings();
  settings.samples = 2;
  const RenderResult begun = makeScene().render(settings);
  const LostAtSubmit failing(12);
  const RenderResult result = render(Integrator::gpu, begun);
  EXPECT_NE(result.gpuFailure, "");
  expectCpuImage(result);
}

TEST_F(GpuFailure, ToOpenADeviceGivesTheCpuImage) {
  gpu::Device::forget();
  const NoDevice failing(1);
  const RenderResult result = render(Integrator::gpu);
  EXPECT_EQ(result.gpuFailure, ""); // known before the render
  expectCpuImage(result);
}

TEST_F(GpuFailure, SoftwareDevicesAreUsedOnRequestOnly) {
  unsetenv("FENESTRA_GPU");
  std::string obstacle;
  try {
    gpu::Device::open();
  } catch (const gpu::DeviceError& error) {
    obstacle = error.what();
  }
  if (obstacle.empty())
    GTEST_SKIP() << "there is a GPU";
  EXPECT_EQ(obstacle, "no GPU found");
  expectCpuImage(render(Integrator::gpu));
}

/// Renders until `stopAt` paths are finished.
RenderResult renderUntil(std::uint64_t stopAt) {
  RenderSettings settings = makeSettings();
  settings.samples = 1U << 20;
  settings.integrator = Integrator::gpu;
  RenderMonitor monitor;
  auto rendering = std::async(std::launch::async, [&] {
    return makeScene().visitView(
        [&](const SceneView& scene) { return core::render(scene, settings, monitor); });
  });
  while (monitor.paths < stopAt)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  monitor.stop = true;
  return rendering.get();
}

class GpuStop : public GpuTest {};

TEST_F(GpuStop, KeepsTheFinishedTiles) {
  for (const std::uint64_t stopAt : {0U, 1U, 1500U}) {
    const RenderResult result = renderUntil(stopAt);
    EXPECT_EQ(result.reason, StopReason::request);
    EXPECT_EQ(result.target, findDeviceTarget());
    std::set<std::uint64_t> counts;
    for (const PixelSums& pixel : result.film.pixels())
      if (!pixel.isDeterministic)
        counts.insert(pixel.samples);
    ASSERT_LE(counts.size(), 2U); // some tiles may be one pass ahead
    EXPECT_LE(*counts.rbegin() - *counts.begin(), 1U);
    for (const std::uint64_t count : counts) {
      RenderSettings settings = makeSettings();
      settings.samples = count;
      const Film expected = renderTwin(makeScene(), settings).film;
      for (std::size_t i = 0; i < expected.pixelCount(); ++i) {
        const PixelSums& pixel = result.film.pixels()[i];
        EXPECT_TRUE(pixel.samples != count || pixel.mean == expected.pixels()[i].mean) << i;
      }
    }
  }
}

} // namespace
} // namespace fenestra::core::testing::FailureTests
