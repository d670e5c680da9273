#pragma once
// Facts about this program, for bug reports, packagers and papers: version, commit, compiler,
// instruction set, licence, and the libraries that it runs with.

#include <string>
#include <utility>
#include <vector>

namespace fenestra {

/// Names and versions of the libraries: of the one that is loaded where it tells, else of its
/// headers.
std::vector<std::pair<std::string, std::string>> libraryVersions();

/// "fenestra VERSION", then the facts, a line each.
std::string aboutText();
/// The facts as one JSON document.
std::string aboutJson();

} // namespace fenestra
