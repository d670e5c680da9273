#pragma once
// Flags of the renderer's command line that a scene's node may hold, and what a scene that anybody
// may have made says of them.

#include <string>
#include <vector>

namespace FenestraScene {

/// What a flag's value looks like. Limits are the renderer's to check.
enum class FlagKind {
  text,
  word,    ///< lower-case letters
  whole,   ///< a whole number, not negative
  number,  ///< a finite number
  numbers, ///< finite numbers, separated by commas
  size,    ///< two whole numbers, WxH
  colour,  ///< a word or numbers
  look     ///< a name, numbers, a JSON text, or the name of a file
};

struct Flag {
  std::string name;
  FlagKind kind;
};

const std::vector<Flag>& flags();

enum class Verdict {
  good,
  file, ///< names a file, by itself or inside its JSON text: opening it is the user's to allow
  bad   ///< no value of this flag's, or no flag
};

/// Of a flag's value that a scene holds.
Verdict verdictOn(const std::string& name, const std::string& value);

} // namespace FenestraScene
