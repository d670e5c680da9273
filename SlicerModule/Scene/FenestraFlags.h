#pragma once
// Flags of the renderer's command line that a scene's node may hold, and checks of their values in
// scenes from unknown sources.

#include <string>
#include <vector>

namespace FenestraScene {

/// Form of a flag's value. The renderer checks the limits.
enum class FlagKind {
  text,
  word,      ///< lower-case letters
  whole,     ///< a whole number, not negative
  number,    ///< a finite number
  automatic, ///< a finite number, or the word auto
  numbers,   ///< finite numbers, separated by commas
  size,      ///< two whole numbers, WxH
  colour,    ///< a word or numbers
  look       ///< a name, numbers, a JSON text, or the name of a file
};

struct Flag {
  std::string name;
  FlagKind kind;
  bool ofTurntable = false; ///< of `fenestra turntable` alone
};

const std::vector<Flag>& flags();

enum class Verdict {
  good,
  file, ///< names a file, by itself or inside its JSON text: the user must allow opening it
  bad   ///< no value of this flag, or no flag
};

/// Checks a flag's value stored in a scene.
Verdict verdictOn(const std::string& name, const std::string& value);

} // namespace FenestraScene
