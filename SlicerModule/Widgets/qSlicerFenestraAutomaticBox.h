#ifndef __qSlicerFenestraAutomaticBox_h
#define __qSlicerFenestraAutomaticBox_h

#include <QDoubleSpinBox>

/// Numbers from 0; one step below 0 is "auto", set by Arrow Down or Page Down without a second
/// control. Negative numbers cannot be typed.
class qSlicerFenestraAutomaticBox : public QDoubleSpinBox {
public:
  static constexpr double automatic = -1.0; ///< value for "auto"

  using QDoubleSpinBox::QDoubleSpinBox;

  void stepBy(int steps) override {
    const double from = value() < 0.0 ? -singleStep() : value();
    const double to = from + steps * singleStep();
    // A single step down stops at 0 before it reaches "auto".
    setValue(to >= 0.0 ? to : from > 0.0 && steps == -1 ? 0.0 : automatic);
  }

protected:
  QValidator::State validate(QString& text, int& at) const override {
    const bool isNegative = text.contains('-') || text.contains(locale().negativeSign());
    return isNegative ? QValidator::Invalid : QDoubleSpinBox::validate(text, at);
  }
};

#endif
