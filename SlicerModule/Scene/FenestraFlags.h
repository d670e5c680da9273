#pragma once
// Flags of the renderer's command line that a scene's node may hold, checks of their values in
// scenes from unknown sources, and the arguments that they are.

#include <map>
#include <string>
#include <vector>

namespace SlicerExport {

/// Form of a flag's value. The renderer checks the limits.
enum class FlagKind {
  text,
  texts,     ///< a flag that may be repeated: joined()
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

/// Texts as one value, separated by commas; a comma of a text becomes "\,", as in --focus.
std::string joined(const std::vector<std::string>& texts);
/// Texts in a value that joined() made; none of an empty one.
std::vector<std::string> textsIn(const std::string& value);

/// True for a flag of kind texts.
bool repeats(const std::string& name);
/// Values as the command line takes them, one an argument: several of a flag that repeats.
std::vector<std::string> valuesOf(const std::string& name, const std::string& value);
/// Arguments "--name=value" of flags; "=" keeps a value that begins with a dash.
std::vector<std::string> argumentsOf(const std::map<std::string, std::string>& flags);

} // namespace SlicerExport
