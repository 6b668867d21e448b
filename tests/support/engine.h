#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

namespace continuum::testing {

struct Delete {
  void operator()(mjSpec* s) const { mj_deleteSpec(s); }
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};
template <class T>
using Owned = std::unique_ptr<T, Delete>;

/// An unmodified MuJoCo with libmujoco_continuum.so loaded, as any user has it.
class Engine : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    mju_user_warning = [](const char*) {};
    static const bool once = (mj_loadPluginLibrary(CONTINUUM_PLUGIN), true);
    (void)once;
  }

  struct Compiled {
    Owned<mjModel> model;
    std::string error;  // the plugin's warning ends up here
  };
  static Compiled Compile(const std::string& xml) {
    char error[1000] = "";
    const Owned<mjSpec> spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
    if (!spec) return {nullptr, error};
    Owned<mjModel> model(mj_compile(spec.get(), nullptr));
    return {std::move(model), mjs_getError(spec.get())};
  }
  static Owned<mjModel> Model(const std::string& xml) {
    auto [model, error] = Compile(xml);
    EXPECT_TRUE(model) << error;
    return std::move(model);
  }
  static Owned<mjData> Data(const Owned<mjModel>& m) { return Owned<mjData>(mj_makeData(m.get())); }
  static void RunUntil(const Owned<mjModel>& m, const Owned<mjData>& d, double time) {
    while (d->time < time - 1e-9) mj_step(m.get(), d.get());
  }
  static std::vector<double> State(const Owned<mjModel>& m, const Owned<mjData>& d,
                                   int what = mjSTATE_INTEGRATION) {
    std::vector<double> state(mj_stateSize(m.get(), what));
    mj_getState(m.get(), d.get(), state.data(), what);
    return state;
  }
  static std::string Instance(const std::string& effect, const std::string& config) {
    return "<extension><plugin plugin=\"continuum." + effect + "\"><instance name=\"i\">" + config +
           "</instance></plugin></extension>";
  }
  static std::string Key(const std::string& key, const std::string& value) {
    return "<config key=\"" + key + "\" value=\"" + value + "\"/>";
  }
};

}  // namespace continuum::testing
