#include "binding/sliding.h"

#include <algorithm>
#include <cmath>

#include "binding/linear.h"

namespace continuum {
namespace {

constexpr double kGiveWay = 1e-3, kGiveWayMost = 20, kEasier = 3;  // v_c of (4) [m/s]
constexpr double kStart = 1e-3;       // slower bends begin as they were in the last step [m/s]
constexpr double kMoving = 0.02;      // fresh bends that are faster slide [m/s]
constexpr double kGentle = 0.1;       // ... when no speed changes by more than that [m/s]
constexpr double kSpeedError = 1e-9;  // of v⁺ [m/s]
constexpr double kRelativeError = 1e-12;
constexpr int kPatience = 5, kRounds = 30;

// The part that a bend played in the last step, or plays by its speed.
int FirstGuess(const Bend& bend) {
  if (bend.band == 0) return 1;
  if (std::abs(bend.speed) > kStart) return bend.speed > 0 ? -1 : 1;
  if (std::abs(bend.memory) < bend.band * (1 - kRelativeError)) return 0;
  return bend.memory > 0 ? 1 : -1;
}

}  // namespace

void Sliding::Solve(const World& w, std::span<Bend> bends) {
  Guess(w, bends);
  GiveFresh(w, bends);
  if (AllSlide(w, bends)) return;
  Begin(w, bends);
  give_way_ = kGiveWay;
  while (!Settle(w, bends) && give_way_ < kGiveWayMost) give_way_ *= kEasier;
  while (give_way_ > kGiveWay) {
    found_.assign(bends.begin(), bends.end());
    give_way_ = std::max(kGiveWay, give_way_ / kEasier);
    if (Settle(w, bends)) continue;
    std::copy(found_.begin(), found_.end(), bends.begin());
    return;
  }
}

// Whether it found who slides which way.
bool Sliding::Settle(const World& w, std::span<Bend> bends) {
  auto fewest = static_cast<int>(bends.size()) + 1;
  int patience = kPatience;
  for (int round = 0; round < kRounds; ++round) {
    Assign(w, bends);
    Assemble(w, bends);
    SolveLinear(matrix_, velocity_);
    const int wrong = Judge(w, bends);
    if (wrong == 0) return true;
    patience = wrong < fewest ? kPatience : patience - 1;
    fewest = std::min(fewest, wrong);
    Change(bends, patience < 0);
  }
  return false;
}

void Sliding::Guess(const World& w, std::span<Bend> bends) {
  parts_.resize(bends.size()), grown_.resize(bends.size()), speed_.resize(bends.size());
  double before = 0;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    Bend& bend = bends[g];
    if (g == 0 || bends[g - 1].cable != bend.cable) before = w.base[bend.cable];
    grown_[g] = std::exp(bend.band);
    bend.side = FirstGuess(bend);
    before = bend.tension = before * (bend.side > 0 ? grown_[g] : 1 / grown_[g]);
  }
}

// Of the speeds, if every bend slides as guessed. Damping, left out here, only makes them smaller.
void Sliding::Changes(const World& w, std::span<const Bend> bends) {
  work_.assign(w.force.begin(), w.force.end());
  for (const Bend& bend : bends) {
    const double change = w.base[bend.cable] - bend.tension;
    w.geometry[bend.cable].Add(w.cables[bend.cable], bend.segment, change, work_.data());
  }
  mj_solveM(&w.m, &w.d, work_.data(), work_.data(), 1);
  change_.resize(bends.size());
  double change = 0;
  for (std::size_t g = bends.size(); g-- > 0;) {
    const int c = bends[g].cable;
    if (g + 1 == bends.size() || bends[g + 1].cable != c) change = 0;
    change -= w.m.opt.timestep * w.geometry[c].Rate(w.cables[c], bends[g].segment, work_.data());
    change_[g] = change;
  }
}

void Sliding::GiveFresh(const World& w, std::span<Bend> bends) {
  const auto moves = [](const Bend& b) { return b.fresh && std::abs(b.speed) >= kMoving; };
  if (std::none_of(bends.begin(), bends.end(), moves)) return;
  Changes(w, bends);
  const auto gentle = [](double change) { return std::abs(change) <= kGentle; };
  if (!std::all_of(change_.begin(), change_.end(), gentle)) return;
  for (Bend& bend : bends) bend.given = moves(bend);
}

// Whether nothing comes near to rest in this step.
bool Sliding::AllSlide(const World& w, std::span<const Bend> bends) {
  const auto slides = [&](const Bend& bend, double v) {
    return bend.band == 0 || bend.given || -bend.side * v > kStart;
  };
  for (const Bend& bend : bends) {
    if (!slides(bend, bend.speed)) return false;
  }
  Changes(w, bends);
  for (std::size_t g = 0; g < bends.size(); ++g) {
    if (!slides(bends[g], bends[g].speed + change_[g])) return false;
  }
  return true;
}

void Sliding::Begin(const World& w, std::span<const Bend> bends) {
  inertia_.Update(w.m, w.d);
  const int n = inertia_.size();
  const double h = w.m.opt.timestep;
  momentum_.assign(n, 0);
  for (int i = 0; i < n; ++i) {
    const double* const row = inertia_.matrix().data() + i * n;
    for (int j = 0; j < n; ++j) momentum_[i] += row[j] * w.d.qvel[inertia_.dofs()[j]];
    momentum_[i] += h * w.force[inertia_.dofs()[i]];
  }
  for (const Bend& bend : bends) {
    const Cable& cable = w.cables[bend.cable];
    const double* const arm = w.geometry[bend.cable].arm.data();
    for (int l = cable.begin[bend.segment]; l < cable.begin[bend.segment + 1]; ++l) {
      momentum_[inertia_.index(cable.levers[l].dof)] += h * w.base[bend.cable] * arm[l];
    }
  }
  row_.clear();
}

void Sliding::Assign(const World& w, std::span<const Bend> bends) {
  int cable = -1;
  double expected = 0;  // tension by all ratios
  for (std::size_t g = 0; g < bends.size(); ++g) {
    const Bend& bend = bends[g];
    if (bend.cable != cable) cable = bend.cable, expected = w.base[cable];
    Part& part = parts_[g];
    part.ratio = bend.side > 0 ? grown_[g] : bend.side < 0 ? 1 / grown_[g] : std::exp(bend.memory);
    expected *= part.ratio;
    part.yield = 0;
    if (bend.side != 0) continue;
    const double stiff = std::max(expected, w.last[cable] * std::exp(bend.level));
    part.yield = bend.band * stiff / give_way_;
  }
}

// dv_g/dq̇ = −Σ_{k ≥ g} dL_k/dq.
void Sliding::Rows(const World& w, std::span<const Bend> bends) {
  const int n = inertia_.size();
  row_.assign(bends.size() * n, 0);
  for (std::size_t g = bends.size(); g-- > 0;) {
    double* const row = row_.data() + g * n;
    const int c = bends[g].cable;
    if (g + 1 < bends.size() && bends[g + 1].cable == c) std::copy_n(row + n, n, row);
    const Cable& cable = w.cables[c];
    for (int l = cable.begin[bends[g].segment]; l < cable.begin[bends[g].segment + 1]; ++l) {
      row[inertia_.index(cable.levers[l].dof)] -= w.geometry[c].arm[l];
    }
  }
}

// (1) with t_g = constant_g − scale_g follow_g · q̇⁺, where follow collects the rows of bends at
// rest from the base on.
void Sliding::Assemble(const World& w, std::span<const Bend> bends) {
  const int n = inertia_.size();
  const double h = w.m.opt.timestep;
  matrix_ = inertia_.matrix();
  velocity_ = momentum_;
  int cable = -1;
  double constant = 0, scale = 0;
  bool follows = false;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    if (bends[g].cable != cable) {
      cable = bends[g].cable, constant = w.base[cable], scale = 1, follows = false;
    }
    const Part& part = parts_[g];
    constant *= part.ratio, scale *= part.ratio;
    if (part.yield > 0) {
      if (row_.empty()) Rows(w, bends);
      if (!follows) follow_.assign(n, 0);
      follows = true;
      const double f = part.yield / scale;
      for (int i = 0; i < n; ++i) follow_[i] += f * row_[g * n + i];
    }
    const int segment = bends[g].segment;
    for (int l = w.cables[cable].begin[segment]; l < w.cables[cable].begin[segment + 1]; ++l) {
      const int i = inertia_.index(w.cables[cable].levers[l].dof);
      const double arm = h * w.geometry[cable].arm[l];
      velocity_[i] -= arm * constant;
      if (!follows) continue;
      for (int j = 0; j < n; ++j) matrix_[i * n + j] -= arm * scale * follow_[j];
    }
  }
}

// How many bends have to change their part. Tensions stay within the bands in any case.
int Sliding::Judge(const World& w, std::span<Bend> bends) {
  double sum = 0;
  for (std::size_t g = bends.size(); g-- > 0;) {
    const int c = bends[g].cable, segment = bends[g].segment;
    if (g + 1 == bends.size() || bends[g + 1].cable != c) sum = 0;
    for (int l = w.cables[c].begin[segment]; l < w.cables[c].begin[segment + 1]; ++l) {
      sum -= w.geometry[c].arm[l] * velocity_[inertia_.index(w.cables[c].levers[l].dof)];
    }
    speed_[g] = sum;
  }
  int wrong = 0, cable = -1;
  double before = 0, wanted = 0;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    Bend& bend = bends[g];
    Part& part = parts_[g];
    if (bend.cable != cable) cable = bend.cable, before = wanted = w.base[cable];
    wanted = part.ratio * wanted - part.yield * speed_[g];
    part.better = bend.side;
    if (bend.side != 0) {
      bend.tension = part.ratio * before;
      if (bend.band > 0 && !bend.given && bend.side * speed_[g] > kSpeedError) part.better = 0;
    } else {
      bend.tension = std::clamp(wanted, before / grown_[g], before * grown_[g]);
      const double error = kRelativeError * bend.tension;
      if (wanted < bend.tension - error) part.better = -1;
      if (wanted > bend.tension + error) part.better = 1;
    }
    before = bend.tension;
    wrong += part.better != bend.side;
  }
  return wrong;
}

void Sliding::Change(std::span<Bend> bends, bool one) {
  for (std::size_t g = bends.size(); g-- > 0;) {
    if (bends[g].side == parts_[g].better) continue;
    bends[g].side = parts_[g].better;
    if (one) return;
  }
}

}  // namespace continuum
