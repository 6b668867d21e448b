#include "models/annelida/pipe.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/film/film_recipe.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

// The arm in the pipe under the inputs of its film.
class AnnelidaPipe : public ::testing::Test {
 protected:
  void Step() {
    const Log& log = clip_.experiment.logs.front();
    const double t = std::min(now_, log.time.back());
    const auto row = std::lower_bound(log.time.begin(), log.time.end(), t) - log.time.begin();
    for (std::size_t k = 0; k < log.input.size(); ++k) {
      const std::string& name = clip_.experiment.inputs[k].actuator;
      d_->ctrl[mj_name2id(m_, mjOBJ_ACTUATOR, name.c_str())] = log.input[k][row];
    }
    mj_step(m_, d_);
  }
  // From the axis of the pipe to the middle of a link [m].
  double FromAxis(int link) const {
    const double* const x = d_->geom_xpos + 3 * Ball(link);
    if (x[2] > -pipe_.drop) return std::hypot(x[0], x[1]);
    if (x[0] > pipe_.bend) return std::hypot(x[1], x[2] + pipe_.drop + pipe_.bend);
    return std::hypot(std::hypot(x[0] - pipe_.bend, x[2] + pipe_.drop) - pipe_.bend, x[1]);
  }
  int Ball(int link) const {
    const int body = mj_name2id(m_, mjOBJ_BODY, ("link" + std::to_string(link)).c_str());
    int geom = m_->body_geomadr[body];
    while (m_->geom_contype[geom] == 0) ++geom;
    return geom;
  }
  double Radius() const { return m_->geom_size[3 * Ball(1)]; }
  int Warnings() const {
    return std::accumulate(d_->warning, d_->warning + mjNWARNING, 0,
                           [](int sum, const mjWarningStat& w) { return sum + w.number; });
  }

  const Pipe pipe_;
  const Clip clip_ = Clip::Read(CONTINUUM_SOURCE "/renders/annelida_pipe.yaml");
  ModelAndData arm_ = ModelSpec::Load(clip_.experiment.model).Build();
  const mjModel* const m_ = arm_.model.get();
  mjData* const d_ = arm_.data.get();
  double now_ = 0;  // of the inputs
};

// A ring of twelve flat staves reaches 1/cos 15° as far in its corners.
TEST_F(AnnelidaPipe, StaysInsideThePipeOnItsWay) {
  const double room = (pipe_.inner - Radius()) / std::cos(M_PI / pipe_.staves);
  double deepest = 0;
  int touching = 0;
  while (d_->time < clip_.experiment.logs.front().time.back()) {
    now_ = d_->time;
    Step();
    for (int c = 0; c < d_->ncon; ++c) {
      mjtNum force[6];
      mj_contactForce(m_, d_, c, force);
      ASSERT_TRUE(std::isfinite(force[0]) && force[0] < 100) << d_->time << " " << force[0];
      deepest = std::max(deepest, -d_->contact[c].dist);
    }
    touching += d_->ncon > 0;
    for (int link = 1; link <= kAnnelidaLinks; ++link) {
      if (d_->geom_xpos[3 * Ball(link) + 2] > 0) continue;  // above the mouth
      ASSERT_LT(FromAxis(link), room + 1e-3) << link << " at " << d_->time;
    }
  }
  EXPECT_LT(deepest, 1e-3);
  EXPECT_GT(touching, 3000);  // of 7000 steps
  EXPECT_EQ(Warnings(), 0);
  EXPECT_GT(d_->site_xpos[3 * mj_name2id(m_, mjOBJ_SITE, "tip")], 0.16);  // it came out
}

// Wherever the way stops: steered into the elbow, held, its tension halved, to both sides, let go.
TEST_F(AnnelidaPipe, IsAtRestWhereverItStops) {
  for (const double stop : {2.0, 3.5, 5.0, 7.0, 9.5, 11.5, 13.0}) {
    mj_resetData(m_, d_);
    std::vector<double> held;
    while (d_->time < stop + 13) {
      now_ = std::min(d_->time, stop);
      Step();
      if (d_->time < stop + 3) continue;
      if (held.empty()) held.assign(d_->qpos, d_->qpos + m_->nq);
      for (int i = 0; i < m_->nq; ++i) ASSERT_NEAR(d_->qpos[i], held[i], 1e-6) << stop << " " << i;
    }
    EXPECT_EQ(Warnings(), 0);
  }
}

}  // namespace
}  // namespace continuum
