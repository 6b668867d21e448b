#include "identification/report/residual_plots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "sim/io/units.h"

namespace continuum {
namespace {

constexpr std::size_t kLags = 100;
constexpr std::size_t kColours = 6;  // that a page distinguishes
constexpr std::size_t kOpen = 6;     // plots that need no folding
constexpr std::size_t kPoints = 400, kClasses = 20;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using PerLog = std::vector<std::vector<std::vector<double>>>;  // [log][channel][row or lag]

// Over lags of whole rows; rows without a number do not take part.
std::vector<double> Autocorrelation(const std::vector<double>& r) {
  double power = 0, mean = 0, count = 0;
  for (const double v : r) {
    if (!std::isnan(v)) mean += v, ++count;
  }
  mean /= std::max(count, 1.0);
  const auto at = [&](std::size_t k) { return std::isnan(r[k]) ? 0 : r[k] - mean; };
  for (std::size_t k = 0; k < r.size(); ++k) power += at(k) * at(k);
  std::vector<double> rho;
  for (std::size_t lag = 0; lag < std::min(kLags, r.size()); ++lag) {
    double sum = 0;
    for (std::size_t k = lag; k < r.size(); ++k) sum += at(k) * at(k - lag);
    rho.push_back(power > 0 ? sum / power : 0);
  }
  return rho;
}

double Period(const Log& log) {
  return (log.time.back() - log.time.front()) / static_cast<double>(log.rows() - 1);
}

Trend OfLog(const Log& log, const std::vector<double>& rho) {
  Trend trend{log.label, {}, rho};
  for (std::size_t k = 0; k < rho.size(); ++k)
    trend.x.push_back(static_cast<double>(k) * Period(log));
  return trend;
}

// Where logs have different clocks, their curves are compared at the lags of the slowest.
Trend OfAllLogs(const std::vector<const Log*>& logs, const PerLog& rho, std::size_t c) {
  double step = 0, last = std::numeric_limits<double>::infinity();
  for (std::size_t l = 0; l < rho.size(); ++l) {
    const double period = Period(*logs[l]);
    step = std::max(step, period);
    last = std::min(last, period * static_cast<double>(rho[l][c].size() - 1));
  }
  Trend trend{fmt::format("mean of {} logs, lowest to highest", rho.size()), {}, {}};
  for (double lag = 0; lag <= last * (1 + 1e-9); lag += step) {
    double sum = 0, low = 1, high = -1;
    for (std::size_t l = 0; l < rho.size(); ++l) {
      const auto& curve = rho[l][c];
      const auto k = static_cast<std::size_t>(std::lround(lag / Period(*logs[l])));
      const double v = curve[std::min(k, curve.size() - 1)];
      sum += v, low = std::min(low, v), high = std::max(high, v);
    }
    trend.x.push_back(lag), trend.y.push_back(sum / static_cast<double>(rho.size()));
    trend.low.push_back(low), trend.high.push_back(high);
  }
  return trend;
}

// The lag [s] at which a correlation first falls below 1/e.
std::string Lasts(const Log& log, const std::vector<double>& rho) {
  for (std::size_t k = 0; k < rho.size(); ++k) {
    if (rho[k] < std::exp(-1)) return fmt::format("{:.3g}", static_cast<double>(k) * Period(log));
  }
  return fmt::format("> {:.3g}", static_cast<double>(rho.size() - 1) * Period(log));
}

// In a fold where there are more plots than a reader wants at once.
void Fold(Page& page, std::size_t plots, const std::string& summary,
          const std::function<void()>& content) {
  if (plots <= kOpen) return content();
  page.Details(fmt::format("{}: {} plots", summary, plots), content);
}

class ResidualPlots {
 public:
  ResidualPlots(Page& page, const Experiment& e, const std::vector<std::size_t>& channels,
                const std::vector<Replayed>& logs)
      : page_(page), e_(e), channels_(channels) {
    for (std::size_t l = 0; l < logs.size(); ++l) {
      if (logs[l].trace.diverged) continue;  // nothing remains of it
      logs_.push_back(&e_.logs[l]);
      residual_.push_back(Residuals(e_, e_.logs[l], logs[l].trace));
    }
  }

  void AddAutocorrelation() const {
    PerLog rho(residual_.size());
    for (std::size_t l = 0; l < rho.size(); ++l) {
      for (const auto& r : residual_[l]) rho[l].push_back(Autocorrelation(r));
    }
    Fold(page_, channels_.size(), "Autocorrelation of the residuals", [&] {
      for (const std::size_t c : channels_) {
        ScatterSpec spec{Title(c, "autocorrelation"), {"lag", "s"}, {"correlation", ""}, {}};
        spec.small = small();
        if (rho.size() > kColours) spec.trends.push_back(OfAllLogs(logs_, rho, c));
        for (std::size_t l = 0; l < rho.size() && rho.size() <= kColours; ++l)
          spec.trends.push_back(OfLog(*logs_[l], rho[l][c]));
        page_.Scatter(spec);
      }
    });
    AddDurations(rho);
  }

  void AddOverInputs() const {
    for (std::size_t i = 0; i < e_.inputs.size(); ++i) {
      if (e_.inputs[i].column.empty()) continue;
      const std::string over = "over input " + e_.inputs[i].column;
      Fold(page_, channels_.size(), "Residuals " + over, [&] {
        for (const std::size_t c : channels_) page_.Scatter(OverInput(i, c, over));
      });
    }
  }

 private:
  bool small() const { return channels_.size() > 2; }
  std::string Title(std::size_t c, const std::string& what) const {
    return e_.channels[c].name + ": " + what;
  }

  void AddDurations(const PerLog& rho) const {
    std::vector<std::string> header{"log"};
    for (const std::size_t c : channels_) header.push_back(e_.channels[c].name);
    std::vector<std::vector<std::string>> rows;
    for (std::size_t l = 0; l < rho.size(); ++l) {
      rows.push_back({logs_[l]->label});
      for (const std::size_t c : channels_) rows.back().push_back(Lasts(*logs_[l], rho[l][c]));
    }
    page_.Table(header, rows,
                {"How long residuals stay correlated [s]: until the correlation falls below 1/e. "
                 "One row or so: only noise is left."});
  }

  ScatterSpec OverInput(std::size_t i, std::size_t c, const std::string& over) const {
    const Input& input = e_.inputs[i];
    ScatterSpec spec{
        Title(c, over), {input.column, input.unit}, {"residual", e_.channels[c].unit}, {}};
    spec.small = small();
    const double unit = UnitFactor(input.unit, input.where);
    PointGroup all{"rows", {}, {}, Style::kResidual};
    for (std::size_t l = 0; l < residual_.size(); ++l) {
      for (std::size_t k = 0; k < logs_[l]->rows(); ++k) {
        if (std::isnan(residual_[l][c][k])) continue;
        all.x.push_back(logs_[l]->input[i][k] / unit);
        all.y.push_back(residual_[l][c][k] / e_.channels[c].factor);
      }
    }
    spec.trends.push_back(MeanByClass(all));
    spec.groups.push_back(Thinned(all));
    return spec;
  }

  static PointGroup Thinned(const PointGroup& all) {
    PointGroup some{all.name, {}, {}, all.style};
    const std::size_t stride = std::max<std::size_t>(1, all.x.size() / kPoints);
    for (std::size_t k = 0; k < all.x.size(); k += stride)
      some.x.push_back(all.x[k]), some.y.push_back(all.y[k]);
    return some;
  }

  // Of all rows, with a band of one standard deviation to each side; gaps where the input has none.
  static Trend MeanByClass(const PointGroup& all) {
    Trend trend{"mean ± standard deviation", {}, {}, {}, {}, Style::kMeasured};
    if (all.x.empty()) return trend;
    const auto [low, high] = std::minmax_element(all.x.begin(), all.x.end());
    const double width = (*high - *low) / kClasses;
    std::vector<double> count(kClasses, 0), x = count, y = count, square = count;
    for (std::size_t k = 0; k < all.x.size(); ++k) {
      const double share = width > 0 ? (all.x[k] - *low) / width : 0;
      const std::size_t at = std::min(static_cast<std::size_t>(share), kClasses - 1);
      ++count[at], x[at] += all.x[k], y[at] += all.y[k], square[at] += all.y[k] * all.y[k];
    }
    for (std::size_t at = 0; at < kClasses; ++at) {
      const double n = count[at], mean = n > 2 ? y[at] / n : kNaN;
      const double deviation =
          std::sqrt(std::max(0.0, square[at] / std::max(n, 1.0) - mean * mean));
      trend.x.push_back(x[at] / std::max(n, 1.0)), trend.y.push_back(mean);
      trend.low.push_back(mean - deviation), trend.high.push_back(mean + deviation);
    }
    return trend;
  }

  Page& page_;
  const Experiment& e_;
  const std::vector<std::size_t>& channels_;
  std::vector<const Log*> logs_;  // that do not diverge
  PerLog residual_;               // of them
};

}  // namespace

void AddResiduals(Page& page, const Experiment& experiment,
                  const std::vector<std::size_t>& channels, const std::vector<Replayed>& logs) {
  const ResidualPlots plots(page, experiment, channels, logs);
  plots.AddAutocorrelation();
  plots.AddOverInputs();
}

}  // namespace continuum
