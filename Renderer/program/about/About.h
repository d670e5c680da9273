#pragma once
// Facts about this build, for bug reports, packagers and papers: version, commit, compiler,
// instruction set, license and libraries.

#include <string>
#include <utility>
#include <vector>

namespace fenestra::core {

/// Names and versions of the libraries: of the loaded library if it reports one, else of its
/// headers.
std::vector<std::pair<std::string, std::string>> libraryVersions();

/// "fenestra VERSION" and the facts, one per line.
std::string aboutText();
/// The facts as one JSON document.
std::string aboutJson();

} // namespace fenestra::core
