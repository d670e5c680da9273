#pragma once

#include "fenestra/ClipSurface.h"
#include "fenestra/Segmentation.h"

namespace fenestra {
inline namespace v1 {

// Members without a value are chosen by Fenestra, as the comment says. Lengths are millimeters.

enum class Projection { orthographic, perspective };

struct View {
  /// anterior, posterior, left, right, superior, inferior, or auto: the direction that shows most
  /// of the focus. By default the camera of a Slicer scene, else anterior.
  std::optional<std::string> name = {};
  std::optional<Vector3> position = {}; ///< instead of a name
  std::optional<Vector3> target = {};   ///< center of the focus, else of the volume
  std::optional<Vector3> up = {};
  std::optional<Projection> projection = {}; ///< orthographic
  std::optional<double> scale = {}; ///< orthographic: half the height of the image; fits the focus
  std::optional<double> angle = {}; ///< perspective: vertical angle, degrees; 30, or fits the focus
};

enum class ClipMode {
  automatic, ///< surface with a focus, else none
  none,
  plane,
  cutaway, ///< removes what hides the focus
  surface, ///< removes all in front of a smooth surface through the focus
  hole,    ///< removes a box, cylinder or sphere in front of the focus
  ghost    ///< as surface, but what is removed remains faintly
};
enum class ClipBoundary { exact, spline };
enum class HoleShape { box, cylinder, sphere };

struct Plane {
  Vector3 origin, normal; ///< the side to which the normal points is removed
};

struct Clip {
  ClipMode mode = ClipMode::automatic;
  ClipBoundary boundary = ClipBoundary::exact; ///< how the surface meets the outline of the focus
  int controlPoints = 50;                      ///< of the spline, 3 to 1000
  double splineSmoothing = 0.5;                ///< of the spline: 0 (a plane) to 1 (exact)
  std::optional<Plane> plane = {};             ///< fitted to the focus
  HoleShape hole = HoleShape::cylinder;
  double holeMargin = 5.0;             ///< from the focus to the wall of the hole
  double ghost = 0.1;                  ///< remaining fraction of the opacity, 0 to 1
  double offset = 0.0;                 ///< moves the cut away from the camera
  std::optional<double> softness = {}; ///< depth over which the volume fades in; 0.6 or 0
};

enum class Gradient { sobel, central };
enum class TableRemoval { automatic, keep, remove };

/// Smoothing of the volume by non-local means.
struct VolumeSmoothing {
  enum class Kind { automatic, off, given };
  Kind kind = Kind::automatic;
  double noise = 0.0; ///< of `given`: standard deviation of the noise, in units of the samples
};

struct Appearance {
  /// Transfer function: a preset such as "ct-anatomy", a volume property of the scene or of Slicer
  /// by name, a file, or JSON. By default the scene's, else by the kind of scan.
  std::optional<std::string> transfer = {};
  double transferShift = 0.0; ///< to higher samples
  double density = 1.0;       ///< factor of the opacity, 0 to 1000
  Gradient gradient = Gradient::sobel;
  VolumeSmoothing smoothing = {};
  TableRemoval table = TableRemoval::automatic; ///< of the scanner, in CT
  /// Colors of segments: none, library, contrast, or a file. By default library in CT if the focus
  /// has a known material, else none.
  std::optional<std::string> materials = {};
  std::vector<std::string> materialChanges = {};  ///< like "Liver: color=#963e2e"
  std::optional<std::string> lights = {};         ///< a preset, a file, or JSON; theatre-wet
  std::optional<Color> environment = {};          ///< radiance; replaces that of the lights
  std::optional<std::string> environmentMap = {}; ///< file of a latitude-longitude .exr image
  double contextDensity = 1.0;                    ///< factor of the opacity of all but the focus
  std::optional<double> contextSaturation = {};   ///< of all but the focus, 0 (gray) to 1
};

struct SceneOptions {
  /// Preset of an organ, such as "liver", the file of one, or "auto": the built-in one that suits
  /// the names of the segments. It supplies the focus and other members that have no value here.
  std::optional<std::string> preset = {};
  /// Segments to show unobstructed: ids, names or label values.
  std::vector<std::string> focus = {};
  /// Grows the focus, or shrinks it: one value, or one per segment of the focus. Empty: in CT, what
  /// is another tissue is removed.
  std::vector<double> margins = {};
  std::optional<double> labelSmoothing = {}; ///< standard deviation; 1.25 voxels of the labels
  View view = {};
  Clip clip = {};
  Appearance appearance = {};
};

/// Camera of a rendered scene.
struct Camera {
  Projection projection;
  Vector3 position, target, up;
  double scale; ///< as in View
  double angle;
};

/// What is rendered. Immutable; copies and changed scenes share all that does not differ. Different
/// threads may use scenes at the same time, also the same one.
class FENESTRA_EXPORT Scene {
public:
  /// Throws Error (request, input) for options out of range, for segments that do not exist, and if
  /// no segment suits the preset.
  /// What takes long (smoothing, the clipping surface) is computed on first use.
  explicit Scene(const Volume& volume, const SceneOptions& options = {});
  Scene(const Volume& volume, const Segmentation& segmentation, const SceneOptions& options = {});

  /// The scene with other options.
  Scene withOptions(const SceneOptions& options) const;
  const SceneOptions& options() const;
  /// Segments among which a focus can be chosen; empty without a segmentation. Throws Error.
  std::vector<Segment> segments() const;

  // The following prepare the scene for an image of a size, in pixels, unless it was prepared for
  // it last. All throw Error.

  std::vector<Warning> warnings(int width = 512, int height = 512) const;
  /// What was chosen, one line each, like "transfer function: ct-anatomy (by modality)".
  std::vector<std::string> choices(int width = 512, int height = 512) const;
  Camera camera(int width = 512, int height = 512) const;
  /// Throws Error (request) if the clip is not a surface.
  ClipSurface clipSurface(int width = 512, int height = 512) const;

  struct Data;
  explicit Scene(std::shared_ptr<Data> data);
  const std::shared_ptr<Data>& data() const { return m_data; }

private:
  std::shared_ptr<Data> m_data;
};

/// Scene of files, of which the names of the segments are read now, the rest on first use: a
/// volume, a DICOM folder or a Slicer scene (.mrml, .mrb). `segmentation`: a file, or a
/// segmentation of the scene by name or id, by default the scene's; `labels` as in
/// readSegmentation(). Throws Error.
FENESTRA_EXPORT Scene readScene(const std::string& path,
                                const std::optional<std::string>& segmentation = {},
                                const std::optional<std::string>& labels = {},
                                const SceneOptions& scene = {}, const ReadOptions& options = {});

} // namespace v1
} // namespace fenestra
