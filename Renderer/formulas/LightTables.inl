// Placed lights: the members of LightTables (model/lights/LightTables.h). Lengths in mm.

struct PlacedArea {
  bool isDisk;
  Point center, normal;
  Point right, up;      ///< half edges (disk: radii) as vectors, mm
  Real perRight, perUp; ///< 1 / squared length of right, up
  Real area;            ///< mm^2
  Color radiance;
  Real pmf; ///< probability that this light is sampled
};
/// Sampled uniformly over the cone of directions that it subtends; from inside, over all.
struct PlacedSphere {
  Point center;
  Real radius2; ///< mm^2
  Color radiance;
  Real pmf; ///< as above
};
struct PlacedDirectional {
  Point toward; ///< unit, from the scene to the light
  Color irradiance;
  Real pmf; ///< as above
};
struct PlacedSky {
  Point up;
  Color middle;
  Color toTop, toBottom; ///< radiance there minus `middle`
};
