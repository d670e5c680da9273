// Checkpoint files with a valid digest, since the reader rejects an invalid one immediately.
#include "Harness.h"

#include "io/Digest.h"
#include "io/JsonNode.h"
#include "program/Checkpoint.h"

FENESTRA_FUZZ(Checkpoint, input) {
  fenestra::Digest digest;
  digest.add(input);
  std::string content(input);
  content += fenestra::asBytes(std::array{digest.value()});
  const auto path = fenestra::fuzzing::writeInput(content, "a.film");
  fenestra::fuzzing::expectReadOrError([&] {
    const fenestra::CheckpointFile film(path);
    const nlohmann::json here = {{"settings", {{"seed", {"1"}}}}, {"inputs", {{{"file", "a"}}}}};
    fenestra::findDifference(film.metadata(), here, path.string());
    constexpr int maxSize = 64; // pixels; a command checks the size against its own
    if (film.width() > maxSize || film.height() > maxSize)
      return;
    fenestra::RenderResult result = film.readProgress();
    film.readPixels(result.film);
    if (result.film.sampleCounts().max > 1)
      result.film.at(0, 0).standardError();
  });
}
