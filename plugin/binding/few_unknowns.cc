#include "binding/few_unknowns.h"

#include <algorithm>
#include <limits>

#include "binding/linear_solver.h"

namespace continuum {
namespace {

constexpr int kNobody = std::numeric_limits<int>::max();

// to += f x, four side by side.
inline void AddFour(double f, const double* x, double* to) {
  for (int c = 0; c < 4; ++c) to[c] += f * x[c];
}

// Calls visit(place, arm) for each joint of the island that a segment depends on.
template <class Visit>
void ForEachArm(const FewUnknowns::World& w, int begin, int end, Visit&& visit) {
  for (int l = w.route.begin[begin]; l < w.route.begin[end]; ++l)
    visit(w.islands.place(l), w.route.arm[l]);
}

// The same of a damper.
template <class Visit>
void ForEachArm(const FewUnknowns::World& w, const StepDamping::Term& term, Visit&& visit) {
  const StepInertia& inertia = w.islands.inertia(w.island);
  for (std::size_t k = 0; k < term.dof.size(); ++k) {
    const int place = inertia.index(term.dof[k]);
    if (place >= 0) visit(place, term.J[k]);
  }
}

}  // namespace

void FewUnknowns::Begin(const World& w, std::span<const Bend> bends) {
  w.islands.articulated(w.island).Update(w.m, w.d, w.damping.joint);
  measured_ = 0, known_.assign(bends.size(), false);
  unknown_.resize(bends.size()), constant_.resize(bends.size());
  dampers_.clear(), resisting_.clear();
  const StepInertia& inertia = w.islands.inertia(w.island);
  for (std::size_t t = 0; t < w.damping.terms.size(); ++t) {
    const auto& dofs = w.damping.terms[t].dof;
    const auto here = [&](int dof) { return inertia.index(dof) >= 0; };
    if (std::none_of(dofs.begin(), dofs.end(), here)) continue;
    dampers_.push_back(static_cast<int>(t)), resisting_.push_back(~static_cast<int>(t));
  }
  MeasureAll(w, bends);
}

void FewUnknowns::MeasureAll(const World& w, std::span<const Bend> bends) {
  const std::span<const int> all = resisting_;
  for (std::size_t k = 0; k < all.size(); k += 4)
    Measure(w, bends, all.subspan(k, std::min<std::size_t>(4, all.size() - k)));
}

// z of up to four that resist.
void FewUnknowns::Measure(const World& w, std::span<const Bend> bends,
                          std::span<const int> resisting) {
  if (measured_ == measures_.size()) measures_.emplace_back();
  Measures& measures = measures_[measured_++];
  const std::vector<int>& dofs = w.islands.inertia(w.island).dofs();
  std::fill_n(measures.what, 4, kNobody), std::fill_n(measures.by_force, 4, 0.0);
  measures.change.assign(4 * dofs.size(), 0), measures.along.assign(4 * bends.size(), 0);
  double* const z = measures.change.data();
  for (std::size_t c = 0; c < resisting.size(); ++c) {
    measures.what[c] = resisting[c];
    if (resisting[c] >= 0) known_[resisting[c]] = true;
    PutPath(w, bends, resisting[c], z + c);
  }
  w.islands.articulated(w.island).SolveFour(z);
  for (std::size_t i = 0; i < dofs.size(); ++i)
    AddFour(w.force[dofs[i]], z + 4 * i, measures.by_force);
  for (std::size_t g = 0; g < bends.size(); ++g) {
    ForEachArm(w, bends[g].segment, bends[g].segment + 1, [&](int place, double arm) {
      AddFour(arm, z + 4 * place, measures.along.data() + 4 * g);
    });
  }
}

// c of (1), one number in four.
void FewUnknowns::PutPath(const World& w, std::span<const Bend> bends, int what, double* c) const {
  if (what < 0) {
    ForEachArm(w, w.damping.terms[~what], [&](int place, double arm) { c[4 * place] += arm; });
    return;
  }
  const Bend& bend = bends[what];
  ForEachArm(w, bend.segment, w.route.first[bend.cable + 1],
             [&](int place, double arm) { c[4 * place] -= arm; });
}

// The unknowns, and what is known without them.
void FewUnknowns::Number(const World& w, std::span<const Bend> bends, std::span<const Part> parts) {
  rests_ = 0;
  resisting_.clear(), ends_.clear();
  double tension = 0;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    if (IsFirst(bends, g)) tension = w.base[bends[g].cable];
    constant_[g] = tension = parts[g].ratio * tension - parts[g].yield * bends[g].speed;
    unknown_[g] = bends[g].side == 0 ? rests_++ : -1;
    if (bends[g].side == 0 && !known_[g]) resisting_.push_back(static_cast<int>(g));
    if (IsLast(bends, g) && w.islands.end(bends[g].cable) >= 0)
      ends_.push_back(static_cast<int>(g));
  }
  const std::size_t all = rests_ + dampers_.size() + ends_.size();
  matrix_.assign(all * all, 0), p_.assign(all, 0);
}

FewUnknowns::Rows FewUnknowns::RowsOf(const World& w, std::span<const Part> parts,
                                      const Measures& measures) const {
  Rows rows{{-1, -1, -1, -1}, {}};
  for (int c = 0; c < 4; ++c) {
    const int what = measures.what[c];
    if (what == kNobody) continue;
    if (what < 0) {
      const auto at = std::find(dampers_.begin(), dampers_.end(), ~what) - dampers_.begin();
      rows.at[c] = rests_ + static_cast<int>(at), rows.yield[c] = w.damping.terms[~what].scale;
    } else if (unknown_[what] >= 0) {
      rows.at[c] = unknown_[what], rows.yield[c] = parts[what].yield;
    }
  }
  return rows;
}

void FewUnknowns::Fill(const Rows& rows, int column, const double* by, double scale) {
  for (int c = 0; c < 4; ++c) {
    if (rows.at[c] >= 0) matrix_[rows.at[c] * p_.size() + column] += scale * rows.yield[c] * by[c];
  }
}

// (2)
void FewUnknowns::FillRows(const World& w, std::span<const Bend> bends, std::span<const Part> parts,
                           const Measures& measures) {
  const Rows rows = RowsOf(w, parts, measures);
  if (std::all_of(rows.at, rows.at + 4, [](int row) { return row < 0; })) return;
  const double h = w.m.opt.timestep;
  double load[4] = {}, behind[4] = {};  // z · (all tensions with p = 0), z · w_g
  for (std::size_t g = bends.size(); g-- > 0;) {
    const double* const along = measures.along.data() + 4 * g;
    const double more = IsLast(bends, g) ? 0 : parts[g + 1].ratio;
    for (int c = 0; c < 4; ++c) behind[c] = along[c] + more * behind[c];
    AddFour(constant_[g] - w.base[bends[g].cable], along, load);
    if (unknown_[g] >= 0) Fill(rows, unknown_[g], behind, -h);
  }
  FillDampers(w, measures, rows);
  const auto ends = static_cast<int>(ends_.size()), n = static_cast<int>(p_.size());
  for (int c = 0; c < 4; ++c) {
    if (rows.at[c] < 0) continue;
    double* const row = matrix_.data() + rows.at[c] * n;
    row[rows.at[c]] += 1;
    p_[rows.at[c]] = h * rows.yield[c] * (measures.by_force[c] - load[c]);
    for (int e = 0; e < ends && measures.what[c] >= 0; ++e) {
      if (bends[measures.what[c]].cable == bends[ends_[e]].cable)
        row[n - ends + e] = -rows.yield[c];
    }
  }
}

void FewUnknowns::FillDampers(const World& w, const Measures& measures, const Rows& rows) {
  for (std::size_t t = 0; t < dampers_.size(); ++t) {
    double by[4] = {};
    ForEachArm(w, w.damping.terms[dampers_[t]], [&](int place, double arm) {
      AddFour(arm, measures.change.data() + 4 * place, by);
    });
    Fill(rows, rests_ + static_cast<int>(t), by, 1);
  }
}

// (3)
void FewUnknowns::FillEnd(const World& w, std::span<const Bend> bends, std::span<const Part> parts,
                          int e) {
  const auto n = static_cast<int>(p_.size());
  const int at = n - static_cast<int>(ends_.size()) + e, last = ends_[e];
  double* const row = matrix_.data() + at * n;
  row[at] = StepInertia::kEndDrag;
  p_[at] = constant_[last] - w.base[bends[last].cable];
  double behind = 1;
  for (int g = last; g >= 0 && bends[g].cable == bends[last].cable; --g) {
    if (unknown_[g] >= 0) row[unknown_[g]] = behind;
    behind *= parts[g].ratio;
  }
}

// The right-hand side of (1) with all p.
void FewUnknowns::Push(const World& w, std::span<const Bend> bends, std::span<Part> parts,
                       std::span<double> x) const {
  const double h = w.m.opt.timestep;
  const std::vector<int>& dofs = w.islands.inertia(w.island).dofs();
  for (std::size_t i = 0; i < dofs.size(); ++i) x[i] = h * w.force[dofs[i]];
  double tension = 0;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    const double base = w.base[bends[g].cable];
    if (IsFirst(bends, g)) tension = base;
    Part& part = parts[g];
    if (unknown_[g] >= 0) part.drop = p_[unknown_[g]];
    tension = part.ratio * tension - part.yield * bends[g].speed - part.drop;
    ForEachArm(w, bends[g].segment, bends[g].segment + 1,
               [&](int place, double arm) { x[place] += h * (base - tension) * arm; });
  }
  for (std::size_t t = 0; t < dampers_.size(); ++t) {
    const double p = p_[rests_ + t];
    ForEachArm(w, w.damping.terms[dampers_[t]],
               [&](int place, double arm) { x[place] -= p * arm; });
  }
}

void FewUnknowns::Solve(const World& w, std::span<const Bend> bends, std::span<Part> parts,
                        std::span<double> x) {
  Number(w, bends, parts);
  MeasureAll(w, bends);
  for (std::size_t k = 0; k < measured_ && !p_.empty(); ++k)
    FillRows(w, bends, parts, measures_[k]);
  for (std::size_t e = 0; e < ends_.size(); ++e) FillEnd(w, bends, parts, static_cast<int>(e));
  if (!p_.empty()) SolveLinear(matrix_, p_);
  Push(w, bends, parts, x);
  w.islands.articulated(w.island).Solve(x.data());
  std::fill(x.begin() + std::ssize(w.islands.inertia(w.island).dofs()), x.end(), 0.0);
  for (std::size_t e = 0; e < ends_.size(); ++e)
    x[w.islands.end(bends[ends_[e]].cable)] = p_[p_.size() - ends_.size() + e];
}

}  // namespace continuum
