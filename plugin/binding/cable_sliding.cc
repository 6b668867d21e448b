#include "binding/cable_sliding.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace continuum {
namespace {

constexpr double kGiveWayMost = 20, kEasier = 3;  // v_c of (4) [m/s]
constexpr double kStart = 1e-3;  // slower bends begin as they were in the last step [m/s]
constexpr double kCreep = 1e-6, kNearly = 0.99;  // ... but these slid, and do [m/s]
constexpr double kMoving = 0.02;                 // fresh bends that are faster slide [m/s]
constexpr double kThrownBack = 0.2;   // ... unless that gives one a speed like this [m/s]
constexpr double kSpeedError = 1e-9;  // of v⁺ [m/s]
constexpr double kRelativeError = 1e-12;
constexpr int kPatience = 5, kRounds = 30;

// The part that a bend plays by its speed, or played in the last step. The bend may have grown
// since: what moves and was near to its limit still slides.
int FirstGuess(const Bend& bend) {
  if (bend.band == 0) return 1;
  const int side = bend.speed > 0 ? -1 : 1;
  if (std::abs(bend.speed) > kStart) return side;
  if (std::abs(bend.speed) > kCreep && side * bend.memory > kNearly * bend.band) return side;
  if (std::abs(bend.memory) < bend.band * (1 - kRelativeError)) return 0;
  return bend.memory > 0 ? 1 : -1;
}

double SlidingRatio(const Bend& bend) {
  const double ratio = bend.side > 0 ? bend.grown : 1 / bend.grown;
  return bend.turned > 0 ? bend.turned / ratio + (1 - bend.turned) * ratio : ratio;
}

bool Slides(const Bend& bend, double v, double least) {
  return bend.band == 0 || bend.given || -bend.side * v > least;
}

}  // namespace

CableSliding::CableSliding(const mjModel& m, const CableGeometry& geometry)
    : islands_(m, geometry), work_(m.nv), none_(m.nv) {}

void CableSliding::Solve(const World& w, std::span<Bend> bends) {
  turn_.bends.clear(), gives_ = w.Gives();
  Guess(w, bends);
  GiveFresh(w, bends);
  islands_.Link(w.m, w.geometry, w.rows);
  damped_ = false;
  SolveFree(w, bends);
  for (int island = 0; island < islands_.size(); ++island) {
    if (!islands_.rows(island).empty()) SolveWithRows(w, bends, island);
  }
}

// Those without rows in which something is or comes near to rest in this step.
void CableSliding::SolveFree(const World& w, std::span<Bend> bends) {
  bool changes = false;
  const double least = w.Gives() ? 2 * w.GiveWay() : kStart;
  rows_.End();
  for (std::size_t begin = 0, end = 0; begin < bends.size(); begin = end) {
    const int island = islands_.of_cable(bends[begin].cable);
    while (end < bends.size() && islands_.of_cable(bends[end].cable) == island) ++end;
    if (!islands_.rows(island).empty()) continue;
    const std::span<Bend> some = bends.subspan(begin, end - begin);
    bool slide = std::all_of(some.begin(), some.end(),
                             [&](const Bend& bend) { return Slides(bend, bend.speed, least); });
    if (slide && !std::exchange(changes, true)) Changes(w, bends, w.force);
    for (std::size_t g = begin; slide && g < end; ++g)
      slide = Slides(bends[g], bends[g].speed + change_[g], least);
    if (slide) continue;
    Begin(w, island);
    BeginFree(w, some);
    SolveSides(w, some);
    TurnWithinStep(w, some);
  }
}

void CableSliding::SolveWithRows(const World& w, std::span<Bend> bends, int island) {
  const auto here = [&](const Bend& bend) { return islands_.of_cable(bend.cable) == island; };
  some_.clear();
  std::copy_if(bends.begin(), bends.end(), std::back_inserter(some_), here);
  const auto rough = [](const Bend& bend) { return bend.band > 0; };
  if (std::none_of(some_.begin(), some_.end(), rough)) return;
  Begin(w, island);
  few_ = false;
  islands_.inertia(island).Update(w.m, w.d, damping_);
  rows_.Begin(w.m, w.d, inertia(), w.rows, islands_.rows(island), w.native);
  SolveSides(w, some_);
  TurnWithinStep(w, some_);
  auto solved = some_.begin();
  for (Bend& bend : bends) {
    if (here(bend)) bend = *solved++;
  }
  for (std::size_t c = 0; c < w.base.size(); ++c) {
    const int cable = static_cast<int>(c);
    if (islands_.of_cable(cable) == island && rows_.base(cable).rows)
      w.base[c] = std::max(0.0, BaseOf(w, cable));
  }
}

void CableSliding::Begin(const World& w, int island) {
  if (!std::exchange(damped_, true)) {
    damping_.Update(w.m, w.d);
    covered_ = ArticulatedInertia::Covers(w.m);
  }
  island_ = island;
  follow_.resize(inertia().size()), velocity_.resize(inertia().size());
}

double CableSliding::BaseOf(const World& w, int cable) const {
  const bool rows = !rows_.empty() && rows_.base(cable).rows;
  return rows ? rows_.base(cable).At(velocity_) : w.base[cable];
}

// Change of the speed with which a cable runs along itself.
double CableSliding::EndSpeed(int cable) const {
  const int end = islands_.end(cable);
  return end >= 0 ? velocity_[end] : 0;
}

void CableSliding::SolveSides(const World& w, std::span<Bend> bends) {
  const double least = give_way_ = w.GiveWay();
  while (!Settle(w, bends) && give_way_ < std::max(kGiveWayMost, least)) give_way_ *= kEasier;
  while (give_way_ > least) {
    found_.assign(bends.begin(), bends.end());
    const std::vector<bool> acting = rows_.Acting();
    give_way_ = std::max(least, give_way_ / kEasier);
    if (Settle(w, bends)) continue;
    std::copy(found_.begin(), found_.end(), bends.begin());
    rows_.Act(acting);
    velocity_ = answer_.velocity;
    return;
  }
}

// Whether it found who slides which way.
bool CableSliding::Settle(const World& w, std::span<Bend> bends) {
  auto fewest = static_cast<int>(bends.size() + rows_.size()) + 1;
  int patience = kPatience;
  for (int round = 0; round < kRounds; ++round) {
    Assign(w, bends);
    SolveVelocity(w, bends);
    const int wrong = Judge(w, bends) + rows_.Judge(velocity_);
    if (wrong == 0) {
      answer_.give_way = give_way_, answer_.velocity = velocity_;
      return true;
    }
    patience = wrong < fewest ? kPatience : patience - 1;
    fewest = std::min(fewest, wrong);
    const bool one = patience < 0;
    if (!rows_.Change(one) || !one) Change(bends, one);
  }
  return false;
}

void CableSliding::Guess(const World& w, std::span<Bend> bends) {
  parts_.resize(bends.size());
  double before = 0;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    Bend& bend = bends[g];
    if (g == 0 || bends[g - 1].cable != bend.cable) before = w.base[bend.cable];
    bend.side = FirstGuess(bend);
    bend.ratio = bend.side > 0 ? bend.grown : 1 / bend.grown;
    before = bend.tension = before * bend.ratio;
    if (IsLast(bends, g) && w.geometry.both[bend.cable]) BalanceBySlowest(w, bends.first(g + 1));
  }
}

// (3a) for the guess of the last of these cables: what the others leave is at the bend that its
// running along itself has brought to rest.
void CableSliding::BalanceBySlowest(const World& w, std::span<Bend> bends) const {
  std::size_t slowest = bends.size() - 1, g = slowest;
  double product = bends[g].ratio;
  while (g > 0 && !IsLast(bends, g - 1)) {
    product *= bends[--g].ratio;
    if (std::abs(bends[g].speed) < std::abs(bends[slowest].speed)) slowest = g;
  }
  Bend& rest = bends[slowest];
  rest.ratio = std::clamp(rest.ratio / product, 1 / rest.grown, rest.grown);
  double before = w.base[rest.cable];
  for (Bend& bend : bends.subspan(g)) before = bend.tension = before * bend.ratio;
}

// Of the speeds by this force and friction, if every bend slides as guessed. Damping, left out
// here, only makes them smaller.
void CableSliding::Changes(const World& w, std::span<const Bend> bends,
                           std::span<const double> force) {
  std::copy(force.begin(), force.end(), work_.begin());
  for (const Bend& bend : bends) {
    w.geometry.Add(bend.segment, w.base[bend.cable] - bend.tension, work_.data());
  }
  mj_solveM(&w.m, &w.d, work_.data(), work_.data(), 1);
  change_.resize(bends.size());
  double change = 0;
  for (std::size_t g = bends.size(); g-- > 0;) {
    if (IsLast(bends, g)) change = 0;
    change -= w.m.opt.timestep * w.geometry.Rate(bends[g].segment, work_.data());
    change_[g] = change;
  }
}

void CableSliding::GiveFresh(const World& w, std::span<Bend> bends) {
  const auto moves = [](const Bend& b) { return b.fresh && std::abs(b.speed) >= kMoving; };
  if (std::none_of(bends.begin(), bends.end(), moves)) return;
  Changes(w, bends, none_);
  for (std::size_t g = 0; g < bends.size(); ++g) {
    const double back = bends[g].side * (bends[g].speed + change_[g]);
    bends[g].given = moves(bends[g]) && back <= kThrownBack;
  }
}

void CableSliding::Assign(const World& w, std::span<const Bend> bends) {
  int cable = -1;
  double expected = 0;  // tension by all ratios
  for (std::size_t g = 0; g < bends.size(); ++g) {
    const Bend& bend = bends[g];
    if (bend.cable != cable) cable = bend.cable, expected = w.base[cable];
    Part& part = parts_[g];
    part.ratio = bend.side != 0 ? SlidingRatio(bend) : std::exp(bend.memory);
    const double held = expected * (bend.side != 0 && gives_ ? std::exp(bend.memory) : part.ratio);
    expected *= part.ratio;
    part.yield = part.spring = part.drop = 0;
    if (bend.side != 0 && !gives_) continue;
    const double stiff = std::max(held, w.last[cable] * std::exp(bend.level));
    (bend.side == 0 ? part.yield : part.spring) = bend.band * stiff / give_way_;
  }
}

// follow += f dv_g/dq̇ = −f Σ_{k ≥ g} dL_k/dq; f for the cable's own speed.
void CableSliding::Follow(const World& w, const Bend& bend, double f,
                          std::span<double> follow) const {
  const CableGeometry& route = w.geometry;
  const int end = route.begin[route.first[bend.cable + 1]];
  for (int l = route.begin[bend.segment]; l < end; ++l)
    follow[islands_.place(l)] -= f * route.arm[l];
  if (const int place = islands_.end(bend.cable); place >= 0) follow[place] += f;
}

// Rows of the constraint solver couple all joints, and up to so many are solved for quicker than
// what resists.
void CableSliding::BeginFree(const World& w, std::span<const Bend> bends) {
  constexpr int kSmall = 28;
  few_ = covered_ && inertia().size() > kSmall;
  if (few_) {
    few_unknowns_.Begin({w.m, w.d, w.geometry, islands_, island_, damping_, w.force, w.base},
                        bends);
  } else {
    islands_.inertia(island_).Update(w.m, w.d, damping_);
  }
}

void CableSliding::SolveVelocity(const World& w, std::span<const Bend> bends) {
  if (!few_) return SolveDense(w, bends);
  few_unknowns_.Solve({w.m, w.d, w.geometry, islands_, island_, damping_, w.force, w.base}, bends,
                      parts_, velocity_);
}

// Solves (1) with t_g = constant − scale follow · (q̇⁺ − q̇), where follow collects the speeds of the
// bends at rest from the base on.
void CableSliding::SolveDense(const World& w, std::span<const Bend> bends) {
  matrix_ = rows_.empty() ? inertia().matrix() : rows_.matrix();
  const auto joints = static_cast<int>(inertia().dofs().size());
  for (int i = 0; i < inertia().size(); ++i) {
    const double push = rows_.empty() ? 0 : rows_.push()[i];
    velocity_[i] = w.m.opt.timestep * ((i < joints ? w.force[inertia().dofs()[i]] : 0) + push);
  }
  Assemble(w, bends);
  SolveLinear(matrix_, velocity_);
}

// What the bends add to the matrix of (1), and to its right-hand side.
void CableSliding::Assemble(const World& w, std::span<const Bend> bends) {
  const double h = w.m.opt.timestep;
  const int n = inertia().size();
  int cable = -1;
  double base = 0, constant = 0, scale = 0;
  bool follows = false;
  const std::vector<double>* slope = nullptr;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    const Bend& bend = bends[g];
    const Part& part = parts_[g];
    if (bend.cable != cable) {
      cable = bend.cable;
      slope = !rows_.empty() && rows_.base(cable).rows ? &rows_.base(cable).slope : nullptr;
      base = constant = slope ? rows_.base(cable).constant : w.base[cable];
      scale = 1, follows = slope;
      if (slope) follow_ = *slope;
    }
    constant = part.ratio * constant - part.yield * bend.speed;
    scale *= part.ratio;
    if (part.yield > 0) {
      if (!follows) std::fill(follow_.begin(), follow_.end(), 0.0);
      follows = true;
      Follow(w, bend, part.yield / scale, follow_);
    }
    const auto pull = [&](int place, double arm) {
      velocity_[place] -= arm * (constant - base);
      if (!follows) return;
      double* const row = matrix_.data() + place * n;
      for (int j = 0; j < n; ++j) row[j] -= arm * scale * follow_[j];
      for (int j = 0; slope && j < n; ++j) row[j] += arm * (*slope)[j];
    };
    for (int l = w.geometry.begin[bend.segment]; l < w.geometry.begin[bend.segment + 1]; ++l)
      pull(islands_.place(l), h * w.geometry.arm[l]);
    if (const int place = islands_.end(cable); place >= 0 && IsLast(bends, g)) pull(place, -h);
  }
}

// How many bends have to change their part. Tensions stay within the bands in any case.
int CableSliding::Judge(const World& w, std::span<Bend> bends) {
  double change = 0;
  speed_.resize(bends.size());
  for (std::size_t g = bends.size(); g-- > 0;) {
    const int s = bends[g].segment;
    if (IsLast(bends, g)) change = EndSpeed(bends[g].cable);
    for (int l = w.geometry.begin[s]; l < w.geometry.begin[s + 1]; ++l) {
      change -= w.geometry.arm[l] * velocity_[islands_.place(l)];
    }
    speed_[g] = bends[g].speed + change;
    if (!few_) parts_[g].drop = parts_[g].yield * change;
  }
  int wrong = 0, cable = -1;
  double before = 0, wanted = 0;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    Bend& bend = bends[g];
    Part& part = parts_[g];
    if (bend.cable != cable)
      cable = bend.cable, before = wanted = std::max(BaseOf(w, cable), 1e-12);
    wanted = part.ratio * wanted - part.yield * bend.speed - part.drop;
    part.better = bend.side;
    if (bend.side != 0) {
      bend.tension = part.ratio * before, bend.ratio = part.ratio;
      double least = 0;
      if (part.spring > 0)
        least = before * std::abs(std::exp(bend.memory) - part.ratio) / part.spring;
      if (bend.band > 0 && !bend.given && -bend.side * speed_[g] < least - kSpeedError)
        part.better = 0;
    } else {
      bend.tension = std::clamp(wanted, before / bend.grown, before * bend.grown);
      const double error = kRelativeError * bend.tension;
      if (wanted < bend.tension - error) part.better = -1;
      if (wanted > bend.tension + error) part.better = 1;
      bend.ratio = bend.tension / before;
    }
    before = bend.tension;
    wrong += part.better != bend.side;
  }
  return wrong;
}

void CableSliding::Change(std::span<Bend> bends, bool one) {
  for (std::size_t g = bends.size(); g-- > 0;) {
    if (bends[g].side == parts_[g].better) continue;
    bends[g].side = parts_[g].better;
    if (one) return;
  }
}

}  // namespace continuum
