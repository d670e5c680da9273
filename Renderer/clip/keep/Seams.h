#pragma once
// Where the exact surface meets the focus, between the samples.
//
// A buffer's samples are too far apart to say where a focus ends, and how deep it is between them.
// In the cells where it may be seen, the seams, the surface is asked of the focus itself, whenever
// a point is looked up: where the eye ray through the point meets the focus, the surface is there.
// Where it just misses it, the surface goes on at the ray's summit, where it comes nearest to the
// focus (FocusCells): on the outline that is where the focus ends, so that the two meet without a
// step; and as the summit falls from 1/2 to the foothill, about half a voxel on, the surface goes
// over into the buffer's samples, linearly. Those samples that still see a summit, the rim, have
// its depth: it is the rim that the surface is filled from, so that it leaves the focus where the
// focus ends and not where its last sample was.
//
// A seam's reach bounds what its rays can see; a point in front of or behind it is not asked for.
// In an inner seam, where all samples are focus, it is what the samples around see, and as much
// again behind it: the surface follows the focus onto no spike and into no pit that is narrower
// than samples are apart and sticks out of that.

#include "clip/focus/FocusDepth.h"

namespace fenestra {

struct CellRange;

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
  /// Of each seam: nothing that its rays see takes the surface out of it.
  const std::vector<Reach>& reaches() const { return m_reaches; }

  /// All samples around it are focus.
  bool isInner(std::int32_t seam) const { return m_isInner[static_cast<std::size_t>(seam)]; }

  /// Depths are less that of the camera's target, mm.
  struct Question {
    std::int32_t seam;
    Vec2 position;  ///< in the seam, mm
    double surface; ///< between the buffer's samples there
    double from;    ///< a surface that is nearer to the eye may be told as any nearer depth
  };
  /// Makes `surface` what it is, for up to mostQuestions.
  void answer(std::span<Question> questions) const;
  static constexpr std::size_t mostQuestions = 16;

private:
  Interval reachAround(const DepthBuffer& buffer, std::int64_t column, std::int64_t row) const;
  void findRim(const FocusDepth& focus, const CellRange& range);

  std::shared_ptr<const FocusTracer> m_tracer;
  double m_reference; ///< the depth of the camera's target
  double m_offset = 0.0;
  std::vector<std::int32_t> m_numbers;
  std::vector<Reach> m_reaches;
  std::vector<bool> m_isInner; ///< of each seam
  std::vector<Rim> m_rim;
};

} // namespace fenestra
