#include <algorithm>
#include <cmath>

#include "binding/cable_sliding.h"

// Bends that turn within the step: (5) of CableSliding.

namespace continuum {
namespace {

constexpr double kTurning = 5;  // slower bends obey (2) at the end of the step [v_c]

int SideBySpeed(const Bend& bend) { return bend.speed > 0 ? -1 : 1; }

bool MayTurn(const Bend& bend, double give_way) {
  return bend.side != SideBySpeed(bend) && std::abs(bend.speed) > kTurning * give_way &&
         !bend.fresh && bend.band > 0;
}

}  // namespace

void CableSliding::TurnWithinStep(const World& w, std::span<Bend> bends) {
  const auto may_turn = [&](const Bend& bend) { return MayTurn(bend, w.GiveWay()); };
  if (std::none_of(bends.begin(), bends.end(), may_turn)) return;
  turns_.resize(bends.size());
  std::transform(bends.begin(), bends.end(), turns_.begin(), may_turn);
  before_turns_.assign(bends.begin(), bends.end());
  const std::vector<bool> acting = rows_.Acting();
  const auto answer = answer_;
  if (SolveTurns(w, bends)) return;
  turn_.bends.clear();
  std::copy(before_turns_.begin(), before_turns_.end(), bends.begin());
  rows_.Act(acting);
  answer_ = answer, velocity_ = answer.velocity;
}

// All that may turn slide on their old side (+1) or the new one (−1), all the others as they must.
bool CableSliding::SettleForced(const World& w, std::span<Bend> bends, int way) {
  for (std::size_t g = 0; g < bends.size(); ++g) {
    if (!turns_[g]) continue;
    bends[g].side = way * SideBySpeed(bends[g]);
    bends[g].given = true;
  }
  return Settle(w, bends);
}

bool CableSliding::SolveTurns(const World& w, std::span<Bend> bends) {
  if (!SettleForced(w, bends, 1)) return false;
  kept_ = speed_;
  turn_ = {{bends.begin(), bends.end()}, give_way_, velocity_};
  if (!SettleForced(w, bends, -1)) return false;
  for (std::size_t g = 0; g < bends.size(); ++g) {
    if (!turns_[g]) continue;
    Bend& bend = bends[g];
    const double v = bend.speed, gained = speed_[g] - v;
    if (v * kept_[g] < 0 && v * gained < 0) {
      bend.turned = v / (v - kept_[g]);
    } else {
      bend.given = false, bend.side = before_turns_[g].side;
    }
  }
  return Settle(w, bends);
}

}  // namespace continuum
