#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
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
};

/// One self-contained HTML page: no request leaves it, and the same calls give the same bytes.
///
/// All text is escaped. Paragraphs, list items, badges, captions and table cells understand
/// **bold** and `code`. Time series are interactive (dygraphs); all other plots are inline SVG that
/// needs no script. Sizes that do not fit together throw Error (kInput) with the plot's title.
class Page {
 public:
  explicit Page(std::string title, std::string subtitle = "");

  /// level 2 or 3; both enter the table of contents.
  void Heading(const std::string& text, int level = 2);
  void Paragraph(const std::string& text);
  void List(const std::vector<std::string>& items);
  /// The verdict box; `detail` is a second, smaller line.
  void Badge(Tone tone, const std::string& text, const std::string& detail = "");
  /// Columns in which every filled cell starts like a number are aligned right.
  void Table(const std::vector<std::string>& header,
             const std::vector<std::vector<std::string>>& rows, const TableOptions& options = {});
  /// Above 20 000 rows, the extremes of every series in equal stretches of rows are kept.
  void TimeSeries(const TimeSeriesSpec& spec);
  void Scatter(const ScatterSpec& spec);
  void Bars(const BarsSpec& spec);
  void HeatMap(const HeatMapSpec& spec);
  /// Preformatted text. In language "diff", added and removed lines are coloured.
  void Code(const std::string& text, const std::string& language = "");
  /// What `content` adds to this page is folded away under `summary`.
  void Details(const std::string& summary, const std::function<void()>& content);

  std::string Html() const;
  /// The whole file or nothing. Throws Error when it cannot be written.
  void Write(const std::filesystem::path& path) const;

 private:
  struct Entry {
    int level;
    std::string text;
  };

  std::string Contents() const;

  std::string title_, subtitle_, body_;
  std::vector<Entry> headings_;
  std::map<std::string, int> groups_;
  bool has_series_ = false;
};

}  // namespace continuum
