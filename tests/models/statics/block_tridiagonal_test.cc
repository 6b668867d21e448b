#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "models/statics/block_tridiagonal.h"

namespace continuum::statics {
namespace {

BlockTridiagonal RandomMatrix(int blocks, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  const auto block = [&] {
    Eigen::Matrix3d b;
    for (double& x : b.reshaped()) x = share(random);
    return b;
  };
  BlockTridiagonal m(blocks);
  for (int i = 0; i < blocks; ++i) {
    m.diagonal(i) = block() + 1.5 * share(random) * Eigen::Matrix3d::Identity();
    if (i == 0) continue;
    m.lower(i) = block();
    m.upper(i) = block();
  }
  return m;
}

TEST(BlockTridiagonal, CountsTheNegativeEigenvaluesOfItsSymmetricPart) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const BlockTridiagonal m = RandomMatrix(1 + static_cast<int>(seed % 7), seed);
    const Eigen::MatrixXd dense = m.Dense();
    const Eigen::MatrixXd symmetric = 0.5 * (dense + dense.transpose());
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues();
    EXPECT_EQ(m.NegativeDirections(), (values.array() < 0).count()) << seed;
  }
}

TEST(BlockTridiagonal, SolvesWhatItMultiplies) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const BlockTridiagonal m = RandomMatrix(6, seed);
    const Eigen::Matrix3Xd x = Eigen::Matrix3Xd::Random(3, 6);
    EXPECT_LT((m.Solve(m.Times(x)) - x).norm(), 1e-8);
    EXPECT_LT((m.Times(x).reshaped() - m.Dense() * x.reshaped()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace continuum::statics
