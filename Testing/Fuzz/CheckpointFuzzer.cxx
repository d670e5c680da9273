// Films on disk, whose digest is always right: a wrong one ends every reading at once.
#include "Harness.h"

#include "io/Digest.h"
#include "io/JsonNode.h"
#include "program/Checkpoint.h"

FENESTRA_FUZZ(Film, input) {
  fenestra::Digest digest;
  digest.add(input);
  std::string content(input);
  content += fenestra::asBytes(std::array{digest.value()});
  const auto path = fenestra::fuzzing::writeInput(content, "a.film");
  fenestra::fuzzing::expectReadOrError([&] {
    const fenestra::CheckpointFile film(path);
    const nlohmann::json here = {{"settings", {{"seed", {"1"}}}}, {"inputs", {{{"file", "a"}}}}};
    fenestra::findDifference(film.made(), here, path.string());
    constexpr int maxSize =
        64; // pixels of a row and a column: a command knows the size, and checks it
    if (film.width() > maxSize || film.height() > maxSize)
      return;
    fenestra::RenderResult result = film.begun();
    film.read(result.film);
    if (result.film.sampleCounts().greatest > 1)
      result.film.at(0, 0).standardError();
  });
}
