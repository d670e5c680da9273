#pragma once
// Silences ITK, which prints warnings to std::cerr; its failures are thrown as Errors.

namespace fenestra::core {

/// Discards std::cerr and disables ITK's warnings while any thread has such an object.
class SuppressItkOutput {
public:
  SuppressItkOutput();
  ~SuppressItkOutput();
  SuppressItkOutput(const SuppressItkOutput&) = delete;
  SuppressItkOutput& operator=(const SuppressItkOutput&) = delete;
};

} // namespace fenestra::core
