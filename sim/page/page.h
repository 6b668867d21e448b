#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/page/plot_spec.h"

namespace continuum {

/// One self-contained HTML page: no request leaves it, and the same calls give the same bytes.
///
/// All text is escaped. Paragraphs, list items, badges, captions and table cells understand
/// **bold** and `code`. Time series are interactive (dygraphs), tables where asked for; all other
/// plots are inline SVG that needs no script. Sizes that do not fit together throw Error (kInput)
/// with the plot's title.
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
  void Intervals(const IntervalsSpec& spec);
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
  bool has_series_ = false, has_sortable_ = false;
};

}  // namespace continuum
