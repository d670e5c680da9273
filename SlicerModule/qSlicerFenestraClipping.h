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

/// \brief How the focus is uncovered: the flags of clipping as widgets, of which those are shown
/// that the chosen way has.
///
/// A value that does not matter now is not among the flags, but stays in its widget.
class qSlicerFenestraClipping : public QWidget {
  Q_OBJECT

public:
  using Flags = std::map<std::string, std::string>;
  /// Where a plane comes from.
  enum class Plane { automatic, node, fixed };

  /// `planeNode` chooses among the scene's planes; it becomes this widget's.
  explicit qSlicerFenestraClipping(qMRMLNodeComboBox* planeNode, QWidget* parent = nullptr);

  /// `byPreset`: there is an organ preset, which clips and has a focus where nothing else says so.
  void show(const Flags& flags, Plane plane, const QList<qSlicerFenestraSegment>& focus,
            bool byPreset);
  /// Standard values, in what does not matter now, too.
  void reset();
  /// With the first focus: what takes the stairs of voxels off it, whose shortest edge is `voxel`
  /// mm. Nothing where the user, or the shown flags, have chosen.
  void begin(double voxel);
  /// Puts all flags of clipping, empty where they are not to be given. `plane`: what a plane of the
  /// scene is as a flag.
  void take(Flags& flags, const std::string& plane, bool hasFocus, bool byPreset) const;
  Plane plane() const;
  const qMRMLNodeComboBox* planeNode() const { return m_planeNode; }

signals:
  void changed();

private:
  /// A flag that is a number of widgets' units.
  struct Number {
    const char* flag;
    QDoubleSpinBox* box;
    double unit;       ///< of the flag, in a unit of the box
    double standard;   ///< of the box
    QStringList modes; ///< that use it
    QString shown;     ///< the flag as it is shown, which may have more digits than the box
    double shownValue;
  };

  void buildMode(QFormLayout* form);
  void buildDetails(QFormLayout* form);
  void addNumber(QFormLayout* form, const char* flag, const QString& label, double unit,
                 double standard, const QStringList& modes, const QString& help);
  QString mode(bool byPreset) const;
  void showMode();

  QComboBox* m_clip;
  QComboBox* m_boundary;
  QComboBox* m_hole;
  QComboBox* m_plane;
  qMRMLNodeComboBox* m_planeNode;
  qSlicerFenestraMargins* m_margins;
  QList<Number> m_numbers;
  QFormLayout* m_form;
  QWidget* m_details;      ///< needs a focus
  bool m_hasFocus = false; ///< as shown
  bool m_isFresh = true;   ///< nothing was chosen
  bool m_byPreset = false; ///< as shown
};

#endif
