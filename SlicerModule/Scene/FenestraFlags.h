#pragma once
// Flags: options of the renderer's command line that a scene's node may hold. Checks their values,
// since scenes may come from untrusted sources, and converts them to arguments.

#include <map>
#include <string>
#include <vector>

namespace SlicerExport {

/// Form of a flag's value. The renderer checks the range.
enum class FlagKind {
  text,
  textList,     ///< values of a repeatable flag: joinList()
  word,         ///< lowercase letters and hyphens
  integer,      ///< a nonnegative integer
  number,       ///< a finite number
  numberOrAuto, ///< a finite number or the word auto
  numbers,      ///< finite numbers, separated by commas
  size,         ///< two integers, WxH
  wordOrNumbers,
  resource ///< a name, numbers, a JSON text, or a file name
};

struct Flag {
  std::string name;
  FlagKind kind;
  bool turntableOnly = false; ///< only for `fenestra turntable`
};

const std::vector<Flag>& flags();

enum class Verdict {
  valid,
  file,   ///< names a file, directly or in its JSON text: the user must allow opening it
  invalid ///< unknown flag, or invalid value
};

/// Checks the value of a flag that a scene stores.
Verdict checkFlag(const std::string& name, const std::string& value);

/// Joins texts by commas; a comma within a text becomes "\,", as in --focus.
std::string joinList(const std::vector<std::string>& texts);
/// Splits a value of joinList(); no texts if it is empty.
std::vector<std::string> splitList(const std::string& value);

/// True for a flag of kind textList.
bool isRepeatable(const std::string& name);
/// Values for the command line, one per argument; several for a repeatable flag.
std::vector<std::string> toArgumentValues(const std::string& name, const std::string& value);
/// Arguments "--name=value" of flags; "=" allows values that begin with a dash.
std::vector<std::string> toArguments(const std::map<std::string, std::string>& flags);

} // namespace SlicerExport
