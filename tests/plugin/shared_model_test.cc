// Several mjData of one model at a time: in threads, in batches, restored from bytes.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "support/cable_arm.h"
#include "support/engine.h"
#include "support/every_law.h"

namespace continuum {
namespace {

using States = std::vector<double>;

class SharedModel : public testing::Engine {
 protected:
  using Driver = void (*)(const mjModel*, mjData*, int steps);

  static States End(const mjModel* m, Driver drive, int steps) {
    const testing::Owned<mjData> d(mj_makeData(m));
    drive(m, d.get(), steps);
    States end(mj_stateSize(m, mjSTATE_INTEGRATION));
    mj_getState(m, d.get(), end.data(), mjSTATE_INTEGRATION);
    end.insert(end.end(), d->sensordata, d->sensordata + m->nsensordata);
    return end;
  }
  // Two threads make, run and delete data of their own all the while: some of each is alive while
  // the other makes or deletes some.
  static void ExpectSameInThreads(const mjModel* m, Driver drive, int steps) {
    const States alone = End(m, drive, steps);
    std::atomic<int> waiting = 2;
    std::vector<States> ends[2];
    const auto work = [&](int thread) {
      for (--waiting; waiting > 0;) std::this_thread::yield();
      for (int k = 0; k < 4; ++k) ends[thread].push_back(End(m, drive, steps + k % 2));
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    EXPECT_EQ(ends[0], ends[1]);
    for (int k = 0; k < 4; k += 2) EXPECT_EQ(ends[0][k], alone);
  }
  static void Pull(const mjModel* m, mjData* d, int steps) {
    for (int k = 0; k < steps; ++k) {
      for (int u = 0; u < m->nu; ++u) {
        const double most = m->actuator_ctrllimited[u] ? m->actuator_ctrlrange[2 * u + 1] : 4;
        d->ctrl[u] = most * (.2 + .1 * std::sin(6 * d->time + u));
      }
      mj_step(m, d);
    }
  }
};

class EveryLawShared : public SharedModel,
                       public ::testing::WithParamInterface<std::tuple<std::string, std::string>> {
 protected:
  static testing::Owned<mjModel> Build() {
    const auto& [law, integrator] = GetParam();
    return Model(testing::Arm(testing::EffectOf(law), testing::Laws().at(law),
                              "integrator=\"" + integrator + "\""));
  }
};
std::vector<std::tuple<std::string, std::string>> Cases() {
  std::vector<std::tuple<std::string, std::string>> all;
  for (const auto& [law, config] : testing::Laws()) {
    for (const char* integrator : {"RK4", "implicitfast", "discrete"})
      all.emplace_back(law, integrator);
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(All, EveryLawShared, ::testing::ValuesIn(Cases()), [](const auto& info) {
  std::string name = std::get<0>(info.param) + "_" + std::get<1>(info.param);
  for (char& c : name) c = c == '.' ? '_' : c;
  return name;
});

TEST_P(EveryLawShared, ThreadsWithDataOfTheirOwnAgreeBitByBit) {
  const auto m = Build();
  ExpectSameInThreads(m.get(), &testing::Drive, 150);
}

// As pickle.loads of Python does: the states and the bytes of plugin_data of another mjData, which
// may be gone, or have lived in another process.
TEST_P(EveryLawShared, BytesOfAnotherDataLeaveEachItsOwnInstances) {
  const auto m = Build();
  auto a = Data(m);
  const auto kept = Data(m);
  testing::Drive(m.get(), a.get(), 100);
  const auto saved = State(m, a);
  const std::vector<std::uintptr_t> numbers(a->plugin_data, a->plugin_data + m->nplugin);
  const auto restore = [&](const std::function<std::uintptr_t(int)>& number) {
    auto d = Data(m);
    mj_setState(m.get(), d.get(), saved.data(), mjSTATE_INTEGRATION);
    for (int i = 0; i < m->nplugin; ++i) d->plugin_data[i] = number(i);
    return d;
  };
  auto same = restore([&](int i) { return numbers[i]; });
  auto after = restore([&](int i) { return numbers[i]; });
  auto untouched = restore([&](int i) { return numbers[i]; });
  auto address = restore([](int) { return std::uintptr_t{0x7f0012345678}; });
  auto huge = restore([](int) { return ~std::uintptr_t{0}; });
  auto small = restore([](int i) { return static_cast<std::uintptr_t>(1 + i); });
  testing::Drive(m.get(), same.get(), 100);
  testing::Drive(m.get(), a.get(), 100);
  const auto end = State(m, a);
  a.reset();
  untouched.reset();
  const auto taken = Data(m);  // may get the numbers that a had
  for (mjData* d : {after.get(), address.get(), huge.get(), small.get()}) {
    testing::Drive(m.get(), d, 100);
    States now(end.size());
    mj_getState(m.get(), d, now.data(), mjSTATE_INTEGRATION);
    EXPECT_EQ(now, end);
  }
  EXPECT_EQ(State(m, same), end);
  testing::Drive(m.get(), kept.get(), 200);
  testing::Drive(m.get(), taken.get(), 200);
  EXPECT_EQ(State(m, kept), end);
  EXPECT_EQ(State(m, taken), end);
}

TEST_P(EveryLawShared, CopiesOfDataRestoredFromBytesRunOn) {
  const auto m = Build();
  const auto a = Data(m), b = Data(m);
  testing::Drive(m.get(), a.get(), 100);
  const auto saved = State(m, a);
  mj_setState(m.get(), b.get(), saved.data(), mjSTATE_INTEGRATION);
  std::copy_n(a->plugin_data, m->nplugin, b->plugin_data);
  const testing::Owned<mjData> c(mj_copyData(nullptr, m.get(), b.get()));
  for (mjData* d : {a.get(), b.get(), c.get()}) testing::Drive(m.get(), d, 100);
  EXPECT_EQ(State(m, b), State(m, a));
  EXPECT_EQ(State(m, c), State(m, a));
}

class RobotShared : public SharedModel, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, RobotShared,
                         ::testing::Values("annelida/annelida", "spa/spa", "spa/spa_series",
                                           "tdcr/tdcr_disks", "stiff_flop/stiff_flop",
                                           "servo_pendulum/servo_pendulum", "twin_pivot/a"),
                         [](const auto& info) {
                           const std::string path = info.param;
                           return path.substr(path.find('/') + 1);
                         });

TEST_P(RobotShared, ThreadsWithDataOfTheirOwnAgreeBitByBit) {
  char error[1000] = "";
  const testing::Owned<mjModel> m(
      mj_loadXML((std::string(CONTINUUM_SOURCE "/models/") + GetParam() + ".xml").c_str(), nullptr,
                 error, sizeof error));
  ASSERT_TRUE(m) << error;
  ASSERT_GT(m->nplugin, 0);
  ExpectSameInThreads(m.get(), &Pull, 60);
}

TEST_F(SharedModel, ThreadsWithContactsOfSeveralCablesAgreeBitByBit) {
  testing::CableArm arm;
  arm.twisted = true;
  arm.bearings = {0, 2.1, 4.2};
  for (const char* law : {"exponential", "coulomb"}) {
    arm.law = law;
    const auto m = Model(arm.Mjcf("implicitfast"));
    ExpectSameInThreads(m.get(), &Pull, 100);
  }
}

}  // namespace
}  // namespace continuum
