#include "models/spa/links_chart.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "sim/page/chart.h"

namespace continuum {
namespace {

constexpr std::array kColours{"#1f5fa8", "#c8553d", "#3a7d44"};

// N⁻⁴ through the first point.
ChartLine Slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double end = std::log10(16.0);
  return {"N⁻⁴", "#888888", {x[0], end}, {y[0], y[0] - 4 * (end - x[0])}, ChartLine::Kind::kDashed};
}

}  // namespace

void LinksChart::Add(int links, double timestep, const SpaGap& gap) {
  if (curves_.empty() || curves_.back().timestep != timestep)
    curves_.push_back({timestep, {}, {}, {}});
  curves_.back().links.push_back(std::log10(double(links)));
  curves_.back().delta.push_back(std::log10(100 * gap.delta));
  curves_.back().torque.push_back(std::log10(100 * gap.torque));
}

std::string LinksChart::Svg() const {
  Chart delta{"δ", {"lg N", ""}, {"lg (error in % of range)", ""}, {}};
  Chart torque{"torque at the base", {"lg N", ""}, {"lg (error in % of range)", ""}, {}};
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const Curve& c = curves_[i];
    const std::string name = fmt::format("{:g} ms", 1e3 * c.timestep);
    const char* const colour = kColours[i % kColours.size()];
    for (const auto& [chart, y] : {std::pair{&delta, &c.delta}, {&torque, &c.torque}}) {
      chart->lines.push_back({name, colour, c.links, *y});
      chart->lines.push_back({"", colour, c.links, *y, ChartLine::Kind::kDots});
      if (i == 0) chart->lines.push_back(Slope(c.links, *y));
    }
  }
  return ChartsSvg({delta, torque});
}

}  // namespace continuum
