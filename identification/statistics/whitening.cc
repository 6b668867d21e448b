#include "identification/statistics/whitening.h"

#include <cmath>

namespace continuum {
namespace {

// Share of its unit that a residual counts for at least, as where a sensor is stuck and shows no
// noise: no sensor and no model is better than that.
constexpr double kFinest = 1e-4;

}  // namespace

Whitening::Whitening(const Problem& problem, const Noise& noise) {
  const Experiment& e = problem.experiment();
  for (std::size_t c = 0; c < problem.channels().size(); ++c) {
    const ChannelNoise& n = noise.channel[problem.channels()[c]];
    const double unit = problem.scale(c);
    filter_.push_back(
        {n.ar, std::max(n.innovation / unit, kFinest), std::max(n.rms / unit, kFinest)});
  }
  for (const Log& log : e.logs) {
    std::vector<Block> blocks;
    for (std::size_t c = 0; c < problem.channels().size(); ++c) {
      const std::size_t channel = problem.channels()[c];
      Block block;
      for (const double y : log.measured[channel]) block.there.push_back(!std::isnan(y));
      const double offset = noise.channel[channel].offset / problem.scale(c);
      if (offset > 0) {
        block.offset = Vector::Constant(static_cast<Eigen::Index>(log.rows()), offset);
        Pass(filter_[c], block.there, block.offset);
      }
      blocks.push_back(std::move(block));
    }
    logs_.push_back(std::move(blocks));
  }
}

void Whitening::Pass(const Filter& filter, const std::vector<bool>& there,
                     Eigen::Ref<Vector> y) const {
  const Vector in = y;
  const auto order = static_cast<Eigen::Index>(filter.ar.size());
  Eigen::Index run = 0;  // measured rows before this one
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    if (!there[k]) {
      y[k] = 0, run = 0;
      continue;
    }
    if (run < order) {
      y[k] = in[k] / filter.rms;
    } else {
      double now = in[k];
      for (Eigen::Index i = 0; i < order; ++i) now -= filter.ar[i] * in[k - 1 - i];
      y[k] = now / filter.innovation;
    }
    ++run;
  }
}

Whitening::Matrix Whitening::Apply(std::size_t log, const Matrix& columns) const {
  if (!active()) return columns;
  Matrix out = columns;
  Eigen::Index begin = 0;
  for (std::size_t c = 0; c < filter_.size(); ++c) {
    const Block& block = logs_[log][c];
    const auto rows = static_cast<Eigen::Index>(block.there.size());
    for (Eigen::Index i = 0; i < out.cols(); ++i) {
      auto y = out.col(i).segment(begin, rows);
      Pass(filter_[c], block.there, y);
      if (!block.offset.size()) continue;  // (I + u uᵀ)^{−1/2}
      const double u2 = block.offset.squaredNorm();
      y -= block.offset * ((1 - 1 / std::sqrt(1 + u2)) / u2 * block.offset.dot(y));
    }
    begin += rows;
  }
  return out;
}

Whitening::Vector Whitening::Stack(const std::vector<Vector>& residuals,
                                   const std::vector<bool>& use) const {
  return Stack(std::vector<Matrix>(residuals.begin(), residuals.end()), use).col(0);
}

Whitening::Matrix Whitening::Stack(const std::vector<Matrix>& columns,
                                   const std::vector<bool>& use) const {
  Eigen::Index rows = 0, cols = 0;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (use[l]) rows += columns[l].rows(), cols = columns[l].cols();
  }
  Matrix all(rows, cols);
  rows = 0;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    all.middleRows(rows, columns[l].rows()) = Apply(l, columns[l]);
    rows += columns[l].rows();
  }
  return all;
}

}  // namespace continuum
