#include "Report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace fenestra::benchmarks {
namespace {

constexpr int panelsPerRow = 3;
constexpr double panelWidth = 360.0, panelHeight = 310.0, legendHeight = 34.0;
constexpr double left = 52.0, right = 14.0, top = 28.0, bottom = 44.0; ///< margins of a panel

/// Colors of Okabe and Ito, which color-blind readers can distinguish.
constexpr std::array<const char*, 7> colors = {"#d55e00", "#0072b2", "#009e73", "#e69f00",
                                               "#cc79a7", "#56b4e9", "#000000"};

const char* modeColor(const std::string& mode) {
  std::size_t i = 0;
  while (i < modes().size() && mode != modes()[i].name)
    ++i;
  return colors[i % colors.size()];
}

/// Logarithmic axis over complete decades.
struct Axis {
  int first = 1000, last = -1000; ///< powers of ten
  double from = 0.0, to = 1.0;    ///< positions of `first` and `last`, pixels

  void include(double value) {
    first = std::min(first, static_cast<int>(std::floor(std::log10(value))));
    last = std::max(last, static_cast<int>(std::ceil(std::log10(value))));
  }
  double at(double value) const {
    return from + (to - from) * (std::log10(value) - first) / std::max(last - first, 1);
  }
};

struct Panel {
  std::string scene;
  std::vector<const CurveRecord*> curves;
  Axis x{.from = left, .to = panelWidth - right};
  Axis y{.from = panelHeight - bottom, .to = top};
};

std::vector<Panel> makePanels(const std::vector<CurveRecord>& curves) {
  std::vector<Panel> panels;
  for (const CurveRecord& curve : curves) {
    if (panels.empty() || panels.back().scene != curve.scene)
      panels.push_back({.scene = curve.scene, .curves = {}});
    Panel& panel = panels.back();
    panel.curves.push_back(&curve);
    panel.y.include(quotedRelMse);
    for (const Point& point : curve.points)
      if (point.relMse > 0.0) {
        panel.x.include(point.cpuSeconds);
        panel.y.include(point.relMse);
      }
  }
  return panels;
}

void drawText(std::ostream& svg, double x, double y, const char* anchor,
              const std::string& content) {
  svg << "<text x='" << x << "' y='" << y << "' text-anchor='" << anchor << "'>" << content
      << "</text>\n";
}

void drawLine(std::ostream& svg, double x1, double y1, double x2, double y2, const char* style) {
  svg << "<line x1='" << x1 << "' y1='" << y1 << "' x2='" << x2 << "' y2='" << y2 << "' " << style
      << "/>\n";
}

std::string powerOfTen(int exponent) {
  return "10<tspan dy='-5' font-size='9'>" + std::to_string(exponent) + "</tspan>";
}

void drawGrid(std::ostream& svg, const Panel& panel) {
  const char* const faint = "stroke='#dddddd'";
  for (int i = panel.x.first; i <= panel.x.last; ++i) {
    const double x = panel.x.at(std::pow(10.0, i));
    drawLine(svg, x, panel.y.from, x, panel.y.to, faint);
    drawText(svg, x, panel.y.from + 17.0, "middle", powerOfTen(i));
  }
  for (int i = panel.y.first; i <= panel.y.last; ++i) {
    const double y = panel.y.at(std::pow(10.0, i));
    drawLine(svg, panel.x.from, y, panel.x.to, y, faint);
    drawText(svg, panel.x.from - 6.0, y + 4.0, "end", powerOfTen(i));
  }
  const double quoted = panel.y.at(quotedRelMse);
  drawLine(svg, panel.x.from, quoted, panel.x.to, quoted,
           "stroke='#777777' stroke-dasharray='4 3'");
}

void drawCurve(std::ostream& svg, const Panel& panel, const CurveRecord& curve) {
  const char* const color = modeColor(curve.mode);
  std::ostringstream path, dots;
  for (const Point& point : curve.points) {
    if (!(point.relMse > 0.0))
      continue;
    const double x = panel.x.at(point.cpuSeconds), y = panel.y.at(point.relMse);
    path << x << ',' << y << ' ';
    dots << "<circle cx='" << x << "' cy='" << y << "' r='2.5' fill='" << color << "'/>";
  }
  svg << "<polyline points='" << path.str() << "' fill='none' stroke='" << color
      << "' stroke-width='1.8'/>" << dots.str() << '\n';
}

void drawPanel(std::ostream& svg, const Panel& panel) {
  const double middle = (panel.x.from + panel.x.to) / 2.0;
  drawText(svg, middle, top - 10.0, "middle",
           "<tspan font-weight='bold'>" + panel.scene + "</tspan>");
  if (panel.x.first > panel.x.last)
    return drawText(svg, middle, panelHeight / 2.0, "middle", "not present");
  drawGrid(svg, panel);
  for (const CurveRecord* curve : panel.curves)
    drawCurve(svg, panel, *curve);
  drawText(svg, middle, panelHeight - 8.0, "middle", "CPU seconds");
  svg << "<g transform='translate(14," << panelHeight / 2.0 << ") rotate(-90)'>";
  drawText(svg, 0.0, 0.0, "middle", "relMSE");
  svg << "</g>\n";
}

void drawLegend(std::ostream& svg) {
  double x = left;
  for (const Mode& mode : modes()) {
    svg << "<line x1='" << x << "' y1='18' x2='" << x + 26.0 << "' y2='18' stroke='"
        << modeColor(mode.name) << "' stroke-width='3'/>\n";
    drawText(svg, x + 32.0, 22.0, "start", mode.name);
    x += 60.0 + 7.5 * static_cast<double>(std::string(mode.name).size());
  }
}

} // namespace

std::string drawCurves(const std::vector<CurveRecord>& curves) {
  const std::vector<Panel> panels = makePanels(curves);
  const int count = static_cast<int>(panels.size());
  const int columns = std::clamp(count, 2, panelsPerRow); // at least two, to fit the legend
  const int rows = (count + columns - 1) / columns;
  const double width = columns * panelWidth, height = legendHeight + rows * panelHeight;
  std::ostringstream svg;
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
      << "' font-family='sans-serif' font-size='12'>\n<rect width='" << width << "' height='"
      << height << "' fill='white'/>\n";
  drawLegend(svg);
  for (int i = 0; i < count; ++i) {
    svg << "<g transform='translate(" << i % columns * panelWidth << ','
        << legendHeight + i / columns * panelHeight << ")'>\n";
    drawPanel(svg, panels[static_cast<std::size_t>(i)]);
    svg << "</g>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

} // namespace fenestra::benchmarks
