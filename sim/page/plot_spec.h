#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace continuum {

/// A quantity on an axis. An empty unit means a pure number and is printed as [-].
struct Axis {
  std::string label;
  std::string unit;
};

/// What a curve or a group of points stands for; decides its colour everywhere in the page. `kAuto`
/// takes the next colour of the palette.
enum class Style { kAuto, kMeasured, kSimulated, kBefore, kAfter, kResidual };

enum class Tone { kInfo, kGood, kWarn, kBad };

struct Series {
  std::string name;
  std::vector<double> values;  ///< one per time; NaN or infinite = gap
  Style style = Style::kAuto;
};

/// One panel over time. Panels with the same non-empty `group` zoom and point together.
struct TimeSeriesSpec {
  std::string title;
  Axis y;
  std::vector<double> time;  ///< [s], finite, not decreasing
  std::vector<Series> series;
  std::string group = {};
  int height = 200;  ///< [px]
};

struct PointGroup {
  std::string name;
  std::vector<double> x, y;  ///< points with a non-finite coordinate are left out and counted
  Style style = Style::kAuto;
};

/// A line, such as a binned mean, with an optional band from `low` to `high` (both empty: none).
struct Trend {
  std::string name;
  std::vector<double> x, y, low = {}, high = {};
  Style style = Style::kAuto;
};

struct ScatterSpec {
  std::string title;
  Axis x, y;
  std::vector<PointGroup> groups;
  std::vector<Trend> trends = {};
  bool half_width = true;  ///< two such plots share a row
  bool small = false;      ///< three do
};

struct Bar {
  std::string label;
  double value = 0;
  double error = 0;  ///< half width of the error bar; 0 = none
  bool highlighted = false;
};

struct Mark {
  std::string label;
  double value = 0;
};

/// A ranking: one horizontal bar per row, in the given order, and vertical marks across all rows.
struct BarsSpec {
  std::string title;
  Axis value;
  std::vector<Bar> bars;
  std::vector<Mark> marks = {};
};

/// A value with its interval, not needed to contain it.
struct IntervalRow {
  std::string label;
  double value = 0, low = 0, high = 0;  ///< low or high not finite: no interval
  bool highlighted = false;
};

/// Values with intervals, one below the other, and a band across all rows. Above 60 rows only the
/// highlighted ones have labels.
struct IntervalsSpec {
  std::string title;
  Axis value;
  std::vector<IntervalRow> rows;
  double low = 0, high = 0;  ///< of the band; not finite: none
  std::vector<Mark> marks = {};
};

/// A matrix with its values printed in the cells. The colour scale is [-1, 1] when any value is
/// negative, otherwise [0, largest value].
struct HeatMapSpec {
  std::string title;
  std::vector<std::string> rows;
  std::vector<std::string> columns = {};    ///< empty: the same as `rows`
  std::vector<std::vector<double>> values;  ///< values[row][column]; non-finite = empty cell
};

struct TableOptions {
  std::string caption;
  std::vector<std::size_t> highlighted_rows = {};
  /// Column to one share in [0, 1] per row, drawn as a bar behind the text.
  std::map<std::size_t, std::vector<double>> bars = {};
  /// Column to one value in [-1, 1] per row, drawn as the cell's colour (orange above 0, blue
  /// below).
  std::map<std::size_t, std::vector<double>> heat = {};
  /// Column to one address per row, relative to the page; empty: no link.
  std::map<std::size_t, std::vector<std::string>> links = {};
  bool sortable = false;  ///< a click on a column's head sorts; a line above filters the rows
};

}  // namespace continuum
