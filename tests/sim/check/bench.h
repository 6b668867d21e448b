#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/check/check.h"

/// A bench of two masses for tests of `check`, and its findings.
namespace continuum::testing {

inline constexpr double kPeriod = 0.01;  // [s]
inline constexpr double kDegree = std::numbers::pi / 180;

// q'' = w² (u − q) − 2 d w q', u held between rows, integrated in 20 substeps.
struct Mass {
  double w = 12, d = 0.3, q = 0, v = 0;
  void Advance(double u) {
    constexpr int kSubsteps = 20;
    const double h = kPeriod / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {
      v += h * (w * w * (u - q) - 2 * d * w * v);
      q += h * v;
    }
  }
};

using Command = std::function<double(double)>;
inline double Steps(double t) { return t < 1 ? 0 : t < 3 ? 1 : t < 5 ? -0.5 : 0.25; }
inline double Sines(double t) { return 0.8 * std::sin(2.1 * t) + 0.3 * std::sin(5.3 * t); }

// One input [rad], the angle of one mass [rad], its speed [rad/s], and a slower mass's angle.
struct Recipe {
  Command u1 = Steps, u2 = Sines;
  std::size_t rows = 1000;
  double noise = 1e-3, quantum = 0;
  unsigned seed = 1;
};

inline Experiment Bench() {
  Experiment e;
  e.inputs = {{"u1", "rad", "m1", "", false, ""}, {"u2", "rad", "m2", "", false, ""}};
  for (const auto& [column, unit] :
       {std::pair{"q1", "rad"}, std::pair{"v1", "rad/s"}, std::pair{"q2", "rad"}}) {
    Output out;
    out.columns = {column};
    out.unit = unit;
    out.source = column;
    e.channels.push_back({column, unit, e.outputs.size(), 0, 1});
    e.outputs.push_back(out);
  }
  return e;
}

inline Log Record(const Recipe& recipe, const std::string& label = "bench") {
  Log log;
  log.label = log.trial = label;
  log.input.resize(2);
  log.enable.resize(2);
  log.measured.resize(3);
  std::mt19937 random(recipe.seed);
  std::normal_distribution<double> noise;
  const auto round = [&](double x) {
    return recipe.quantum > 0 ? recipe.quantum * std::round(x / recipe.quantum) : x;
  };
  Mass first, second{6, 0.5};
  for (std::size_t k = 0; k < recipe.rows; ++k) {
    const double t = kPeriod * static_cast<double>(k);
    log.time.push_back(t);
    log.input[0].push_back(recipe.u1(t));
    log.input[1].push_back(recipe.u2(t));
    log.measured[0].push_back(round(first.q + recipe.noise * noise(random)));
    log.measured[1].push_back(first.v + 10 * recipe.noise * noise(random));
    log.measured[2].push_back(round(second.q + recipe.noise * noise(random)));
    first.Advance(log.input[0].back());
    second.Advance(log.input[1].back());
  }
  return log;
}

inline Experiment With(Log log) {
  Experiment e = Bench();
  e.logs.push_back(std::move(log));
  return e;
}

inline std::vector<Finding> Bad(const std::vector<Finding>& all) {
  std::vector<Finding> bad;
  for (const Finding& f : all) {
    if (f.severity != Finding::Severity::kInfo) bad.push_back(f);
  }
  return bad;
}

inline const Finding* Find(const std::vector<Finding>& all, const std::string& what,
                           const std::string& channel = "") {
  for (const Finding& f : all) {
    if (f.what == what && f.channel == channel) return &f;
  }
  return nullptr;
}

// One warning of this kind, on this channel, and no other.
inline Finding Only(const Log& log, const std::string& what, const std::string& channel = "") {
  const auto all = CheckLogs(With(log));
  const auto bad = Bad(all);
  EXPECT_EQ(bad.size(), 1u) << Report(all);
  const Finding* const found = Find(bad, what, channel);
  EXPECT_NE(found, nullptr) << what << " " << channel << "\n" << Report(all);
  return found ? *found : Finding{};
}

inline std::vector<double>& Column(Log& log, const std::string& name) {
  if (name[0] == 'u') return log.input[name == "u2"];
  return log.measured[name == "q1" ? 0 : name == "v1" ? 1 : 2];
}

inline void DropRows(Log& log, std::size_t from, std::size_t to) {
  const auto cut = [&](auto& v) {
    v.erase(v.begin() + static_cast<std::ptrdiff_t>(from),
            v.begin() + static_cast<std::ptrdiff_t>(to));
  };
  cut(log.time);
  for (auto& column : log.input) cut(column);
  for (auto& column : log.measured) cut(column);
}
// A chirp, a square wave, a triangle or a ramp that holds.
inline Command RandomCommand(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double size = 0.2 + uniform(random), f = 0.2 + 2 * uniform(random), at = uniform(random);
  const auto kind = static_cast<int>(4 * uniform(random));
  return [=](double t) {
    const double phase = f * (t - at) - std::floor(f * (t - at));
    if (kind == 0) return size * std::sin(2 * std::numbers::pi * f * t * (1 + 0.1 * t));
    if (kind == 1) return phase < 0.5 ? size : -size;
    if (kind == 2) return size * (std::abs(4 * phase - 2) - 1);
    return t < at ? 0 : size * std::min(1.0, 2 * (t - at));
  };
}

}  // namespace continuum::testing
