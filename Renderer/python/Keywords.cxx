#include "python/Keywords.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <tuple>
#include <utility>

namespace fenestra::python {
namespace {

namespace py = pybind11;

template <class T>
using Words = std::vector<std::pair<const char*, T>>;

std::string quote(const py::handle& value) {
  return py::repr(value).cast<std::string>();
}

/// Converts one value. Throws py::cast_error for a wrong type.
template <class T>
struct Convert {
  static T from(const py::handle& value) { return value.cast<T>(); }
};

/// A string, or a path.
template <>
struct Convert<std::string> {
  static std::string from(const py::handle& value) {
    if (py::isinstance<py::str>(value))
      return value.cast<std::string>();
    return value.cast<std::filesystem::path>().string();
  }
};

/// One element, or a sequence. Numbers may name segments.
template <>
struct Convert<std::vector<std::string>> {
  static std::vector<std::string> from(const py::handle& value) {
    const auto toText = [](const py::handle& one) { return py::str(one).cast<std::string>(); };
    if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value))
      return {toText(value)};
    std::vector<std::string> texts;
    for (const py::handle one : py::iter(value))
      texts.push_back(toText(one));
    return texts;
  }
};

template <>
struct Convert<std::vector<double>> {
  static std::vector<double> from(const py::handle& value) {
    if (PyNumber_Check(value.ptr()) != 0 && PySequence_Check(value.ptr()) == 0)
      return {value.cast<double>()};
    return value.cast<std::vector<double>>();
  }
};

template <>
struct Convert<Plane> {
  static Plane from(const py::handle& value) {
    const auto [origin, normal] = value.cast<std::pair<Vector3, Vector3>>();
    return {origin, normal};
  }
};

template <class T>
struct Convert<std::optional<T>> {
  static std::optional<T> from(const py::handle& value) { return Convert<T>::from(value); }
};

bool isColor(const py::handle& value) {
  return !py::isinstance<py::str>(value) &&
         (PyNumber_Check(value.ptr()) != 0 || PySequence_Check(value.ptr()) != 0);
}

/// A gray, or three components.
Color toColor(const py::handle& value) {
  if (PySequence_Check(value.ptr()) != 0)
    return value.cast<Color>();
  const double gray = value.cast<double>();
  return {gray, gray, gray};
}

/// A name, a path, JSON, or a dict, which becomes JSON.
std::string toDocument(const py::handle& value) {
  if (py::isinstance<py::dict>(value))
    return py::module_::import("json").attr("dumps")(value).cast<std::string>();
  return Convert<std::string>::from(value);
}

/// Meaning of a word. Throws ValueError.
template <class E>
E toMeaning(const char* name, const py::handle& value, const Words<E>& words) {
  const auto text = value.cast<std::string>();
  std::string known;
  for (const auto& [word, meaning] : words) {
    if (text == word)
      return meaning;
    known += std::string(known.empty() ? "" : ", ") + word;
  }
  throw py::value_error(std::string(name) + ": " + quote(value) + " is none of " + known);
}

/// Keywords of a call, each taken once.
class Keywords {
public:
  explicit Keywords(const py::dict& values) : m_rest(values.attr("copy")()) {}

  /// Sets `field` by `convert`, if the keyword is given.
  template <class T, class F>
  void take(const char* name, T& field, const F& convert) {
    const py::object value = m_rest.attr("pop")(name, py::none());
    if (value.is_none())
      return;
    try {
      field = convert(value);
    } catch (const py::cast_error&) {
      throw py::type_error(std::string(name) + ": " + quote(value) +
                           " has the wrong type, or is out of range");
    }
  }

  template <class T>
  void take(const char* name, T& field) {
    take(name, field, Convert<T>::from);
  }

  /// Sets `field` to the value of a word.
  template <class T, class E>
  void takeWord(const char* name, T& field, const Words<E>& words) {
    take(name, field, [&](const py::object& value) { return toMeaning(name, value, words); });
  }

  /// Throws TypeError if a keyword was not taken.
  void finish() const {
    for (const auto& [name, value] : m_rest)
      throw py::type_error(py::str(name).cast<std::string>() + ": unknown keyword");
  }

private:
  py::dict m_rest;
};

void readView(Keywords& keywords, View& view) {
  keywords.take("view", view.name);
  keywords.take("position", view.position);
  keywords.take("target", view.target);
  keywords.take("up", view.up);
  keywords.takeWord("projection", view.projection,
                    Words<Projection>{{"orthographic", Projection::orthographic},
                                      {"perspective", Projection::perspective}});
  keywords.take("scale", view.scale);
  keywords.take("angle", view.angle);
}

void readClip(Keywords& keywords, Clip& clip) {
  keywords.takeWord("clip", clip.mode,
                    Words<ClipMode>{{"auto", ClipMode::automatic},
                                    {"none", ClipMode::none},
                                    {"plane", ClipMode::plane},
                                    {"cutaway", ClipMode::cutaway},
                                    {"surface", ClipMode::surface},
                                    {"hole", ClipMode::hole},
                                    {"ghost", ClipMode::ghost}});
  keywords.takeWord(
      "clip_boundary", clip.boundary,
      Words<ClipBoundary>{{"exact", ClipBoundary::exact}, {"spline", ClipBoundary::spline}});
  keywords.take("control_points", clip.controlPoints);
  keywords.take("spline_smoothing", clip.splineSmoothing);
  keywords.take("plane", clip.plane);
  keywords.takeWord("hole", clip.hole,
                    Words<HoleShape>{{"box", HoleShape::box},
                                     {"cylinder", HoleShape::cylinder},
                                     {"sphere", HoleShape::sphere}});
  keywords.take("hole_margin", clip.holeMargin);
  keywords.take("ghost", clip.ghost);
  keywords.take("clip_offset", clip.offset);
  keywords.take("clip_softness", clip.softness);
}

VolumeSmoothing toVolumeSmoothing(const py::object& value) {
  using Kind = VolumeSmoothing::Kind;
  if (!py::isinstance<py::str>(value))
    return {Kind::given, value.cast<double>()};
  const Words<Kind> words = {{"auto", Kind::automatic}, {"off", Kind::off}};
  return {toMeaning("volume_smoothing", value, words)};
}

void readAppearance(Keywords& keywords, Appearance& appearance) {
  keywords.take("transfer", appearance.transfer, toDocument);
  keywords.take("transfer_shift", appearance.transferShift);
  keywords.take("density_scale", appearance.density);
  keywords.takeWord("gradient", appearance.gradient,
                    Words<Gradient>{{"sobel", Gradient::sobel}, {"central", Gradient::central}});
  keywords.take("volume_smoothing", appearance.smoothing, toVolumeSmoothing);
  keywords.takeWord("table", appearance.table,
                    Words<TableRemoval>{{"auto", TableRemoval::automatic},
                                        {"keep", TableRemoval::keep},
                                        {"remove", TableRemoval::remove}});
  keywords.take("materials", appearance.materials);
  keywords.take("material", appearance.materialChanges);
  keywords.take("lights", appearance.lights, toDocument);
  keywords.take("environment", appearance, [&](const py::object& value) {
    Appearance changed = appearance;
    if (isColor(value))
      changed.environment = toColor(value);
    else
      changed.environmentMap = Convert<std::string>::from(value);
    return changed;
  });
  keywords.take("context_density", appearance.contextDensity);
  keywords.take("context_saturation", appearance.contextSaturation);
}

Background toBackground(const py::object& value) {
  using Kind = Background::Kind;
  if (!py::isinstance<py::str>(value))
    return {Kind::color, toColor(value)};
  const Words<Kind> words = {{"dark", Kind::dark},
                             {"gray", Kind::gray},
                             {"gradient", Kind::gradient},
                             {"transparent", Kind::transparent},
                             {"environment", Kind::environment}};
  return {toMeaning("background", value, words)};
}

} // namespace

SceneOptions readSceneOptions(const py::dict& values) {
  Keywords keywords(values);
  SceneOptions options;
  keywords.take("preset", options.preset);
  keywords.take("focus", options.focus);
  keywords.take("margin", options.margins);
  keywords.take("label_smoothing", options.labelSmoothing);
  readView(keywords, options.view);
  readClip(keywords, options.clip);
  readAppearance(keywords, options.appearance);
  keywords.finish();
  return options;
}

RenderOptions readRenderOptions(const py::dict& values) {
  Keywords keywords(values);
  RenderOptions options;
  std::optional<Quality> quality;
  keywords.takeWord("quality", quality,
                    Words<Quality>{{"draft", Quality::draft},
                                   {"normal", Quality::normal},
                                   {"high", Quality::high},
                                   {"final", Quality::final}});
  keywords.take("samples", options.samples);
  keywords.take("seconds", options.seconds);
  keywords.take("noise", options.noise);
  if (quality && !options.samples && !options.seconds && !options.noise)
    options = makeRenderOptions(*quality);
  keywords.take("size", options, [&](const py::object& value) {
    RenderOptions changed = options;
    try {
      std::tie(changed.width, changed.height) = value.cast<std::pair<int, int>>();
    } catch (const py::cast_error&) {
      throw py::type_error("size: " + quote(value) + " is no pair (width, height) of integers");
    }
    return changed;
  });
  keywords.take("denoise", options.isDenoised);
  keywords.take("bounces", options.bounces);
  keywords.take("seed", options.seed);
  keywords.take("threads", options.threads);
  keywords.takeWord("device", options.device,
                    Words<Device>{{"cpu", Device::cpu}, {"gpu", Device::gpu}});
  keywords.take("background", options.background, toBackground);
  keywords.finish();
  return options;
}

ReadOptions readReadOptions(const py::dict& values) {
  Keywords keywords(values);
  ReadOptions options;
  keywords.take("volume", options.volume);
  keywords.take("frame", options.frame);
  keywords.take("spacing", options.spacing);
  keywords.finish();
  return options;
}

VolumeDescription readDescription(const py::dict& values) {
  Keywords keywords(values);
  VolumeDescription description;
  keywords.take("name", description.name);
  keywords.takeWord("modality", description.modality,
                    Words<Modality>{{"ct", Modality::ct},
                                    {"mr", Modality::mr},
                                    {"ultrasound", Modality::ultrasound},
                                    {"pet", Modality::pet}});
  keywords.take("contrast_agent", description.hasContrastAgent);
  keywords.finish();
  return description;
}

Display readDisplay(const py::dict& values) {
  Keywords keywords(values);
  Display display;
  keywords.takeWord("tone", display.tone,
                    Words<Tone>{{"film", Tone::film}, {"photographic", Tone::photographic}});
  keywords.take("exposure", display.exposure);
  keywords.take("scale", display.hasScale);
  keywords.take("orientation", display.hasOrientation);
  keywords.finish();
  return display;
}

py::dict toKeywords(const Camera& camera) {
  const bool isPerspective = camera.projection == Projection::perspective;
  py::dict keywords;
  keywords["projection"] = isPerspective ? "perspective" : "orthographic";
  keywords["position"] = py::tuple(py::cast(camera.position));
  keywords["target"] = py::tuple(py::cast(camera.target));
  keywords["up"] = py::tuple(py::cast(camera.up));
  keywords[isPerspective ? "angle" : "scale"] = isPerspective ? camera.angle : camera.scale;
  return keywords;
}

} // namespace fenestra::python
