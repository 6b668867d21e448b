#include "hidden_effects/pictures.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "sim/io/file.h"
#include "sim/page/chart.h"
#include "sim/page/text.h"

namespace continuum::hidden {
namespace {

constexpr std::array kColours{"#1f5fa8", "#c8553d", "#3a7d44", "#8a5fa8",
                              "#b8860b", "#2a9d9d", "#666666"};
constexpr double kLabels = 190, kCell = 64, kRow = 26, kHead = 132;

std::string Text(const char* anchor, double x, double y, const std::string& text,
                 const char* more = "") {
  return fmt::format(
      "<text text-anchor=\"{}\" transform=\"translate({:.1f} {:.1f})\"{}>{}</text>\n", anchor, x, y,
      more, page::Escape(text));
}

std::string CellSvg(double x, double y, int count, int of) {
  if (count == 0) return "";
  const double share = static_cast<double>(count) / of;
  return fmt::format(
             "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" fill=\"#1f5fa8\" "
             "fill-opacity=\"{:.2f}\"/>\n",
             x + 1, y + 1, kCell - 2, kRow - 2, 0.12 + 0.88 * share) +
         Text("middle", x + kCell / 2, y + 18, std::to_string(count),
              share > 0.5 ? " fill=\"#fff\"" : "");
}

int Sum(const std::vector<int>& row) {
  int sum = 0;
  for (const int n : row) sum += n;
  return sum;
}

std::string MatrixSvg(const Matrix& m, double top) {
  std::string out = Text("start", 12, top + 22, m.title, " font-weight=\"bold\"");
  for (std::size_t j = 0; j < m.columns.size(); ++j) {
    const double x = kLabels + kCell * (static_cast<double>(j) + 0.5);
    out += fmt::format("<text transform=\"translate({:.1f} {:.1f}) rotate(-40)\">{}</text>\n", x,
                       top + kHead - 8, page::Escape(m.columns[j]));
  }
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    const double y = top + kHead + kRow * static_cast<double>(i);
    out += Text("end", kLabels - 10, y + 18, m.rows[i]);
    for (std::size_t j = 0; j < m.columns.size(); ++j)
      out += CellSvg(kLabels + kCell * static_cast<double>(j), y, m.count[i][j], Sum(m.count[i]));
  }
  return out;
}

ChartLine Diagonal() { return {"as stated", "#888888", {0, 1}, {0, 1}, ChartLine::Kind::kDashed}; }

// A line with its points.
void AddLine(Chart& chart, const std::string& name, const char* colour,
             const std::vector<double>& x, const std::vector<double>& y) {
  if (x.empty()) return;
  chart.lines.push_back({name, colour, x, y});
  chart.lines.push_back({"", colour, x, y, ChartLine::Kind::kDots});
}

std::string PowerSvg(const std::vector<Power>& curves) {
  const Axis size{"log2 of size over moderate size", ""};
  Chart set{"truth in the set", size, {"share", ""}, {}};
  Chart alone{"one right name", size, {"share", ""}, {}};
  for (Chart* const chart : {&set, &alone})  // unseen, so that both axes go from 0 to 1
    chart->lines.push_back({"", "none", {0, 0}, {0, 1}});
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<double> x, in_set, named;
    for (const Power::Point& p : curves[i].points) {
      x.push_back(std::log2(p.factor));
      in_set.push_back(static_cast<double>(p.in_set) / p.n);
      named.push_back(static_cast<double>(p.alone) / p.n);
    }
    AddLine(set, curves[i].group, kColours[i % kColours.size()], x, in_set);
    AddLine(alone, curves[i].group, kColours[i % kColours.size()], x, named);
  }
  return ChartsSvg({set, alone});
}

std::string CalibrationSvg(const std::vector<Stated>& bins, const std::vector<Coverage>& levels) {
  Chart reliability{"reliability of probabilities", {"stated", ""}, {"true", ""}, {Diagonal()}};
  Chart coverage{"coverage of intervals", {"nominal", ""}, {"true sizes within", ""}, {Diagonal()}};
  std::vector<double> x, y;
  int stated = 0;
  for (const Stated& s : bins) {
    if (s.n == 0) continue;
    x.push_back(s.sum / s.n), y.push_back(static_cast<double>(s.true_ones) / s.n);
    stated += s.n;
  }
  AddLine(reliability, fmt::format("{} probabilities", stated), kColours[0], x, y);
  x.clear(), y.clear();
  int sizes = 0;
  for (const Coverage& c : levels) {
    if (c.n == 0) continue;
    x.push_back(c.nominal), y.push_back(static_cast<double>(c.covered) / c.n);
    sizes = c.n;
  }
  AddLine(coverage, fmt::format("{} sizes", sizes), kColours[1], x, y);
  return ChartsSvg({reliability, coverage});
}

}  // namespace

std::string MatricesSvg(const std::vector<Matrix>& matrices) {
  std::string content;
  double width = 0, top = 0;
  for (const Matrix& m : matrices) {
    content += MatrixSvg(m, top);
    width = std::max(width, kLabels + kCell * static_cast<double>(m.columns.size()) + 80);
    top += kHead + kRow * static_cast<double>(m.rows.size()) + 16;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n<rect width=\"{0}\" "
      "height=\"{1}\" fill=\"#fff\"/>\n{2}</svg>\n",
      width, top, content);
}

void WritePictures(const std::vector<Outcome>& outcomes, const std::filesystem::path& folder) {
  MakeFolder(folder);
  WriteFile(folder / "confusion.svg", MatricesSvg({Worth(outcomes), Confusion(outcomes)}));
  WriteFile(folder / "power.svg", PowerSvg(PowerOf(outcomes)));
  WriteFile(folder / "calibration.svg",
            CalibrationSvg(ReliabilityOf(outcomes), CoverageOf(outcomes)));
}

}  // namespace continuum::hidden
