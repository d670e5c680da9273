// Command line of a render, one word per line. Reads and writes no files.
#include "Harness.h"

#include "program/CommandLine.h"
#include "program/RenderOptions.h"

#include <vector>

FENESTRA_FUZZ(CommandLine, input) {
  using namespace fenestra::core;
  std::vector<std::string> words = {"fenestra"};
  while (!input.empty() && words.size() < 64) {
    const std::string_view word = input.substr(0, input.find('\n'));
    input.remove_prefix(std::min(input.size(), word.size() + 1));
    words.emplace_back(word.substr(0, word.find('\0'))); // as in argv
  }
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  if (const auto values =
          parseCommandLine(renderSyntax, static_cast<int>(argv.size()), argv.data(), 1))
    makeRenderOptions(*values);
}
