#include "models/statics/panel_drawing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "models/statics/marks.h"
#include "models/statics/palette.h"
#include "sim/numerics/round_number.h"

namespace continuum::statics {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using Stroke = std::vector<PagePoint>;

constexpr Colour kGrid = {0.88, 0.88, 0.88}, kPlate = {0.45, 0.45, 0.45};
constexpr Font kLabel = {8};
constexpr char kAxes[] = "xyz";

std::string Signed(const PageAxis& axis) {
  return std::string(axis.sign < 0 ? "\u2212" : "+") + kAxes[axis.component];
}

Stroke OnPage(const Panel& panel, const Line& line) {
  Stroke stroke;
  for (const Vector3d& p : line) stroke.push_back(panel.At(p));
  return stroke;
}

// The outline of a disc: the hull of the circles of its two faces.
Stroke Outline(const Panel& panel, const Disc& disc) {
  constexpr int kCorners = 24;
  const Vector3d a = disc.normal.unitOrthogonal(), b = disc.normal.cross(a);
  Stroke corners;
  for (const double face : {-0.5, 0.5}) {
    if (disc.thickness == 0 && face > 0) break;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCorners;
      corners.push_back(panel.At(disc.centre + face * disc.thickness * disc.normal +
                                 disc.radius * (std::cos(angle) * a + std::sin(angle) * b)));
    }
  }
  return Hull(std::move(corners));
}

class PanelDrawing {
 public:
  PanelDrawing(const Figure& figure, const Layout& layout, const Panel& panel, Canvas& canvas)
      : figure_(figure), layout_(layout), panel_(panel), canvas_(canvas) {}

  void Draw(const std::string& letter) {
    Grid();
    canvas_.Clipped(panel_.corner, panel_.size, [&] {
      Plate();
      for (const std::size_t i : panel_.shapes) Many(figure_) ? Thread(i) : Robot(i);
      for (const std::size_t i : panel_.shapes) Force(i);
      Gravity();
    });
    Frame(letter);
  }

 private:
  static constexpr double kClosestTicks = 18;  // [pt]

  double StepOfTicks() const {
    double shortest = layout_.panels[0].range.sizes().x();
    for (const Panel& panel : layout_.panels)
      shortest = std::min(shortest, panel.range.sizes().minCoeff());
    return RoundUp(std::max(shortest / 5, kClosestTicks / panel_.scale));
  }

  // Values on the page's axis a (0 right, 1 up) that have a tick.
  std::vector<double> Ticks(int a) const {
    const double step = StepOfTicks();
    std::vector<double> ticks;
    const double last = panel_.range.max()[a] + 1e-9 * step;
    for (double n = std::ceil(panel_.range.min()[a] / step); n * step <= last; ++n)
      ticks.push_back(n * step);
    return ticks;
  }

  void Grid() {
    const PagePoint end = panel_.corner + panel_.size;
    const Pen pen{kGrid, 0.5};
    for (const double x : Ticks(0)) {
      const double at = panel_.Place({x, 0}).x();
      canvas_.Stroke({{at, panel_.corner.y()}, {at, end.y()}}, pen);
    }
    for (const double y : Ticks(1)) {
      const double at = panel_.Place({0, y}).y();
      canvas_.Stroke({{panel_.corner.x(), at}, {end.x(), at}}, pen);
    }
  }

  Stroke PlateOutline() const {
    const Vector3d normal = Vector3d::Unit(figure_.axis);
    const double thickness = 0.15 * figure_.base_radius;
    return Outline(panel_, {-0.5 * thickness * normal, normal, figure_.base_radius, thickness});
  }

  // What the robot stands on, behind its base.
  void Plate() { canvas_.Fill(PlateOutline(), kPlate); }

  // One of many: a line and its tip.
  void Thread(std::size_t i) {
    const Shape& shape = figure_.shapes[i];
    const Colour colour = Viridis(LoadsOf(figure_).Share(shape.load));
    canvas_.Stroke(OnPage(panel_, shape.backbone), {colour.Faded(0.35), 0.5});
    canvas_.Dot(panel_.At(shape.backbone.back()), 1.4, colour);
    Crosses(shape, 1, colour);
  }

  void Robot(std::size_t i) {
    const Shape& shape = figure_.shapes[i];
    const Pen pen = CasePen(i);
    Body(shape, pen.colour);
    for (const Drive& drive : shape.drives) {
      canvas_.Stroke(OnPage(panel_, drive.line),
                     {pen.colour.Faded(drive.active ? 0.75 : 0.25), drive.active ? 0.5 : 0.4});
    }
    for (const Disc& disc : shape.discs) {
      Stroke outline = Outline(panel_, disc);
      canvas_.Fill(outline, pen.colour.Faded(0.16));
      outline.push_back(outline.front());
      canvas_.Stroke(outline, {pen.colour.Faded(0.7), 0.4});
    }
    canvas_.Stroke(OnPage(panel_, shape.backbone), pen);
    if (!shape.mount.empty())
      canvas_.Stroke(OnPage(panel_, shape.mount), {pen.colour.Faded(0.6), 0.7});
    canvas_.Dot(panel_.At(shape.backbone.back()), 1.5, pen.colour);
    Crosses(shape, 2.2, pen.colour);
  }

  // A soft body or a thick rod at its true width.
  void Body(const Shape& shape, const Colour& colour) {
    const double width = shape.diameter * panel_.scale;
    if (width < 2) return;
    canvas_.Stroke(OnPage(panel_, shape.backbone), {colour.Faded(0.1), width, {}, false});
  }

  void Crosses(const Shape& shape, double half, const Colour& colour) {
    for (const Vector3d& p : shape.measured) DrawCross(panel_.At(p), half, colour, canvas_);
  }

  void Force(std::size_t i) {
    const Shape& shape = figure_.shapes[i];
    if (Many(figure_) || shape.force.isZero(0)) return;
    const Vector3d arrow = layout_.metres_per_newton * shape.force;
    const Pen pen{CasePen(i).colour, 1.1, {}, false};
    const Vector2d shown = panel_.At(shape.End() + arrow) - panel_.At(shape.End());
    if (shown.norm() < 0.05 * panel_.scale * arrow.norm()) {
      const bool away = panel_.view.Viewer().Of(shape.force) < 0;
      DrawAcross(panel_.At(shape.End()), away, {pen.colour, 0.8}, canvas_);
    } else {
      DrawArrow(panel_.At(shape.End()), panel_.At(shape.End() + arrow), pen, canvas_);
    }
  }

  // Points of the robots and of their plate within a square at a corner of the panel.
  int Crowd(const PagePoint& middle, double half) const {
    int crowd = 0;
    for (const PagePoint& p : PlateOutline()) crowd += (p - middle).cwiseAbs().maxCoeff() < half;
    for (const std::size_t i : panel_.shapes) {
      const Shape& shape = figure_.shapes[i];
      for (const Line* line : {&shape.backbone, &shape.measured}) {
        for (const Vector3d& p : *line)
          crowd += (panel_.At(p) - middle).cwiseAbs().maxCoeff() < half;
      }
      for (const Disc& disc : shape.discs) {
        const Vector2d away = (panel_.At(disc.centre) - middle).cwiseAbs();
        crowd += away.maxCoeff() < half + disc.radius * panel_.scale;
      }
      for (const double share : {0.0, 0.5, 1.0}) {
        const Vector3d force = shape.End() + share * layout_.metres_per_newton * shape.force;
        crowd += 3 * ((panel_.At(force) - middle).cwiseAbs().maxCoeff() < half);
      }
    }
    return crowd;
  }

  // The emptiest corner.
  PagePoint FreeCorner() const {
    constexpr double kInset = 22;
    PagePoint best = panel_.corner;
    int least = -1;
    for (const bool below : {false, true}) {
      for (const bool right : {true, false}) {
        const PagePoint at = panel_.corner + Vector2d(right ? panel_.size.x() - kInset : kInset,
                                                      below ? panel_.size.y() - kInset : kInset);
        const int crowd = Crowd(at, kInset);
        if (least < 0 || crowd < least) least = crowd, best = at;
      }
    }
    return best;
  }

  std::vector<Vector3d> GravityDirections() const {
    std::vector<Vector3d> directions;
    for (const std::size_t i : panel_.shapes) {
      const Vector3d& g = figure_.shapes[i].gravity;
      if (g.isZero(0)) continue;
      const auto same = [&](const Vector3d& d) { return d.isApprox(g.normalized(), 1e-6); };
      if (std::none_of(directions.begin(), directions.end(), same))
        directions.push_back(g.normalized());
    }
    return directions;
  }

  void Gravity() {
    constexpr double kLength = 22;
    const std::vector<Vector3d> directions = GravityDirections();
    if (directions.empty()) return;
    const PagePoint middle = FreeCorner();
    const Pen pen{kInk, 0.9, {}, false};
    for (const Vector3d& direction : directions) {
      Vector2d shown = panel_.view.Of(direction);
      shown.y() = -shown.y();
      if (shown.norm() < 0.05) {
        DrawAcross(middle, panel_.view.Viewer().Of(direction) < 0, pen, canvas_);
      } else {
        DrawArrow(middle - 0.5 * kLength * shown, middle + 0.5 * kLength * shown, pen, canvas_);
      }
    }
    canvas_.Text(middle + Vector2d(7, 0), "g", {0, 0.4}, {8, false, true});
  }

  void Frame(const std::string& letter) {
    const PagePoint a = panel_.corner, b = a + panel_.size;
    canvas_.Stroke({a, {b.x(), a.y()}, b, {a.x(), b.y()}, a, {b.x(), a.y()}}, {kInk, 0.6});
    const PageAxis right = panel_.view.right, up = panel_.view.up;
    for (const double x : Ticks(0)) {
      const double at = panel_.Place({x, 0}).x();
      canvas_.Stroke({{at, b.y()}, {at, b.y() + 2.5}}, {kInk, 0.6});
      canvas_.Text({at, b.y() + 4.5}, ScaleNumber(1e3 * right.sign * x), {0.5, 1}, kSmall);
    }
    for (const double y : Ticks(1)) {
      const double at = panel_.Place({0, y}).y();
      canvas_.Stroke({{a.x(), at}, {a.x() - 2.5, at}}, {kInk, 0.6});
      canvas_.Text({a.x() - 4.5, at}, ScaleNumber(1e3 * up.sign * y), {1, 0.5}, kSmall);
    }
    canvas_.Text({0.5 * (a.x() + b.x()), b.y() + 15}, Title(right), {0.5, 1}, kLabel);
    canvas_.Text({a.x() - 26, 0.5 * (a.y() + b.y())}, Title(up), {0.5, 0}, kLabel, true);
    canvas_.Text({a.x(), a.y() - 4}, letter + "  " + From(), {}, kSmall);
  }

  static std::string Title(const PageAxis& axis) {
    return std::string(1, kAxes[axis.component]) + " [mm]";
  }

  std::string From() const {
    const PageAxis viewer = panel_.view.Viewer();
    for (const Vector3d& g : GravityDirections()) {
      if (viewer.Of(g) < -0.7) return "seen from above";
    }
    return "seen from " + Signed(viewer);
  }

  const Figure& figure_;
  const Layout& layout_;
  const Panel& panel_;
  Canvas& canvas_;
};

}  // namespace

void DrawPanel(const Figure& figure, const Layout& layout, const Panel& panel,
               const std::string& letter, Canvas& canvas) {
  PanelDrawing(figure, layout, panel, canvas).Draw(letter);
}

}  // namespace continuum::statics
