// Renders a ball inside a block from samples in memory, and saves it: example IMAGE.png
#include <fenestra/Fenestra.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  constexpr int size = 64;
  std::vector<std::int16_t> voxels; // Hounsfield units, i fastest
  std::vector<std::uint8_t> labels;
  for (int k = 0; k < size; ++k)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const double distance = std::hypot(i - 31.5, j - 31.5, k - 31.5);
        voxels.push_back(
            static_cast<std::int16_t>(40.0 + 260.0 * std::clamp(15.5 - distance, 0.0, 1.0)));
        labels.push_back(distance < 15.0 ? 1 : 0);
      }
  const fenestra::Affine indexToWorld = {{{2, 0, 0, -64}, {0, 2, 0, -64}, {0, 0, 2, -64}}}; // mm
  try {
    using enum fenestra::SampleType;
    const fenestra::Volume volume({voxels.data(), int16, {size, size, size}}, indexToWorld,
                                  {.modality = fenestra::Modality::ct});
    const fenestra::Segmentation segments({labels.data(), uint8, {size, size, size}}, indexToWorld,
                                          {{1, "ball"}});
    fenestra::SceneOptions options;
    options.focus = {"ball"};
    options.view.name = "anterior";
    const fenestra::Scene scene(volume, segments, options);
    const auto onProgress = [](const fenestra::Progress& progress) {
      std::fprintf(stderr, "\r%3.0f %%", 100.0 * progress.fraction);
      return true; // false stops the render
    };
    fenestra::render(scene, {.width = 256, .height = 256, .samples = 32}, onProgress)
        .save(argc > 1 ? argv[1] : "ball.png");
  } catch (const fenestra::Error& error) {
    std::fprintf(stderr, "%s (%s)\n", error.what(), error.code().c_str());
    return 1;
  }
}
