#include "sim/page/page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "error.h"
#include "sim/io/file.h"
#include "sim/page/plots.h"
#include "sim/page/table.h"
#include "sim/page/text.h"
#include "sim/page/time_series.h"

namespace continuum {

namespace page_assets {
extern const std::string_view kCss, kScript, kTableScript, kDygraphCss, kDygraphScript,
    kDygraphLicense;
}

namespace {

using page::Escape, page::Inline;

constexpr std::size_t kMostRows = 20000;

// Nothing may leave the page; the browser enforces it.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

// The library as it is, without its pointer to a file that is not there.
std::string_view WithoutSourceMap(std::string_view text) {
  const auto map = text.rfind("# sourceMappingURL=");
  return map == text.npos || map < 2 ? text : text.substr(0, map - 2);
}

std::string_view ToneName(Tone tone) {
  switch (tone) {
    case Tone::kGood:
      return "good";
    case Tone::kWarn:
      return "warn";
    case Tone::kBad:
      return "bad";
    case Tone::kInfo:
      break;
  }
  return "info";
}

std::string_view ToneSign(Tone tone) {
  switch (tone) {
    case Tone::kGood:
      return "✓";
    case Tone::kWarn:
      return "!";
    case Tone::kBad:
      return "✕";
    case Tone::kInfo:
      break;
  }
  return "i";
}

void CheckSeries(const TimeSeriesSpec& spec) {
  const std::string where = fmt::format("plot '{}'", spec.title);
  for (std::size_t i = 0; i < spec.time.size(); ++i) {
    if (std::isfinite(spec.time[i]) && (i == 0 || spec.time[i] >= spec.time[i - 1])) continue;
    throw Error::Input(where, "finite, ascending times",
                       fmt::format("{} s at row {}", spec.time[i], i));
  }
  for (const Series& one : spec.series) {
    if (one.values.size() == spec.time.size()) continue;
    throw Error::Input(fmt::format("{}, {}", where, one.name),
                       fmt::format("{} values", spec.time.size()),
                       std::to_string(one.values.size()));
  }
}

bool HasValue(const Series& series) {
  return std::any_of(series.values.begin(), series.values.end(),
                     [](double value) { return std::isfinite(value); });
}

std::string SeriesLegend(const TimeSeriesSpec& spec) {
  std::string out;
  for (std::size_t i = 0; i < spec.series.size(); ++i) {
    const Series& one = spec.series[i];
    out += page::LegendKey(HasValue(one) ? one.name : one.name + " (no value)",
                           page::StyleName(one.style, i), "line", true);
  }
  return out;
}

std::string DiffClass(std::string_view line) {
  if (line.starts_with("+++") || line.starts_with("---") || line.starts_with("@@")) return "place";
  return line.starts_with('+') ? "added" : line.starts_with('-') ? "removed" : "";
}

std::string DiffHtml(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::string kind = DiffClass(line);
    out += kind.empty() ? Escape(line) : fmt::format("<b class=\"{}\">{}</b>", kind, Escape(line));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    out += '\n';
  }
  return out;
}

std::string Script(std::string_view code) { return fmt::format("<script>\n{}\n</script>\n", code); }

}  // namespace

Page::Page(std::string title, std::string subtitle)
    : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

void Page::Heading(const std::string& text, int level) {
  headings_.push_back({std::clamp(level, 2, 3), text});
  body_ += fmt::format("<h{0} id=\"s{1}\">{2}</h{0}>\n", headings_.back().level, headings_.size(),
                       Escape(text));
}

void Page::Paragraph(const std::string& text) { body_ += "<p>" + Inline(text) + "</p>\n"; }

void Page::List(const std::vector<std::string>& items) {
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += "<li>" + Inline(item) + "</li>\n";
  body_ += "</ul>\n";
}

void Page::Badge(Tone tone, const std::string& text, const std::string& detail) {
  body_ += fmt::format("<div class=\"badge {}\"><i>{}</i><div><strong>{}</strong>{}</div></div>\n",
                       ToneName(tone), ToneSign(tone), Inline(text),
                       detail.empty() ? "" : "<p>" + Inline(detail) + "</p>");
}

void Page::Table(const std::vector<std::string>& header,
                 const std::vector<std::vector<std::string>>& rows, const TableOptions& options) {
  has_sortable_ = has_sortable_ || options.sortable;
  body_ += page::TableHtml(header, rows, options);
}

void Page::TimeSeries(const TimeSeriesSpec& spec) {
  CheckSeries(spec);
  const std::string y_title = page::AxisTitle(spec.y);
  if (std::none_of(spec.series.begin(), spec.series.end(), HasValue)) {
    body_ += page::Figure("plot", spec.title, SeriesLegend(spec), y_title, page::NothingToPlot(),
                          "time [s]");
    return;
  }
  has_series_ = true;
  const int next = static_cast<int>(groups_.size()) + 1;
  const int group = spec.group.empty() ? 0 : groups_.try_emplace(spec.group, next).first->second;
  const auto rows = page::Decimate(spec.series, spec.time.size(), kMostRows);
  const std::string note =
      rows.size() < spec.time.size()
          ? fmt::format("drawn: {} of {} rows (all extremes kept)", rows.size(), spec.time.size())
          : "";
  const std::string plot = fmt::format(
      "<div class=\"chart\" style=\"height:{}px\"></div>\n"
      "<noscript><div class=\"nothing\">this plot needs JavaScript</div></noscript>\n"
      "<script type=\"application/json\">{}</script>",
      spec.height, page::SeriesJson(spec, rows, group));
  body_ +=
      page::Figure("plot series", spec.title, SeriesLegend(spec), y_title, plot, "time [s]", note);
}

void Page::Scatter(const ScatterSpec& spec) { body_ += page::ScatterHtml(spec); }

void Page::Bars(const BarsSpec& spec) { body_ += page::BarsHtml(spec); }

void Page::Intervals(const IntervalsSpec& spec) { body_ += page::IntervalsHtml(spec); }

void Page::HeatMap(const HeatMapSpec& spec) { body_ += page::HeatMapHtml(spec); }

void Page::Code(const std::string& text, const std::string& language) {
  const std::string content = language == "diff" ? DiffHtml(text) : Escape(text);
  body_ += fmt::format("<pre class=\"{}\"><code>{}</code></pre>\n", Escape(language), content);
}

void Page::Details(const std::string& summary, const std::function<void()>& content) {
  body_ += "<details>\n<summary>" + Inline(summary) + "</summary>\n";
  content();
  body_ += "</details>\n";
}

std::string Page::Contents() const {
  if (headings_.size() < 2) return "";
  std::string out = "<nav aria-label=\"Contents\">\n<ul>\n";
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    out += fmt::format("<li class=\"level{}\"><a href=\"#s{}\">{}</a></li>\n", headings_[i].level,
                       i + 1, Escape(headings_[i].text));
  }
  return out + "</ul>\n</nav>\n";
}

std::string Page::Html() const {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<style>\n{}{}"
      "</style>\n</head>\n<body>\n<main>\n<header>\n<h1>{}</h1>\n",
      kPolicy, Escape(title_),
      has_series_ ? WithoutSourceMap(page_assets::kDygraphCss) : std::string_view(),
      page_assets::kCss, Escape(title_));
  if (!subtitle_.empty()) out += "<p class=\"subtitle\">" + Inline(subtitle_) + "</p>\n";
  out += "</header>\n" + Contents() + body_ + "</main>\n";
  if (has_series_) {
    out += Script(fmt::format("/*\n{}*/", page_assets::kDygraphLicense));
    out += Script(WithoutSourceMap(page_assets::kDygraphScript));
    out += Script(page_assets::kScript);
  }
  if (has_sortable_) out += Script(page_assets::kTableScript);
  return out + "</body>\n</html>\n";
}

void Page::Write(const std::filesystem::path& path) const { WriteFile(path, Html()); }

}  // namespace continuum
