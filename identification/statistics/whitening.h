#pragma once

#include <vector>

#include <Eigen/Core>

#include "identification/problem/problem.h"
#include "identification/statistics/noise_model.h"

namespace continuum {

/// Makes the noise of residuals white and of size 1:   W with W Σ Wᵀ = I,   Σ the covariance of
/// one channel of one log under ChannelNoise. Rows that were not measured stay zero, and the
/// filter starts anew after them.
class Whitening {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// Nothing is changed.
  Whitening() = default;
  Whitening(const Problem& problem, const Noise& noise);

  bool active() const { return !logs_.empty(); }
  /// Of residuals of one log as Problem gives them, or of the columns of their Jacobian.
  Matrix Apply(std::size_t log, const Matrix& columns) const;
  /// The logs in use below each other.
  Vector Stack(const std::vector<Vector>& residuals, const std::vector<bool>& use) const;
  Matrix Stack(const std::vector<Matrix>& columns, const std::vector<bool>& use) const;

 private:
  struct Filter {
    std::vector<double> ar;
    double innovation, rms;
  };
  struct Block {              // one channel of one log
    std::vector<bool> there;  // [row] measured
    Vector offset;            // filtered offset of one standard deviation, or empty
  };
  void Pass(const Filter& filter, const std::vector<bool>& there, Eigen::Ref<Vector> y) const;

  std::vector<Filter> filter_;            // [counted channel], residual units
  std::vector<std::vector<Block>> logs_;  // [log][counted channel]
};

}  // namespace continuum
