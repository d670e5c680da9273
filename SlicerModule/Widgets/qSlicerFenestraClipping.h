#ifndef __qSlicerFenestraClipping_h
#define __qSlicerFenestraClipping_h

#include <qMRMLWidget.h>

#include <QList>

#include <map>
#include <string>

class qSlicerFenestraClippingPrivate;
class vtkMRMLNode;
struct qSlicerFenestraSegment;

/// \brief Widgets for the clipping flags; shows those of the chosen clip mode.
///
/// A widget keeps its value while its flag has no effect and is not passed to the renderer.
class qSlicerFenestraClipping : public qMRMLWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;
  /// Where the clip plane comes from: the renderer, a plane node, or a stored flag.
  enum class Plane { automatic, node, fixed };

  explicit qSlicerFenestraClipping(QWidget* parent = nullptr);
  ~qSlicerFenestraClipping() override;

  /// Shows the flags. `byPreset`: an anatomy preset is chosen; it sets clip mode and focus unless
  /// flags set them.
  void show(const Flags& flags, Plane plane, const QList<qSlicerFenestraSegment>& focus,
            bool byPreset);
  /// Sets all widgets to their defaults, including hidden ones.
  void reset();
  /// Writes all clipping flags; empty: not passed. `plane`: flag value of the chosen plane node.
  void take(Flags& flags, const std::string& plane, bool hasFocus, bool byPreset) const;
  /// The chosen plane node; null: none, or the plane comes from elsewhere.
  vtkMRMLNode* planeNode() const;

signals:
  void changed();

protected:
  QScopedPointer<qSlicerFenestraClippingPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraClipping)
  Q_DISABLE_COPY(qSlicerFenestraClipping)
};

#endif
