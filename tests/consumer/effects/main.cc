#include <cmath>
#include <cstdio>

#include "effects/all.h"

// Dahl friction at constant speed against its closed form z = 1 - exp(-sigma/f v t), F = f z; and
// how many laws the installed headers hold.
int main() {
  const double sigma = 2, f = 0.3, v = 0.1, t = 0.5;
  const continuum::Port<double> port{0, v};
  const continuum::Vec<double, 2> p{sigma, f};
  const auto z = continuum::Dahl::Step<double>({0.0}, port, t, p);
  const double force = continuum::Dahl::Eval<double>(port, z, p).force;
  const double expected = f * (1 - std::exp(-sigma / f * v * t));
  int laws = 0;
  continuum::All::ForEach([&]<class E>() { ++laws; });
  std::printf("%d laws; Dahl %.17g N*m, closed form %.17g N*m\n", laws, force, expected);
  return laws > 0 && std::abs(force - expected) < 1e-15 ? 0 : 1;  // some roundings of 0.085
}
