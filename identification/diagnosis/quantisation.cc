#include "identification/diagnosis/quantisation.h"

#include <algorithm>
#include <cmath>

namespace continuum {

Quantisation::Quantisation(const Problem& problem, const Noise& noise, const Problem::Vector& x)
    : problem_(&problem), noise_(&noise) {
  for (const std::size_t c : problem.channels()) any_ |= Rounded(noise.channel[c]);
  if (!any_) return;
  for (std::size_t l = 0; l < problem.experiment().logs.size(); ++l)
    traces_.push_back(problem.Predict(x, l));
}

Noise Quantisation::Corrected() const {
  Noise noise = *noise_;
  for (std::size_t c = 0; c < noise.channel.size(); ++c) {
    std::vector<std::vector<double>> values;
    for (const Trace& trace : traces_) values.push_back(trace.channel[c]);
    noise.channel[c] = RoundingNoise(noise.channel[c], values);
  }
  return noise;
}

double Quantisation::Inflation(const ProjectedResidual& residual,
                               const std::vector<std::vector<Probe>>& candidates,
                               std::uint64_t seed) const {
  Random64 random(seed);
  constexpr int kDraws = 40;
  double power = 0, count = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Problem::Vector z = residual.Project(Draw(random, false)).col(0);
    for (const auto& probes : candidates) {
      for (const Probe& probe : probes) {
        for (const auto& column : probe.columns.colwise()) {
          const double norm = column.squaredNorm();
          if (norm > 0) power += std::pow(column.dot(z), 2) / norm, count += 1;
        }
      }
    }
  }
  return count > 0 ? std::max(1.0, power / count) : 1;
}

Problem::Matrix Quantisation::Draws(const ProjectedResidual& residual, int count,
                                    std::uint64_t seed) const {
  Random64 random(seed);
  Problem::Matrix draws(residual.vector().size(), count);
  for (int i = 0; i < count; ++i) draws.col(i) = residual.Project(Draw(random, true)).col(0);
  return draws;
}

// all: also the noise of channels that are not rounded.
std::vector<Problem::Matrix> Quantisation::Draw(Random64& random, bool all) const {
  const auto& channels = problem_->channels();
  std::vector<Problem::Matrix> draw;
  std::vector<double> phase;
  for (const std::size_t c : channels) phase.push_back(Phase(noise_->channel[c], random));
  for (const Trace& trace : traces_) {
    const auto rows = static_cast<Eigen::Index>(trace.channel[channels.front()].size());
    Problem::Matrix log =
        Problem::Matrix::Zero(rows * static_cast<Eigen::Index>(channels.size()), 1);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const ChannelNoise& n = noise_->channel[channels[c]];
      if (!Rounded(n) && !all) continue;
      const auto& values = trace.channel[channels[c]];
      const auto errors = Rounded(n) ? RoundingErrors(n, values, phase[c], random)
                                     : NoiseDraw(n, values.size(), random);
      for (Eigen::Index k = 0; k < rows; ++k)
        log(static_cast<Eigen::Index>(c) * rows + k, 0) = errors[k] / problem_->scale(c);
    }
    draw.push_back(std::move(log));
  }
  return draw;
}

}  // namespace continuum
