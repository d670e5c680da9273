// Checkpoint files with a valid digest, since the reader rejects an invalid one immediately.
#include "Harness.h"

#include "io/Digest.h"
#include "io/JsonNode.h"
#include "program/Checkpoint.h"

FENESTRA_FUZZ(Checkpoint, input) {
  fenestra::core::Digest digest;
  digest.add(input);
  std::string content(input);
  content += fenestra::core::asBytes(std::array{digest.value()});
  const auto path = fenestra::core::fuzzing::writeInput(content, "a.film");
  fenestra::core::fuzzing::expectReadOrError([&] {
    const fenestra::core::CheckpointFile film(path);
    const nlohmann::json here = {{"settings", {{"seed", {"1"}}}}, {"inputs", {{{"file", "a"}}}}};
    fenestra::core::findDifference(film.metadata(), here, path.string());
    constexpr int maxSize = 64; // pixels; a command checks the size against its own
    if (film.width() > maxSize || film.height() > maxSize)
      return;
    fenestra::core::RenderResult result = film.readProgress();
    film.readPixels(result.film);
    if (result.film.sampleCounts().max > 1)
      result.film.at(0, 0).standardError();
  });
}
