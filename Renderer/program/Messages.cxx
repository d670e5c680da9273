#include "program/Messages.h"

#include "base/Text.h"
#include "io/MessageText.h"
#include "io/platform/Streams.h"

#include <atomic>
#include <iostream>
#include <mutex>

namespace fenestra::core {
namespace {

constexpr std::string_view eraser = "\r\033[K";

std::mutex mutex; ///< guards the bar and the order of the text
std::string shownBar;
std::atomic<bool> isBarShown = false, goesToOutput = false, mayCloseOutput = false;

} // namespace

void printLinesToOutput() {
  goesToOutput = true;
}

void printLine(std::string_view line) {
  const std::string text = toOneLine(std::string(line)) + '\n';
  const std::lock_guard lock(mutex);
  if (goesToOutput)
    std::cout << text << std::flush;
  else
    writeToStandardError(concat(barEraser(), text, shownBar));
}

void printWarning(std::string_view warning) {
  printLine(concat("fenestra: warning: ", warning));
}

void showBar(const std::string& bar) {
  const std::lock_guard lock(mutex);
  shownBar = bar;
  isBarShown = true;
  writeToStandardError(concat(eraser, bar));
}

void eraseBar() {
  const std::lock_guard lock(mutex);
  writeToStandardError(barEraser());
  shownBar.clear();
  isBarShown = false;
}

std::string_view barEraser() {
  return isBarShown ? eraser : std::string_view();
}

void allowClosedOutput() {
  mayCloseOutput = true;
}

bool isClosedOutputAllowed() {
  return mayCloseOutput;
}

} // namespace fenestra::core
