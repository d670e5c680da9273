// Complete request, from bytes to pixels. The input is one byte that selects whether there is a
// focus, a scene, a line `---`, and the volume v.nrrd. Only this target tests combinations of scene
// and volume (positions, boxes, cameras, majorants, paths).
#include "Approx.h"
#include "Harness.h"
#include "SceneFixtures.h"

#include "integrator/render/Render.h"
#include "scene/PreparedScene.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace {

using namespace fenestra::core;

constexpr std::int64_t maxVoxels = 32 * 32 * 32;
constexpr std::uint64_t maxBounces = 8;

/// Requests a stop after half a second, since dense media can take long. The render must then stop
/// quickly.
class StopTimer {
public:
  explicit StopTimer(std::atomic<bool>& stop)
      : m_thread([this, &stop] {
          std::unique_lock lock(m_mutex);
          stop = !m_wake.wait_for(lock, std::chrono::milliseconds(500), [this] { return m_done; });
        }) {}
  ~StopTimer() {
    {
      const std::lock_guard lock(m_mutex);
      m_done = true;
    }
    m_wake.notify_one();
    m_thread.join();
  }
  StopTimer(const StopTimer&) = delete;
  StopTimer& operator=(const StopTimer&) = delete;

private:
  std::mutex m_mutex;
  std::condition_variable m_wake;
  bool m_done = false;
  std::thread m_thread;
};

void checkPixels(const Film& film) {
  for (const PixelSums& pixel : film.pixels())
    if (!allFinite(pixel.mean) || (pixel.mean < 0.0).any())
      throw std::logic_error("a pixel is negative or not finite");
}

void renderRequest(const RenderRequest& request) {
  const Input input(request.input);
  if (input.volume(request.volume)->volume.grid.voxelCount() > maxVoxels)
    return;
  const PreparedScene scene(request, input);
  RenderSettings settings;
  settings.path.bounces = maxBounces;
  settings.samples = 1;
  settings.threads = 1;
  RenderMonitor monitor;
  const StopTimer timer(monitor.stop);
  checkPixels(render(scene.view(), settings, monitor).film);
}

} // namespace

FENESTRA_FUZZ(CompleteRequest, input) {
  if (input.empty())
    return;
  fuzzing::writeSceneFixtures();
  RenderRequest request;
  if (input[0] != '0')
    request.focus = {"A"};
  input.remove_prefix(1);
  constexpr std::string_view separator = "\n---\n";
  const std::size_t end = input.find(separator);
  request.input = fuzzing::writeInput(input.substr(0, end), "scene.mrml");
  fuzzing::writeInput(end == input.npos ? fuzzing::sceneFixtures().at("v.nrrd")
                                        : std::string(input.substr(end + separator.size())),
                      "v.nrrd");
  request.width = request.height = 4;
  renderRequest(request);
}
