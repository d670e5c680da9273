#pragma once
// When the image of a 3D view is rendered and shown: once the camera rests. Decides only; its owner
// has the clock, the renderer and the view. Needs only standard C++.

#include <limits>

namespace SlicerExport {

/// Times are seconds since any moment, and never decrease.
class LiveState {
public:
  enum class Phase {
    off,
    turning,  ///< the camera moves: nothing is requested or shown
    waiting,  ///< for the first image of the camera or of other changes
    refining, ///< images are shown, and further ones follow
    done      ///< the last image is shown: nothing runs
  };

  static constexpr double restSeconds = 0.15;   ///< without a move, after which the camera rests
  static constexpr double refreshSeconds = 0.2; ///< at least, between two images of one camera
  static constexpr double never = std::numeric_limits<double>::infinity();

  Phase phase() const { return m_phase; }
  bool isOn() const { return m_phase != Phase::off; }

  void turnOn(double now);
  void turnOff();
  /// The camera or the size of the view has changed. True if it rested before: the renderer works
  /// for a former camera, and is to pause.
  bool moveCamera(double now);
  /// Anything else that the image shows has changed. While the camera moves, nothing more is to do.
  void change(double now);
  /// An image of the camera has arrived, that shows all changes.
  void receive(bool isLast);

  /// True once per rest of the camera or change: request an image now.
  bool takeRequest(double now);
  /// True if the image that arrived last is to be shown now.
  bool takeImage(double now);
  /// When to call both next, unless something happens before.
  double nextTime() const;

private:
  Phase m_phase = Phase::off;
  double m_requestTime = never; ///< of the next request
  double m_shownTime = -never;  ///< of the last image of this camera
  bool m_hasImage = false;      ///< one has arrived and is not shown yet
  bool m_isLast = false;        ///< that one is the last of its request
};

} // namespace SlicerExport
