#include "binding/cable_sliding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "binding/tree_groups.h"

namespace continuum {
namespace {

constexpr double kGiveWay = 1e-3, kGiveWayMost = 20, kEasier = 3;  // v_c of (4) [m/s]
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

bool Slides(const Bend& bend, double v) {
  return bend.band == 0 || bend.given || -bend.side * v > kStart;
}

}  // namespace

CableSliding::CableSliding(const mjModel& m, const CableGeometry& geometry,
                           std::span<const int> rows)
    : row_base_(geometry.cables()) {
  std::vector<std::vector<int>> of_cable, dofs(1, {rows.begin(), rows.end()});
  for (int c = 0; c < geometry.cables(); ++c) {
    const int* const all = geometry.dof.data();
    of_cable.emplace_back(all + geometry.begin[geometry.first[c]],
                          all + geometry.begin[geometry.first[c + 1]]);
  }
  island_of_ = rows.empty() ? TreeGroups(m, of_cable) : std::vector<int>(of_cable.size(), 0);
  for (std::size_t c = 0; c < of_cable.size(); ++c) {
    dofs.resize(std::max<std::size_t>(dofs.size(), island_of_[c] + 1));
    auto& island = dofs[island_of_[c]];
    island.insert(island.end(), of_cable[c].begin(), of_cable[c].end());
  }
  for (const auto& each : dofs) {
    inertias_.emplace_back(m, each);
    dofs_.insert(dofs_.end(), inertias_.back().dofs().begin(), inertias_.back().dofs().end());
  }
  least_.assign(geometry.segments(), 0);
  for (int c = 0; c < geometry.cables(); ++c) AddPlaces(geometry, c);
  work_.resize(m.nv), none_.resize(m.nv);
}

void CableSliding::AddPlaces(const CableGeometry& geometry, int c) {
  const StepInertia& inertia = inertias_[island_of_[c]];
  for (int l = geometry.begin[geometry.first[c]]; l < geometry.begin[geometry.first[c + 1]]; ++l)
    place_.push_back(inertia.index(geometry.dof[l]));
  int least = inertia.size();
  for (int s = geometry.first[c + 1]; s-- > geometry.first[c];) {
    for (int l = geometry.begin[s]; l < geometry.begin[s + 1]; ++l)
      least = std::min(least, place_[l]);
    least_[s] = least;
  }
}

void CableSliding::Solve(const World& w, std::span<Bend> bends) {
  Guess(w, bends);
  GiveFresh(w, bends);
  if (w.rows.empty()) {
    SolveIslands(w, bends);
    return;
  }
  Begin(w, 0);
  do {
    TakeRows(w);
    SolveSides(w, bends);
  } while (ReleaseRows(w));
  for (std::size_t c = 0; c < row_base_.size(); ++c) {
    if (row_base_[c].rows) w.base[c] = std::max(0.0, BaseOf(w, static_cast<int>(c)));
  }
}

// Those in which something is or comes near to rest in this step.
void CableSliding::SolveIslands(const World& w, std::span<Bend> bends) {
  bool changes = false;
  for (std::size_t begin = 0, end = 0; begin < bends.size(); begin = end) {
    const int island = island_of_[bends[begin].cable];
    while (end < bends.size() && island_of_[bends[end].cable] == island) ++end;
    const std::span<Bend> some = bends.subspan(begin, end - begin);
    bool slide = std::all_of(some.begin(), some.end(),
                             [](const Bend& bend) { return Slides(bend, bend.speed); });
    if (slide && !std::exchange(changes, true)) Changes(w, bends, w.force);
    for (std::size_t g = begin; slide && g < end; ++g)
      slide = Slides(bends[g], bends[g].speed + change_[g]);
    if (slide) continue;
    Begin(w, island);
    system_ = inertia().matrix(), push_ = w.force;
    SolveSides(w, some);
  }
}

void CableSliding::Begin(const World& w, int island) {
  island_ = island;
  inertias_[island].Update(w.m, w.d);
  follow_.resize(inertia().size()), velocity_.resize(inertia().size());
}

// (1a) of the rows that act.
void CableSliding::TakeRows(const World& w) {
  const int n = inertia().size();
  const double h = w.m.opt.timestep;
  matrix_ = inertia().matrix(), pushed_.assign(w.force.begin(), w.force.end());
  for (std::size_t c = 0; c < row_base_.size(); ++c) {
    RowBase& base = row_base_[c];
    base.rows = std::any_of(w.rows.begin(), w.rows.end(),
                            [&](const SolvedRow& row) { return row.on[c] != 0; });
    if (!base.rows) continue;
    base.constant = w.native[c];
    base.slope.assign(n, 0);
  }
  for (const SolvedRow& row : w.rows) {
    if (!row.acts) continue;
    for (int i = 0; i < n; ++i) {
      const double Ji = row.J[inertia().dofs()[i]];
      if (Ji == 0) continue;
      pushed_[inertia().dofs()[i]] += Ji * row.stiffness * row.reference;
      for (int j = i; j < n; ++j)
        matrix_[i * n + j] += row.stiffness * Ji * row.J[inertia().dofs()[j]];
    }
    for (std::size_t c = 0; c < row_base_.size(); ++c) {
      if (row.on[c] == 0) continue;
      row_base_[c].constant += row.on[c] * row.stiffness * row.reference;
      for (int i = 0; i < n; ++i)
        row_base_[c].slope[i] += row.on[c] * row.stiffness / h * row.J[inertia().dofs()[i]];
    }
  }
  system_ = matrix_, push_ = pushed_;
}

// Limits that would have to pull the other way act no more; whether there was one.
bool CableSliding::ReleaseRows(const World& w) {
  bool some = false;
  for (SolvedRow& row : w.rows) {
    if (!row.acts || !row.limit) continue;
    double change = 0;
    for (int i = 0; i < inertia().size(); ++i) change += row.J[inertia().dofs()[i]] * velocity_[i];
    row.acts = row.reference - change / w.m.opt.timestep >= 0;
    some |= !row.acts;
  }
  return some;
}

double CableSliding::BaseOf(const World& w, int cable) const {
  const RowBase& base = row_base_[cable];
  if (w.rows.empty() || !base.rows) return w.base[cable];
  double tension = base.constant;
  for (int i = 0; i < inertia().size(); ++i) tension -= base.slope[i] * velocity_[i];
  return tension;
}

void CableSliding::SolveSides(const World& w, std::span<Bend> bends) {
  solver_.Begin(system_, inertia().size());
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
bool CableSliding::Settle(const World& w, std::span<Bend> bends) {
  auto fewest = static_cast<int>(bends.size()) + 1;
  int patience = kPatience;
  for (int round = 0; round < kRounds; ++round) {
    Assign(w, bends);
    Assemble(w, bends);
    solver_.Solve(velocity_);
    const int wrong = Judge(w, bends);
    if (wrong == 0) {
      answer_.give_way = give_way_, answer_.velocity = velocity_;
      return true;
    }
    patience = wrong < fewest ? kPatience : patience - 1;
    fewest = std::min(fewest, wrong);
    Change(bends, patience < 0);
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
  }
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
    if (g + 1 == bends.size() || bends[g + 1].cable != bends[g].cable) change = 0;
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
    part.ratio = bend.side > 0   ? bend.grown
                 : bend.side < 0 ? 1 / bend.grown
                                 : std::exp(bend.memory);
    expected *= part.ratio;
    part.yield = 0;
    if (bend.side != 0) continue;
    const double stiff = std::max(expected, w.last[cable] * std::exp(bend.level));
    part.yield = bend.band * stiff / give_way_;
  }
}

// The place of the first dof that the friction of bends at rest depends on, or acts on.
int CableSliding::FirstAtRest(std::span<const Bend> bends) const {
  int first = inertia().size();
  for (const Bend& bend : bends) {
    if (bend.side == 0) first = std::min(first, least_[bend.segment]);
  }
  return first;
}

// follow += f dv_g/dq̇ = −f Σ_{k ≥ g} dL_k/dq.
void CableSliding::Follow(const World& w, const Bend& bend, double f,
                          std::span<double> follow) const {
  const CableGeometry& route = w.geometry;
  const int end = route.begin[route.first[bend.cable + 1]];
  for (int l = route.begin[bend.segment]; l < end; ++l) follow[place_[l]] -= f * route.arm[l];
}

// (1) with t_g = constant − scale follow · (q̇⁺ − q̇), where follow collects the speeds of the bends
// at rest from the base on.
void CableSliding::Assemble(const World& w, std::span<const Bend> bends) {
  const double h = w.m.opt.timestep;
  const int n = inertia().size(), first = w.rows.empty() ? FirstAtRest(bends) : 0, rest = n - first;
  const std::span<double> block = solver_.Block(first);
  for (int i = 0; i < n; ++i) velocity_[i] = h * push_[inertia().dofs()[i]];
  int cable = -1;
  double base = 0, constant = 0, scale = 0;
  bool follows = false;
  const std::vector<double>* slope = nullptr;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    const Bend& bend = bends[g];
    const Part& part = parts_[g];
    if (bend.cable != cable) {
      cable = bend.cable;
      slope = !w.rows.empty() && row_base_[cable].rows ? &row_base_[cable].slope : nullptr;
      base = constant = slope ? row_base_[cable].constant : w.base[cable];
      scale = 1, follows = slope;
      if (slope) follow_ = *slope;
    }
    constant = part.ratio * constant - part.yield * bend.speed;
    scale *= part.ratio;
    if (part.yield > 0) {
      if (!follows) std::fill(follow_.begin() + first, follow_.end(), 0.0);
      follows = true;
      Follow(w, bend, part.yield / scale, follow_);
    }
    for (int l = w.geometry.begin[bend.segment]; l < w.geometry.begin[bend.segment + 1]; ++l) {
      const double arm = h * w.geometry.arm[l];
      velocity_[place_[l]] -= arm * (constant - base);
      if (!follows) continue;
      double* const row = block.data() + (place_[l] - first) * rest;
      for (int j = 0; j < rest; ++j) row[j] -= arm * scale * follow_[first + j];
      for (int j = 0; slope && j < rest; ++j) row[j] += arm * (*slope)[j];
    }
  }
}

// How many bends have to change their part. Tensions stay within the bands in any case.
int CableSliding::Judge(const World& w, std::span<Bend> bends) {
  double change = 0;
  speed_.resize(bends.size());
  for (std::size_t g = bends.size(); g-- > 0;) {
    const int s = bends[g].segment;
    if (g + 1 == bends.size() || bends[g + 1].cable != bends[g].cable) change = 0;
    for (int l = w.geometry.begin[s]; l < w.geometry.begin[s + 1]; ++l) {
      change -= w.geometry.arm[l] * velocity_[place_[l]];
    }
    speed_[g] = bends[g].speed + change;
  }
  int wrong = 0, cable = -1;
  double before = 0, wanted = 0;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    Bend& bend = bends[g];
    Part& part = parts_[g];
    if (bend.cable != cable)
      cable = bend.cable, before = wanted = std::max(BaseOf(w, cable), 1e-12);
    wanted = part.ratio * wanted - part.yield * speed_[g];
    part.better = bend.side;
    if (bend.side != 0) {
      bend.tension = part.ratio * before;
      if (bend.band > 0 && !bend.given && bend.side * speed_[g] > kSpeedError) part.better = 0;
    } else {
      bend.tension = std::clamp(wanted, before / bend.grown, before * bend.grown);
      const double error = kRelativeError * bend.tension;
      if (wanted < bend.tension - error) part.better = -1;
      if (wanted > bend.tension + error) part.better = 1;
    }
    bend.ratio = bend.tension / before;
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
