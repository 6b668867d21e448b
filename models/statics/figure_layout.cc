#include "models/statics/figure_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace continuum::statics {
namespace {

using Eigen::AlignedBox2d, Eigen::Vector2d, Eigen::Vector3d;

// Measures of the page [pt]. The width is that of a paper's two columns.
constexpr double kPageWidth = 510, kLegendWidth = 130, kLeft = 40, kGap = 46, kTop = 34;
constexpr double kBelow = 44;     // ticks, axis title and space between rows
constexpr double kBottom = 28;    // ticks and axis title under the last row
constexpr double kTallest = 250;  // height of a panel
// Shares of the reach.
constexpr double kLongestForce = 0.25, kMargin = 0.08, kNarrowest = 0.4;

// The base axis nearest to a direction.
PageAxis Nearest(const Vector3d& direction) {
  Eigen::Index component = 0;
  direction.cwiseAbs().maxCoeff(&component);
  return {static_cast<int>(component), direction[component] < 0 ? -1 : 1};
}

PageAxis UpFor(int axis, const Vector3d& gravity) {
  return gravity.isZero(0) ? PageAxis{axis, 1} : Nearest(-gravity);
}

// Neither of two others.
int Third(int a, int b) { return 3 - a - b; }

void AddLine(const View& view, const Line& line, AlignedBox2d& box) {
  for (const Vector3d& p : line) box.extend(view.Of(p));
}

AlignedBox2d Extent(const View& view, const Figure& figure, const std::vector<std::size_t>& shapes,
                    double metres_per_newton) {
  AlignedBox2d box(Vector2d::Zero().eval());
  const Vector3d axis = Vector3d::Unit(figure.axis);
  for (int i = 0; i < 3; ++i) {
    const Vector3d rim = i == figure.axis ? Vector3d::Zero() : Vector3d(Vector3d::Unit(i));
    box.extend(view.Of(figure.base_radius * (rim - 0.3 * axis)));
    box.extend(view.Of(figure.base_radius * (-rim)));
  }
  for (const std::size_t i : shapes) {
    const Shape& shape = figure.shapes[i];
    for (const Line* line : {&shape.backbone, &shape.mount, &shape.measured})
      AddLine(view, *line, box);
    for (const Drive& drive : shape.drives) AddLine(view, drive.line, box);
    box.extend(view.Of(shape.End() + metres_per_newton * shape.force));
  }
  return box;
}

double Reach(const Figure& figure) {
  double reach = 0;
  for (const Shape& shape : figure.shapes) {
    for (const Vector3d& p : shape.backbone) reach = std::max(reach, p.norm());
  }
  return reach > 0 ? reach : 1;
}

// Panels without their places, two for each direction of gravity, in the order of the cases.
std::vector<Panel> PanelsOf(const Figure& figure) {
  std::vector<Panel> panels;
  std::map<std::pair<int, int>, std::size_t> row;
  for (std::size_t i = 0; i < figure.shapes.size(); ++i) {
    const PageAxis up = UpFor(figure.axis, figure.shapes[i].gravity);
    const auto [found, added] = row.try_emplace({up.component, up.sign}, panels.size());
    if (added) {
      for (const View& view : ViewsFor(figure.axis, figure.shapes[i].gravity))
        panels.push_back({view});
    }
    for (std::size_t k = 0; k < 2; ++k) panels[found->second + k].shapes.push_back(i);
  }
  if (panels.empty()) {
    for (const View& view : ViewsFor(figure.axis, Vector3d::Zero())) panels.push_back({view});
  }
  return panels;
}

// Widened about its middle to at least this size.
AlignedBox2d Widened(const AlignedBox2d& box, const Vector2d& size) {
  const Vector2d half = 0.5 * box.sizes().cwiseMax(size);
  return {box.center() - half, box.center() + half};
}

// Lower end of the longest legend [pt]: a line for each case, two kinds of drives, mount, measured
// places and the scale of the forces; or the colour bar.
double LegendEnd(const Figure& figure) {
  if (Many(figure)) return kTop + 170;
  return kTop + kLegendLine * static_cast<double>(figure.shapes.size() + 6);
}

void SetRange(const Figure& figure, const Layout& layout, Panel& panel) {
  panel.range = Extent(panel.view, figure, panel.shapes, layout.metres_per_newton);
  const Vector2d margin = Vector2d::Constant(2 * kMargin * layout.reach);
  panel.range = Widened(panel.range, panel.range.sizes() + margin);
  panel.range = Widened(panel.range, Vector2d::Constant(kNarrowest * layout.reach));
}

// Rows of two panels under each other, at the largest scale that fits. @returns the page's end.
double Place(std::vector<Panel>& panels) {
  std::array<double, 2> width = {0, 0};  // of the two columns [m]
  double tallest = 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    width[i % 2] = std::max(width[i % 2], panels[i].range.sizes().x());
    tallest = std::max(tallest, panels[i].range.sizes().y());
  }
  const double room = kPageWidth - kLeft - kGap - kLegendWidth;
  const double scale = std::min(room / (width[0] + width[1]), kTallest / tallest);
  const double spare = 0.5 * (room / scale - width[0] - width[1]);
  double top = kTop;
  for (std::size_t row = 0; row < panels.size(); row += 2) {
    const double height =
        std::max(panels[row].range.sizes().y(), panels[row + 1].range.sizes().y());
    double left = kLeft;
    for (std::size_t k = 0; k < 2; ++k) {
      Panel& panel = panels[row + k];
      panel.range = Widened(panel.range, {width[k] + spare, height});
      panel.scale = scale;
      panel.corner = {left, top};
      panel.size = scale * panel.range.sizes();
      left += panel.size.x() + kGap;
    }
    top += scale * height + kBelow;
  }
  return top - kBelow + kBottom;
}

}  // namespace

PageAxis View::Viewer() const {
  const Vector3d viewer =
      (right.sign * Vector3d::Unit(right.component)).cross(up.sign * Vector3d::Unit(up.component));
  return Nearest(viewer);
}

std::array<View, 2> ViewsFor(int axis, const Vector3d& gravity) {
  const PageAxis up = UpFor(axis, gravity);
  if (up.component == axis) {
    const int first = axis == 0 ? 1 : 0;
    return {{{{first, 1}, up}, {{Third(axis, first), 1}, up}}};
  }
  const PageAxis right{axis, 1};
  const Vector3d vertical = up.sign * Vector3d::Unit(up.component);
  return {{{right, up}, {right, Nearest(vertical.cross(Vector3d(Vector3d::Unit(axis))))}}};
}

double LargestForce(const Figure& figure) {
  double largest = 0;
  for (const Shape& shape : figure.shapes) largest = std::max(largest, shape.force.norm());
  return largest;
}

LoadRange LoadsOf(const Figure& figure) {
  if (figure.shapes.empty()) return {};
  LoadRange range{figure.shapes[0].load, figure.shapes[0].load};
  for (const Shape& shape : figure.shapes) {
    range.low = std::min(range.low, shape.load);
    range.high = std::max(range.high, shape.load);
  }
  return range;
}

Figure ColouredByOrderWhereLoadsAreAlike(Figure figure) {
  constexpr double kAlike = 1e-3;
  const LoadRange range = LoadsOf(figure);
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  if (range.high - range.low > kAlike * largest) return figure;
  figure.load_name = "number of the case";
  for (std::size_t i = 0; i < figure.shapes.size(); ++i)
    figure.shapes[i].load = static_cast<double>(i + 1);
  return figure;
}

Layout LayoutOf(const Figure& figure) {
  Layout layout;
  layout.panels = PanelsOf(figure);
  layout.reach = Reach(figure);
  const double largest = LargestForce(figure);
  layout.metres_per_newton = largest > 0 ? kLongestForce * layout.reach / largest : 0;
  for (Panel& panel : layout.panels) SetRange(figure, layout, panel);
  const double bottom = Place(layout.panels);
  layout.legend = {kPageWidth - kLegendWidth + 14, kTop};
  layout.size = {kPageWidth, std::max(bottom, LegendEnd(figure))};
  return layout;
}

}  // namespace continuum::statics
