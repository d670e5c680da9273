// The extension module fenestra._fenestra: the library's classes with numpy arrays and keywords.
// The package beside it converts images, shows progress and has the documentation.

#include "python/Arrays.h"
#include "python/Keywords.h"
#include "python/UnlockedCall.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <type_traits>
#include <utility>

namespace fenestra::python {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Calls without Python's lock.
template <class F>
auto unlocked(const F& call) {
  const UnlockedCall lock;
  return call();
}

/// An image plane with `channels` values per pixel.
py::object viewPlane(const py::object& image, std::span<const float> (Image::*plane)() const,
                     int channels) {
  const auto& of = image.cast<const Image&>();
  const std::span<const float> values = (of.*plane)();
  std::vector<py::ssize_t> shape = {of.height(), of.width()};
  if (channels > 1)
    shape.push_back(channels);
  return values.empty() ? py::none() : viewArray(values.data(), std::move(shape), image);
}

// ---- errors

py::handle errorType; ///< fenestra.Error; never destroyed

/// Text of UTF-8. Names of files may have other bytes, which are replaced.
py::str toText(const std::string& bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace"));
}

/// What helps, by code, in keywords of Python; empty: nothing more than the message says.
std::string findAdvice(std::string_view of) {
  constexpr std::pair<std::string_view, const char*> table[] = {
      {"ambiguous-preset", "choose one, as preset='liver'"},
      {"ambiguous-segmentation", "choose one by segmentation="},
      {"ambiguous-volume", "choose one by volume="},
      {"focus-outside-image", "change view, target or scale"},
      {"no-matching-preset", "give focus="},
      {"removed-hounsfield-offset", "transfer_shift=-1024 reverts this"},
      {"removed-table", "table='keep' shows it"},
      {"segmentation-required", "give segmentation="},
      {"spacing-required", "give spacing=(x, y, z), mm"},
      {"unknown-label-version", "give labels='totalsegmentator1' or 'totalsegmentator2'"},
      {"unmatched-labels", "give the table of this label map as labels="},
      {"unnamed-segments", "labels= names the values"},
  };
  for (const auto& [code, advice] : table)
    if (of == code)
      return std::string("; ") + advice;
  return {};
}

const char* toWord(ErrorKind kind) {
  return kind == ErrorKind::request ? "request" : kind == ErrorKind::input ? "input" : "output";
}

void raise(const Error& error) {
  py::object value = errorType(toText(error.what() + findAdvice(error.code())));
  value.attr("kind") = toWord(error.kind());
  value.attr("code") = toText(error.code());
  value.attr("subject") = toText(error.subject());
  value.attr("detail") = toText(error.detail());
  PyErr_SetObject(errorType.ptr(), value.ptr());
}

void defineError(py::module_& module) {
  py::dict members;
  for (const char* name : {"kind", "code", "subject", "detail"})
    members[name] = "";
  errorType = PyErr_NewExceptionWithDoc(
      "fenestra.Error",
      "Fenestra cannot do what was asked. str(error) is 'subject: detail', and possibly advice.\n\n"
      "kind: 'request' (impossible), 'input' (a volume, a segmentation or a file is wrong) or\n"
      "    'output' (a result cannot be written, or a resource is missing)\n"
      "code: kind of problem, such as 'missing-file'; programs may depend on it\n"
      "subject: what it concerns: a file, 'file: field' or a part of the request\n"
      "detail: what is wrong",
      PyExc_RuntimeError, members.ptr());
  module.attr("Error") = errorType;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const Error& error) {
      raise(error);
    }
  });
}

// ---- rendering

/// Lets Python handle signals and calls `onProgress` (None: nobody). A stop by Ctrl-C
/// (KeyboardInterrupt) is remembered if it keeps the samples so far.
class Monitor {
public:
  Monitor(const py::object& onProgress, bool keepsInterrupted)
      : m_onProgress(onProgress), m_keepsInterrupted(keepsInterrupted) {}

  bool operator()(const Progress& progress) {
    if (m_isStopped || UnlockedCall::isEnding())
      return false;
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
      m_isStopped =
          !m_onProgress.is_none() &&
          m_onProgress(progress.fraction, progress.seconds, progress.noise).is(py::bool_(false));
    } catch (py::error_already_set& error) {
      if (!m_keepsInterrupted || !error.matches(PyExc_KeyboardInterrupt))
        throw;
      m_isStopped = m_isInterrupted = true;
    }
    return !m_isStopped;
  }

  bool isInterrupted() const { return m_isInterrupted; }

private:
  const py::object& m_onProgress;
  bool m_keepsInterrupted;
  bool m_isStopped = false, m_isInterrupted = false;
};

Image renderImage(const Scene& scene, const py::dict& keywords, const py::object& onProgress,
                  bool keepsInterrupted) {
  const RenderOptions options = readRenderOptions(keywords);
  Monitor monitor(onProgress, keepsInterrupted);
  try {
    return unlocked([&] { return render(scene, options, std::ref(monitor)); });
  } catch (const Error& error) {
    UnlockedCall::requireLife();
    if (!monitor.isInterrupted() || error.code() != "stopped")
      throw;
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
}

// ---- inputs

Affine makeAffine(const Numbers& matrix) {
  Affine affine;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      affine[row][column] = matrix.at(row, column);
  return affine;
}

py::list toTexts(const std::vector<Warning>& warnings) {
  py::list texts;
  for (const Warning& warning : warnings)
    texts.append(toText(warning.text() + findAdvice(warning.code)));
  return texts;
}

Volume makeVolume(const py::array& samples, const Numbers& affine, const py::dict& keywords) {
  const py::array array = unbroadcast(samples);
  const Samples memory = makeSamples(array, "input");
  const Affine indexToWorld = makeAffine(affine);
  const VolumeDescription description = readDescription(keywords);
  return unlocked([&] { return Volume(memory, indexToWorld, description); });
}

Segmentation makeSegmentation(const py::array& labels, const Numbers& affine,
                              const std::map<std::int32_t, std::string>& names) {
  const py::array array = unbroadcast(labels);
  const Samples memory = makeSamples(array, "segmentation");
  const Affine indexToWorld = makeAffine(affine);
  return unlocked([&] { return Segmentation(memory, indexToWorld, names); });
}

Segmentation makeMasks(const std::vector<std::pair<std::string, py::array>>& masks,
                       const Numbers& affine) {
  std::vector<py::array> arrays;
  std::vector<SegmentMask> memory;
  for (const auto& [name, mask] : masks) {
    arrays.push_back(unbroadcast(mask));
    memory.push_back({name, makeSamples(arrays.back(), "segmentation['" + name + "']")});
  }
  const Affine indexToWorld = makeAffine(affine);
  return unlocked([&] { return Segmentation(memory, indexToWorld); });
}

void defineInputs(py::module_& module) {
  py::class_<Volume>(module, "Volume", "A scalar volume; copies share its voxels.")
      .def(py::init(&makeVolume), "samples"_a.noconvert(), "affine"_a, "description"_a,
           "Copies an array (i, j, k) with the 4x4 `affine` of RAS mm. Description: name, "
           "modality, contrast_agent.")
      .def_property_readonly(
          "shape", [](const Volume& volume) { return py::tuple(py::cast(volume.size())); })
      .def_property_readonly(
          "affine",
          [](const Volume& volume) {
            Affine rows = volume.indexToWorld();
            std::vector<std::array<double, 4>> matrix(rows.begin(), rows.end());
            matrix.push_back({0.0, 0.0, 0.0, 1.0});
            return py::array(py::cast(matrix));
          },
          "4x4, index to RAS mm")
      .def("warnings", [](const Volume& volume) { return toTexts(volume.warnings()); });
  module.def(
      "read_volume",
      [](const std::string& path, const py::dict& keywords) {
        const ReadOptions options = readReadOptions(keywords);
        return unlocked([&] { return readVolume(path, options); });
      },
      "path"_a, "options"_a, "Options: volume, frame, spacing.");
  module.def(
      "read_label_names",
      [](const std::string& table) { return unlocked([&] { return readLabelNames(table); }); },
      "table"_a);
  py::class_<Segmentation>(module, "Segmentation", "Segments on a grid of their own.")
      .def(py::init(&makeSegmentation), "labels"_a.noconvert(), "affine"_a, "names"_a,
           "A label map (i, j, k); 0 is the background.")
      .def(py::init(&makeMasks), "masks"_a, "affine"_a, "Named masks of equal shape.")
      .def("warnings",
           [](const Segmentation& segmentation) { return toTexts(segmentation.warnings()); });
  module.def(
      "read_segmentation",
      [](const std::string& path, const std::optional<std::string>& labels, const Volume& volume) {
        return unlocked([&] { return readSegmentation(path, labels, volume); });
      },
      "path"_a, "labels"_a, "volume"_a);
}

// ---- scenes

/// A property of a surface: a row per point or triangle.
template <class Row>
auto viewRows(std::vector<Row> ClipSurface::*member) {
  return [member](const py::object& self) {
    const std::vector<Row>& rows = self.cast<const ClipSurface&>().*member;
    const auto count = static_cast<py::ssize_t>(rows.size());
    if constexpr (std::is_arithmetic_v<Row>)
      return viewArray(rows.data(), {count}, self);
    else
      return viewArray(rows.data()->data(), {count, 3}, self);
  };
}

void defineClipSurface(py::module_& module) {
  py::class_<ClipSurface>(module, "ClipSurface",
                          "Clipping surface as triangles, from Scene.clip_surface().")
      .def_property_readonly("points", viewRows(&ClipSurface::points), "(N, 3) float64, RAS mm")
      .def_property_readonly("depths", viewRows(&ClipSurface::depths),
                             "(N,) float32, of each point along the viewing direction, mm")
      .def_property_readonly("triangles", viewRows(&ClipSurface::triangles),
                             "(M, 3) uint32, indices of points, counterclockwise as seen from the "
                             "camera")
      .def(
          "save",
          [](const ClipSurface& surface, const std::filesystem::path& path) {
            unlocked([&] { surface.save(path.string()); });
          },
          "path"_a, "Writes a .vtp, .ply or .stl. Raises fenestra.Error.");
}

void defineScene(py::module_& module) {
  const auto ask = [](auto question) {
    return [question](const Scene& scene, int width, int height) {
      return unlocked([&] { return (scene.*question)(width, height); });
    };
  };
  py::class_<Scene>(module, "Scene", "What is rendered; fenestra.Scene is its interface.")
      .def(py::init([](const Volume& volume, const std::optional<Segmentation>& segmentation,
                       const py::dict& keywords) {
             const SceneOptions options = readSceneOptions(keywords);
             return unlocked([&] {
               return segmentation ? Scene(volume, *segmentation, options) : Scene(volume, options);
             });
           }),
           "volume"_a, "segmentation"_a, "options"_a)
      .def(
          "with_options",
          [](const Scene& scene, const py::dict& keywords) {
            const SceneOptions options = readSceneOptions(keywords);
            return unlocked([&] { return scene.withOptions(options); });
          },
          "options"_a)
      .def(
          "warnings",
          [](const Scene& scene, int width, int height) {
            return toTexts(unlocked([&] { return scene.warnings(width, height); }));
          },
          "width"_a, "height"_a)
      .def("segments",
           [](const Scene& scene) {
             std::vector<std::pair<std::int32_t, py::str>> segments;
             for (const Segment& segment : unlocked([&] { return scene.segments(); }))
               segments.emplace_back(segment.label, toText(segment.name));
             return segments;
           })
      .def("choices", ask(&Scene::choices), "width"_a, "height"_a)
      .def(
          "camera",
          [](const Scene& scene, int width, int height) {
            return toKeywords(unlocked([&] { return scene.camera(width, height); }));
          },
          "width"_a, "height"_a)
      .def("clip_surface", ask(&Scene::clipSurface), "width"_a, "height"_a);
  module.def(
      "read_scene",
      [](const std::string& path, const std::optional<std::string>& segmentation,
         const std::optional<std::string>& labels, const py::dict& keywords,
         const py::dict& reading) {
        const SceneOptions options = readSceneOptions(keywords);
        const ReadOptions how = readReadOptions(reading);
        return unlocked([&] { return readScene(path, segmentation, labels, options, how); });
      },
      "path"_a, "segmentation"_a, "labels"_a, "options"_a, "reading"_a);
  module.def("render", &renderImage, "scene"_a, "options"_a, "on_progress"_a, "keeps_interrupted"_a,
             "Renders. on_progress(fraction, seconds, noise), or None; if it returns False, the "
             "image has the samples so far.");
}

// ---- images

py::array displayImage(const Image& image, const py::kwargs& keywords) {
  const Display display = readDisplay(keywords);
  auto values =
      std::make_unique<std::vector<std::uint8_t>>(unlocked([&] { return image.display(display); }));
  const std::uint8_t* data = values->data();
  const py::capsule owner(values.release(), [](void* pointer) {
    delete static_cast<std::vector<std::uint8_t>*>(pointer);
  });
  return py::array_t<std::uint8_t>(std::vector<py::ssize_t>{image.height(), image.width(), 4}, data,
                                   owner);
}

py::bytes encodeImage(const Image& image, const py::kwargs& keywords) {
  const Display display = readDisplay(keywords);
  return unlocked([&] { return image.png(display); });
}

void defineImage(py::module_& module) {
  const auto plane = [](auto member, int channels = 1) {
    return [member, channels](const py::object& self) { return viewPlane(self, member, channels); };
  };
  py::class_<Image>(module, "Image",
                    "Result of a render. Arrays are read-only, (height, width) or (height, width, "
                    "channels), row by row from the top; they keep the image's memory alive.")
      .def_property_readonly("rgba", plane(&Image::rgba, 4),
                             "(H, W, 4) float32: radiance, linear Rec. 709 with premultiplied "
                             "alpha; unbiased")
      .def_property_readonly("denoised", plane(&Image::denoised, 4),
                             "(H, W, 4) float32, as rgba; None: not denoised")
      .def_property_readonly("depth", plane(&Image::depth),
                             "(H, W) float32: mean depth of the first collision along the viewing "
                             "direction, mm; infinity: none")
      .def_property_readonly("clip_depth", plane(&Image::clipDepth),
                             "(H, W) float32: depth of the clipping surface, mm; None: no clip")
      .def_property_readonly("normals", plane(&Image::normals, 3),
                             "(H, W, 3) float32: at the first collision, mean over the samples, "
                             "RAS axes")
      .def_property_readonly("albedo", plane(&Image::albedo, 3),
                             "(H, W, 3) float32: at the first collision, mean over the samples")
      .def_property_readonly("error", plane(&Image::error, 3),
                             "(H, W, 3) float32: standard error of the colors of rgba")
      .def_property_readonly("sample_counts", plane(&Image::sampleCounts),
                             "(H, W) float32: samples of each pixel")
      .def_property_readonly("width", &Image::width, "pixels")
      .def_property_readonly("height", &Image::height, "pixels")
      .def_property_readonly("noise", &Image::noise,
                             "root of the mean of error^2 / (radiance^2 + 0.01)")
      .def_property_readonly("denoised_noise", &Image::denoisedNoise,
                             "estimated noise after denoising; infinity: unknown")
      .def_property_readonly("samples", &Image::samples, "mean samples per pixel")
      .def_property_readonly("complete", &Image::isComplete,
                             "False if the render was stopped before it reached its limits")
      .def_property_readonly("metadata", &Image::metadata,
                             "dict of what reproduces the image: version, seed, camera, ...")
      .def("display", &displayImage,
           "(H, W, 4) uint8: sRGB with straight alpha, of the denoised image if there is one.\n\n"
           "tone: 'film' or 'photographic'\nexposure: stops\nscale, orientation: True adds a scale "
           "bar (orthographic projection), letters for the patient's sides")
      .def("png", &encodeImage, "The bytes of a .png file. Keywords as display().")
      .def(
          "save",
          [](const Image& image, const std::filesystem::path& path, const py::kwargs& keywords) {
            const Display display = readDisplay(keywords);
            unlocked([&] { image.save(path.string(), display); });
          },
          "path"_a,
          "Writes a .png or .tif (for display), .exr or .nrrd (raw). Keywords as display(). "
          "Raises fenestra.Error.")
      .def("_repr_png_", [](const Image& image) { return encodeImage(image, {}); })
      .def("__repr__", [](const Image& image) {
        return "<fenestra.Image " + std::to_string(image.width()) + "x" +
               std::to_string(image.height()) + ", " + std::to_string(image.samples()) +
               " samples per pixel" + (image.isComplete() ? ">" : ", incomplete>");
      });
}

} // namespace

PYBIND11_MODULE(_fenestra, module) {
  module.doc() = "Fenestra's C++ library; see the package fenestra.";
  module.attr("version") = FENESTRA_VERSION;
  defineError(module);
  defineInputs(module);
  defineImage(module);
  defineClipSurface(module);
  defineScene(module);
  module.def("end_all", &UnlockedCall::endAll, "Stops all renders, for atexit.");
  module.def("forget_all", &UnlockedCall::forgetAll, "For the child of a fork.");
}

} // namespace fenestra::python
