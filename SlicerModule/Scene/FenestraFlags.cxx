#include "FenestraFlags.h"

#include <algorithm>
#include <locale>
#include <sstream>

namespace SlicerExport {
namespace {

constexpr std::size_t maxLength = 100000; // bytes; Linux allows 131,071 per argument

bool isInteger(const std::string& text) {
  constexpr std::size_t digits = 20; // of 2^64
  return !text.empty() && text.size() <= digits &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

/// True for finite numbers; streams do not read infinity and "nan".
bool areNumbers(const std::string& text, bool allowList) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  char comma = ',';
  while (comma == ',') {
    double number = 0.0;
    if (!(in >> number))
      return false;
    if (!(in >> comma))
      return true;
    if (!allowList)
      return false;
  }
  return false;
}

bool isWord(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
}

bool isSize(const std::string& text) {
  const std::size_t times = text.find('x');
  return times != std::string::npos && isInteger(text.substr(0, times)) &&
         isInteger(text.substr(times + 1));
}

/// True if the value may name a file. A JSON text opens a file by its member "file"; a backslash
/// may be an escape within that word. Any other value is a name: without / \ . : ~ it can only be a
/// file in the session's own folder.
bool mayNameFile(const std::string& value) {
  if (value.front() == '{')
    return value.find("\"file\"") != std::string::npos || value.find('\\') != std::string::npos;
  return !areNumbers(value, true) && value.find_first_of("/\\.:~") != std::string::npos;
}

bool matchesKind(FlagKind kind, const std::string& value) {
  switch (kind) {
  case FlagKind::word:
    return isWord(value);
  case FlagKind::integer:
    return isInteger(value);
  case FlagKind::number:
    return areNumbers(value, false);
  case FlagKind::numberOrAuto:
    return value == "auto" || areNumbers(value, false);
  case FlagKind::numbers:
    return areNumbers(value, true);
  case FlagKind::size:
    return isSize(value);
  case FlagKind::wordOrNumbers:
    return isWord(value) || areNumbers(value, true);
  case FlagKind::text:
  case FlagKind::textList:
  case FlagKind::resource:
    break;
  }
  return value.find('\0') == std::string::npos; // a null byte would end the argument
}

/// Flag with that name; null: none.
const Flag* findFlag(const std::string& name) {
  const auto flag = std::find_if(flags().begin(), flags().end(),
                                 [&](const Flag& one) { return one.name == name; });
  return flag == flags().end() ? nullptr : &*flag;
}

} // namespace

const std::vector<Flag>& flags() {
  using Kind = FlagKind;
  static const std::vector<Flag> all = {{"focus", Kind::text},
                                        {"preset", Kind::resource},
                                        {"margin", Kind::wordOrNumbers},
                                        {"labelsmoothing", Kind::numberOrAuto},
                                        {"clip", Kind::word},
                                        {"boundary", Kind::word},
                                        {"controlpoints", Kind::integer},
                                        {"smoothing", Kind::number},
                                        {"plane", Kind::numbers},
                                        {"hole", Kind::word},
                                        {"holemargin", Kind::number},
                                        {"ghost", Kind::number},
                                        {"offset", Kind::number},
                                        {"soft", Kind::numberOrAuto},
                                        {"contextdensity", Kind::number},
                                        {"contextsaturation", Kind::numberOrAuto},
                                        {"view", Kind::word},
                                        {"position", Kind::numbers},
                                        {"target", Kind::numbers},
                                        {"up", Kind::numbers},
                                        {"projection", Kind::word},
                                        {"scale", Kind::number},
                                        {"angle", Kind::number},
                                        {"transfer", Kind::resource},
                                        {"shift", Kind::number},
                                        {"density", Kind::number},
                                        {"gradient", Kind::word},
                                        {"volumesmoothing", Kind::wordOrNumbers},
                                        {"materials", Kind::resource},
                                        {"material", Kind::textList},
                                        {"lights", Kind::resource},
                                        {"environment", Kind::resource},
                                        {"background", Kind::wordOrNumbers},
                                        {"exposure", Kind::number},
                                        {"tone", Kind::word},
                                        {"annotate", Kind::text},
                                        {"size", Kind::size},
                                        {"samples", Kind::integer},
                                        {"seconds", Kind::number},
                                        {"noise", Kind::number},
                                        {"noisetarget", Kind::word},
                                        {"denoise", Kind::word},
                                        {"bounces", Kind::integer},
                                        {"seed", Kind::integer},
                                        {"sampling", Kind::word},
                                        {"frames", Kind::integer, true},
                                        {"degrees", Kind::number, true},
                                        {"steady", Kind::number, true}};
  return all;
}

Verdict checkFlag(const std::string& name, const std::string& value) {
  const Flag* const flag = findFlag(name);
  if (!flag || value.empty() || value.size() > maxLength || !matchesKind(flag->kind, value))
    return Verdict::invalid;
  return flag->kind == FlagKind::resource && mayNameFile(value) ? Verdict::file : Verdict::valid;
}

std::string joinList(const std::vector<std::string>& texts) {
  std::string value;
  for (const std::string& text : texts) {
    value += value.empty() ? "" : ",";
    for (const char c : text)
      value += c == ',' ? std::string("\\,") : std::string(1, c);
  }
  return value;
}

std::vector<std::string> splitList(const std::string& value) {
  std::vector<std::string> texts;
  std::string text;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == '\\' && i + 1 < value.size() && value[i + 1] == ',')
      text += value[++i];
    else if (value[i] != ',')
      text += value[i];
    else
      texts.push_back(std::move(text)), text.clear();
  }
  if (!value.empty())
    texts.push_back(text);
  return texts;
}

bool isRepeatable(const std::string& name) {
  const Flag* const flag = findFlag(name);
  return flag && flag->kind == FlagKind::textList;
}

std::vector<std::string> toArgumentValues(const std::string& name, const std::string& value) {
  return isRepeatable(name) ? splitList(value) : std::vector<std::string>{value};
}

std::vector<std::string> toArguments(const std::map<std::string, std::string>& flags) {
  std::vector<std::string> arguments;
  for (const auto& [name, value] : flags)
    for (const std::string& one : toArgumentValues(name, value))
      arguments.push_back("--" + name + "=" + one);
  return arguments;
}

} // namespace SlicerExport
