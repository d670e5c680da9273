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
  textList,     ///< a flag that may be repeated: joined()
  word,         ///< lower-case letters
  integer,      ///< a whole number, not negative
  number,       ///< a finite number
  numberOrAuto, ///< a finite number, or the word auto
  numbers,      ///< finite numbers, separated by commas
  size,         ///< two whole numbers, WxH
  color,        ///< a word or numbers
  resource      ///< a name, numbers, a JSON text, or the name of a file
};

struct Flag {
  std::string name;
  FlagKind kind;
  bool turntableOnly = false; ///< of `fenestra turntable` alone
};

const std::vector<Flag>& flags();

enum class Verdict {
  valid,
  file,   ///< names a file, by itself or inside its JSON text: the user must allow opening it
  invalid ///< no value of this flag, or no flag
};

/// Checks a flag's value stored in a scene.
Verdict checkFlag(const std::string& name, const std::string& value);

/// Texts as one value, separated by commas; a comma of a text becomes "\,", as in --focus.
std::string joinList(const std::vector<std::string>& texts);
/// Texts in a value that joined() made; none of an empty one.
std::vector<std::string> splitList(const std::string& value);

/// True for a flag of kind texts.
bool isRepeatable(const std::string& name);
/// Values as the command line takes them, one an argument: several of a flag that repeats.
std::vector<std::string> toArgumentValues(const std::string& name, const std::string& value);
/// Arguments "--name=value" of flags; "=" keeps a value that begins with a dash.
std::vector<std::string> toArguments(const std::map<std::string, std::string>& flags);

} // namespace SlicerExport
