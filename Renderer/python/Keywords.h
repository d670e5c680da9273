#pragma once
// Keywords of Python calls as options of the library. Errors name the keyword.

#include <fenestra/Fenestra.h>

#include <pybind11/pybind11.h>

namespace fenestra::python {

/// Options by the names of the command line, with _ for -; a keyword that is absent or None has its
/// default. Throws TypeError for an unknown keyword or a wrong type, ValueError for an unknown
/// word.
SceneOptions readSceneOptions(const pybind11::dict& keywords);
/// Limits replace all those of `quality`, as on the command line. Throws as readSceneOptions().
RenderOptions readRenderOptions(const pybind11::dict& keywords);
ReadOptions readReadOptions(const pybind11::dict& keywords);
VolumeDescription readDescription(const pybind11::dict& keywords);
Display readDisplay(const pybind11::dict& keywords);

/// The keywords of readSceneOptions() that reproduce a camera.
pybind11::dict toKeywords(const Camera& camera);

} // namespace fenestra::python
