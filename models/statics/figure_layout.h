#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "models/statics/canvas.h"
#include "models/statics/figure.h"

namespace continuum::statics {

/// A base axis as it lies on the page: `sign` -1 where its values fall to the right or upwards.
struct PageAxis {
  int component;
  int sign;

  double Of(const Eigen::Vector3d& p) const { return sign * p[component]; }
};

/// An orthographic view: which base axes point to the right and up.
struct View {
  PageAxis right, up;

  Eigen::Vector2d Of(const Eigen::Vector3d& p) const { return {right.Of(p), up.Of(p)}; }
  /// The base axis that points at the viewer.
  PageAxis Viewer() const;
};

/// Two views of a robot that is straight along base axis `axis`. Gravity points down in the first
/// (its nearest base axis does); the second is a quarter turn about the vertical, or from above for
/// a robot that lies level. Without gravity the robot stands upright.
std::array<View, 2> ViewsFor(int axis, const Eigen::Vector3d& gravity);

/// One view of the cases whose gravity points along the same base axis.
struct Panel {
  View view;
  std::vector<std::size_t> shapes = {};
  Eigen::AlignedBox2d range = {};        ///< what it shows [m], right and up
  PagePoint corner = PagePoint::Zero();  ///< upper left, on the page [pt]
  PagePoint size = PagePoint::Zero();    ///< [pt]
  double scale = 1;                      ///< [pt/m]

  PagePoint At(const Eigen::Vector3d& p) const { return Place(view.Of(p)); }
  PagePoint Place(const Eigen::Vector2d& p) const {
    return {corner.x() + (p.x() - range.min().x()) * scale,
            corner.y() + size.y() - (p.y() - range.min().y()) * scale};
  }
};

/// Whether the cases share a colour bar instead of having a line of the legend each.
inline bool Many(const Figure& figure) { return figure.shapes.size() > kMostNamed; }

/// The largest force at a tip [N]; 0 without any.
double LargestForce(const Figure& figure);

/// The loads of the cases, from the least to the largest.
struct LoadRange {
  double low = 0, high = 0;

  /// 0 at the least, 1 at the largest.
  double Share(double load) const { return high > low ? (load - low) / (high - low) : 0.5; }
};
LoadRange LoadsOf(const Figure& figure);

/// The figure with the number of each case for its load, where all loads are alike to a thousandth:
/// colours would spread what is rounding.
Figure ColouredByOrderWhereLoadsAreAlike(Figure figure);

/// Distance between the lines of the legend [pt].
inline constexpr double kLegendLine = 12;

/// The page of a figure: panels in rows of two at one scale, a legend at the right.
struct Layout {
  PagePoint size;
  std::vector<Panel> panels;
  PagePoint legend;          ///< upper left [pt]
  double reach;              ///< the longest distance from base to tip [m]
  double metres_per_newton;  ///< of the arrows of forces
};
Layout LayoutOf(const Figure& figure);

}  // namespace continuum::statics
