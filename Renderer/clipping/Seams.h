#pragma once
// Where the exact surface meets the focus, between the samples.
//
// A buffer's samples are too far apart to say where a focus ends, and how deep it is where it falls
// away steeply or hides a part of itself. In the cells where it does, the seams, the surface is
// asked of the focus itself, whenever a point is looked up: where the eye ray through the point
// meets the focus, the surface is there. Where it just misses it, the surface goes on at the ray's
// summit, where it comes nearest to the focus (FocusCells): on the outline that is where the focus
// ends, so that the two meet without a step; and as the summit falls from 1/2 to the foothill,
// about half a voxel on, the surface goes over into the buffer's samples, linearly. Those samples
// that still see a summit, the rim, have its depth: it is the rim that the surface is filled from,
// so that it leaves the focus where the focus ends and not where its last sample was.
//
// A seam's reach bounds what its rays can see; a point in front of or behind it is not asked for.
// In an inner seam, where all samples are focus, the surface is no nearer and no farther than the
// samples around see it: it follows the focus onto no spike and into no pit that is narrower than
// they are apart.

#include "clipping/FocusDepth.h"

namespace fenestra {

/// Depth per distance between focus samples, both in mm on the plane through the target, from which
/// on what lies between them is asked for.
constexpr double steepestCell = 2.0;

class Seams {
public:
  Seams(std::shared_ptr<const FocusTracer> tracer, const FocusDepth& focus);

  /// A sample beside the focus.
  struct Rim {
    std::int64_t sample;
    double depth; ///< mm
  };
  const std::vector<Rim>& rim() const { return m_rim; }

  /// Moves the surface away from the eye, mm.
  void move(double offset);

  /// Of each sample the number of the seam between it and the next column and row; none is -1.
  const std::vector<std::int32_t>& numbers() const { return m_numbers; }

  /// Less the depth of the camera's target, mm.
  struct Reach {
    float least, greatest;
  };
  /// Of each seam, of what its rays see the surface goes to.
  const std::vector<Reach>& reaches() const { return m_reaches; }

  /// All samples around it are focus.
  bool isInner(std::int32_t seam) const { return m_isInner[static_cast<std::size_t>(seam)]; }

  /// Depths are less that of the camera's target, mm.
  struct Question {
    std::int32_t seam;
    Vec2 position;    ///< in the seam, mm
    double surface;   ///< between the buffer's samples there
    Interval between; ///< where it matters how deep the surface is: else any depth on its side does
  };
  /// Makes `surface` what it is, for up to mostQuestions.
  void answer(std::span<Question> questions) const;
  static constexpr std::size_t mostQuestions = 16;

private:
  void findRim(const FocusDepth& focus);
  void limitReaches(const FocusDepth& focus);

  std::shared_ptr<const FocusTracer> m_tracer;
  double m_reference; ///< the depth of the camera's target
  double m_offset = 0.0;
  std::vector<std::int32_t> m_numbers;
  std::vector<Reach> m_reaches;
  std::vector<double> m_ends;  ///< of each seam, how far the focus reaches in it, mm
  std::vector<bool> m_isInner; ///< of each seam
  std::vector<Rim> m_rim;
};

} // namespace fenestra
