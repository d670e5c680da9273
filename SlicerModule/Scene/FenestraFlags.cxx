#include "FenestraFlags.h"

#include <algorithm>
#include <locale>
#include <sstream>

namespace SlicerExport {
namespace {

constexpr std::size_t longest = 100000; // bytes; an argument of a command may have 131,071

bool isWhole(const std::string& text) {
  constexpr std::size_t digits = 20; // as many as 2^64 has
  return !text.empty() && text.size() <= digits &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

/// True for numbers of any size that a double holds; infinity and "nan" are not read by streams.
bool areNumbers(const std::string& text, bool several) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  char comma = ',';
  while (comma == ',') {
    double number = 0.0;
    if (!(in >> number))
      return false;
    if (!(in >> comma))
      return true;
    if (!several)
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
  return times != std::string::npos && isWhole(text.substr(0, times)) &&
         isWhole(text.substr(times + 1));
}

/// True if a look may name a file. A JSON text opens a file by its member "file"; a backslash may
/// hide that word. Any other value is a name: without one of / \ . : ~ it can only be a file in the
/// session's own folder.
bool namesFile(const std::string& look) {
  if (look.front() == '{')
    return look.find("\"file\"") != std::string::npos || look.find('\\') != std::string::npos;
  return !areNumbers(look, true) && look.find_first_of("/\\.:~") != std::string::npos;
}

bool isKind(FlagKind kind, const std::string& value) {
  switch (kind) {
  case FlagKind::word:
    return isWord(value);
  case FlagKind::whole:
    return isWhole(value);
  case FlagKind::number:
    return areNumbers(value, false);
  case FlagKind::automatic:
    return value == "auto" || areNumbers(value, false);
  case FlagKind::numbers:
    return areNumbers(value, true);
  case FlagKind::size:
    return isSize(value);
  case FlagKind::colour:
    return isWord(value) || areNumbers(value, true);
  case FlagKind::text:
  case FlagKind::texts:
  case FlagKind::look:
    break;
  }
  return value.find('\0') == std::string::npos; // a zero byte would end an argument
}

/// Flag of that name; null: none.
const Flag* find(const std::string& name) {
  const auto flag = std::find_if(flags().begin(), flags().end(),
                                 [&](const Flag& one) { return one.name == name; });
  return flag == flags().end() ? nullptr : &*flag;
}

} // namespace

const std::vector<Flag>& flags() {
  using Kind = FlagKind;
  static const std::vector<Flag> all = {{"focus", Kind::text},
                                        {"preset", Kind::look},
                                        {"margin", Kind::numbers},
                                        {"labelsmoothing", Kind::automatic},
                                        {"clip", Kind::word},
                                        {"boundary", Kind::word},
                                        {"controlpoints", Kind::whole},
                                        {"smoothing", Kind::number},
                                        {"plane", Kind::numbers},
                                        {"hole", Kind::word},
                                        {"holemargin", Kind::number},
                                        {"ghost", Kind::number},
                                        {"offset", Kind::number},
                                        {"soft", Kind::automatic},
                                        {"contextdensity", Kind::number},
                                        {"contextsaturation", Kind::automatic},
                                        {"view", Kind::word},
                                        {"position", Kind::numbers},
                                        {"target", Kind::numbers},
                                        {"up", Kind::numbers},
                                        {"projection", Kind::word},
                                        {"scale", Kind::number},
                                        {"angle", Kind::number},
                                        {"transfer", Kind::look},
                                        {"shift", Kind::number},
                                        {"density", Kind::number},
                                        {"materials", Kind::look},
                                        {"material", Kind::texts},
                                        {"lights", Kind::look},
                                        {"environment", Kind::look},
                                        {"background", Kind::colour},
                                        {"exposure", Kind::number},
                                        {"tone", Kind::word},
                                        {"size", Kind::size},
                                        {"samples", Kind::whole},
                                        {"seconds", Kind::number},
                                        {"noise", Kind::number},
                                        {"noisetarget", Kind::word},
                                        {"denoise", Kind::word},
                                        {"bounces", Kind::whole},
                                        {"seed", Kind::whole},
                                        {"sampling", Kind::word},
                                        {"frames", Kind::whole, true},
                                        {"degrees", Kind::number, true},
                                        {"steady", Kind::number, true}};
  return all;
}

Verdict verdictOn(const std::string& name, const std::string& value) {
  const Flag* const flag = find(name);
  if (!flag || value.empty() || value.size() > longest || !isKind(flag->kind, value))
    return Verdict::bad;
  return flag->kind == FlagKind::look && namesFile(value) ? Verdict::file : Verdict::good;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string value;
  for (const std::string& text : texts) {
    value += value.empty() ? "" : ",";
    for (const char c : text)
      value += c == ',' ? std::string("\\,") : std::string(1, c);
  }
  return value;
}

std::vector<std::string> textsIn(const std::string& value) {
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

bool repeats(const std::string& name) {
  const Flag* const flag = find(name);
  return flag && flag->kind == FlagKind::texts;
}

std::vector<std::string> valuesOf(const std::string& name, const std::string& value) {
  return repeats(name) ? textsIn(value) : std::vector<std::string>{value};
}

std::vector<std::string> argumentsOf(const std::map<std::string, std::string>& flags) {
  std::vector<std::string> arguments;
  for (const auto& [name, value] : flags)
    for (const std::string& one : valuesOf(name, value))
      arguments.push_back("--" + name + "=" + one);
  return arguments;
}

} // namespace SlicerExport
