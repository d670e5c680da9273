#ifndef __qSlicerFenestraClipping_h
#define __qSlicerFenestraClipping_h

#include <QList>
#include <QStringList>
#include <QWidget>

#include <map>
#include <string>

class qMRMLNodeComboBox;
class qSlicerFenestraMargins;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
struct qSlicerFenestraSegment;

/// \brief Widgets for the clipping flags; shows those of the chosen clip mode.
///
/// A widget keeps its value while its flag has no effect and is not passed to the renderer.
class qSlicerFenestraClipping : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;
  /// Where the clip plane comes from: the renderer, a plane node, or a stored flag.
  enum class Plane { automatic, node, fixed };

  /// `planeNode` lists the scene's planes; this widget becomes its parent.
  explicit qSlicerFenestraClipping(qMRMLNodeComboBox* planeNode, QWidget* parent = nullptr);

  /// Shows the flags. `byPreset`: an anatomy preset is chosen; it sets clip mode and focus unless
  /// flags set them.
  void show(const Flags& flags, Plane plane, const QList<qSlicerFenestraSegment>& focus,
            bool byPreset);
  /// Sets all widgets to their defaults, including hidden ones.
  void reset();
  /// Writes all clipping flags; empty: not passed. `plane`: flag value of the chosen plane node.
  void take(Flags& flags, const std::string& plane, bool hasFocus, bool byPreset) const;
  Plane plane() const;
  const qMRMLNodeComboBox* planeNode() const { return m_planeNode; }

signals:
  void changed();

private:
  /// Widget of a numeric flag.
  struct Number {
    const char* flag;
    QDoubleSpinBox* box;
    double unit;         ///< flag value per unit of the box
    double defaultValue; ///< default, in the box's units; below 0: "auto"
    QStringList modes;   ///< clip modes that use the flag; empty: all
    QString shown;       ///< flag value last shown; may have more digits than the box
    double shownValue;
  };

  void buildMode(QFormLayout* form);
  void buildDetails(QFormLayout* form);
  void addNumber(QFormLayout* form, const char* flag, const QString& label, double unit,
                 double defaultValue, const QStringList& modes, const QString& help);
  QString mode(bool byPreset) const;
  void showMode();

  QComboBox* m_clip;
  QComboBox* m_boundary;
  QComboBox* m_holeShape;
  QComboBox* m_plane;
  qMRMLNodeComboBox* m_planeNode;
  qSlicerFenestraMargins* m_margins;
  QList<Number> m_numbers;
  QFormLayout* m_form;
  QWidget* m_details;      ///< enabled only with a focus
  bool m_hasFocus = false; ///< of the flags last shown
  bool m_byPreset = false; ///< of the flags last shown
};

#endif
