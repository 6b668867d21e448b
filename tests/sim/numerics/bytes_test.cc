#include "sim/numerics/bytes.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace continuum {
namespace {

enum class Colour { kRed, kGreen };

struct Part {
  Eigen::MatrixXd matrix;
  std::optional<std::string> name;
};

struct Whole {
  std::vector<bool> flags;
  std::vector<std::vector<double>> numbers;
  Colour colour = Colour::kRed;
  std::vector<Part> parts;
  Eigen::VectorXd vector;
};

template <class A>
void Fields(A& a, Part& p) {
  auto& [matrix, name] = p;
  a(matrix, name);
}

template <class A>
void Fields(A& a, Whole& w) {
  auto& [flags, numbers, colour, parts, vector] = w;
  a(flags, numbers, colour, parts, vector);
}

Whole Example() {
  constexpr double kSmall = std::numeric_limits<double>::denorm_min();
  return {{true, false, true},
          {{}, {0.1, -0.0, kSmall}},
          Colour::kGreen,
          {{Eigen::MatrixXd::Random(3, 2), "one"}, {Eigen::MatrixXd(0, 2), std::nullopt}},
          Eigen::VectorXd::Random(5)};
}

TEST(Bytes, GiveBackWhatWasPutIn) {
  Whole before = Example();
  const auto after = FromBytes<Whole>(ToBytes(before));
  EXPECT_EQ(after.flags, before.flags);
  EXPECT_EQ(after.numbers, before.numbers);
  EXPECT_TRUE(std::signbit(after.numbers[1][1]));
  EXPECT_EQ(after.colour, before.colour);
  EXPECT_EQ(after.vector, before.vector);
  ASSERT_EQ(after.parts.size(), 2);
  EXPECT_EQ(after.parts[0].matrix, before.parts[0].matrix);
  EXPECT_EQ(after.parts[0].name, "one");
  EXPECT_EQ(after.parts[1].matrix.cols(), 2);
  EXPECT_EQ(after.parts[1].name, std::nullopt);
}

TEST(Bytes, ThatEndEarlyAreRefused) {
  Whole example = Example();
  const std::string bytes = ToBytes(example);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(FromBytes<Whole>(bytes.substr(0, size)), Error) << size;
}

}  // namespace
}  // namespace continuum
