// Every effect of the list on models that it may not be able to act on: either it acts, or it says
// why not. Nothing ends the search.
#include <dlfcn.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "binding/config.h"
#include "identification/candidates/candidate_generator.h"
#include "sim/experiment/measurement_model.h"
#include "support/actuators.h"
#include "support/law_suite.h"

namespace continuum {
namespace {

using ::testing::StartsWith;

// What a log of ten rows could say of a model: an angle, the position of a site, an input.
Experiment ExperimentFor(const std::string& actuator) {
  Experiment e;
  e.all_candidates = false;
  if (!actuator.empty()) e.inputs.push_back({"u", "1", actuator, "", false, ""});
  const std::vector<std::pair<std::string, std::string>> outputs{
      {"q", "rad"}, {"p[0]", "m"}, {"p[1]", "m"}, {"p[2]", "m"}};
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    Output out;
    out.columns = {outputs[i].first}, out.source = outputs[i].first, out.unit = outputs[i].second;
    e.outputs.push_back(out);
    e.channels.push_back({out.name(), out.unit, i, 0, 1});
  }
  Log log;
  for (int k = 0; k < 10; ++k) log.time.push_back(0.01 * k);
  log.input.assign(e.inputs.size(), std::vector<double>(10, 0.5));
  log.measured.assign(outputs.size(), std::vector<double>(10, 0.1));
  e.logs.push_back(log);
  return e;
}

// MuJoCo's own plugins lie beside its library.
bool LoadActuatorPlugins() {
  Dl_info info;
  if (!dladdr(reinterpret_cast<void*>(&mj_version), &info)) return false;
  const auto file =
      std::filesystem::path(info.dli_fname).parent_path() / "plugin" / "libactuator.so";
  if (!std::filesystem::exists(file)) return false;
  mj_loadPluginLibrary(file.c_str());
  return true;
}

struct Subject {
  std::string name;
  ModelSpec model;
  Experiment experiment;
};

std::string Replaced(std::string text, const std::map<std::string, std::string>& names) {
  for (const auto& [old, by] : names) {
    for (std::size_t at = 0; (at = text.find(old, at)) != text.npos; at += by.size())
      text.replace(at, old.size(), by);
  }
  return text;
}

// Names that mean something to a glob or to a list of names, and none at all.
std::vector<Subject> OddNames() {
  const std::string model = testing::ModelOf(testing::kActuatorKinds.front().xml);
  std::vector<Subject> all;
  for (const std::string odd : {"2nd %", "%[0]", "%*", "what%?", "\\%", "[%", "a  %b ", "%, %"}) {
    std::map<std::string, std::string> names;
    for (const std::string name : {"h", "s", "a", "tf", "ts", "one", "two", "three", "s3", "q"}) {
      const std::string by = Replaced(odd, {{"%", name}});
      for (const std::string key : {"name", "joint", "site"})
        names[key + "=\"" + name + "\""] = key + "=\"" + by + "\"";
      names["objname=\"" + name + "\""] = "objname=\"" + by + "\"";
    }
    Subject subject{odd, ModelSpec::Parse(Replaced(model, names)),
                    ExperimentFor(Replaced(odd, {{"%", "a"}}))};
    Output& angle = subject.experiment.outputs.front();
    angle.columns = {Replaced(odd, {{"%", "q"}})}, angle.source = angle.name();
    all.push_back(std::move(subject));
  }
  return all;
}

constexpr const char* kNoNames =
    R"(<body><joint/><geom size=".1"/><site/><body pos="1 0 0"><joint type="slide"/><geom size=".1"/>
    </body></body>)";

// A world in which nothing has a name but what is measured.
std::string Still(const std::string& bodies) {
  return "<mujoco><worldbody><site name=\"x\"/>" + bodies +
         "</worldbody><sensor><framepos name=\"p\" objtype=\"site\" objname=\"x\"/>"
         "<clock name=\"q\"/></sensor></mujoco>";
}

const std::vector<Subject>& Subjects() {
  static const std::vector<Subject> all = [] {
    std::vector<Subject> subjects = OddNames();
    for (const auto& [kind, xml] : testing::kActuatorKinds) {
      const std::string model = testing::ModelOf(xml);
      subjects.push_back({std::string(kind), ModelSpec::Parse(model), ExperimentFor("a")});
    }
    const auto& [motor, affine] =
        std::pair{testing::kActuatorKinds[0], testing::kActuatorKinds[18]};
    const std::string two = Replaced(std::string(affine.xml), {{"\"a\"", "\"c\""}});
    Subject mixed{"one that can and one that cannot",
                  ModelSpec::Parse(testing::ModelOf(std::string(motor.xml) + two)),
                  ExperimentFor("a")};
    mixed.experiment.inputs.push_back({"v", "1", "c", "", false, ""});
    mixed.experiment.logs[0].input.emplace_back(10, 0.5);
    subjects.push_back(std::move(mixed));
    for (const auto& [name, world] : {std::pair{"no names", kNoNames}, {"nothing moves", ""}})
      subjects.push_back({name, ModelSpec::Parse(Still(world)), ExperimentFor("")});
    if (LoadActuatorPlugins()) {
      const std::string pid =
          "<extension><plugin plugin=\"mujoco.pid\"><instance name=\"pid\"><config key=\"kp\" "
          "value=\"5\"/><config key=\"kd\" value=\".1\"/></instance></plugin></extension>";
      subjects.push_back(
          {"plugin",
           ModelSpec::Parse(testing::ModelOf(
               "<plugin name=\"a\" joint=\"h\" plugin=\"mujoco.pid\" instance=\"pid\"/>", pid)),
           ExperimentFor("a")});
    }
    return subjects;
  }();
  return all;
}

// Whether its model compiles at a start and stays finite over some steps.
void ExpectSteps(const Hypothesis& h, const std::vector<double>& start) {
  std::vector<Change> changes;
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    const Parameter& p = h.extra[i];
    if (!IsMeasurement(p.target, p.attribute))
      changes.push_back({p.target, p.attribute, start[i], p.operation});
  }
  ASSERT_NO_THROW({
    const ModelAndData built = h.system.Build(changes);
    for (int k = 0; k < 5; ++k) mj_step(built.model.get(), built.data.get());
    for (int i = 0; i < built.model->nq; ++i) EXPECT_TRUE(std::isfinite(built.data->qpos[i]));
  });
}

std::vector<Hypothesis> Ask(const Subject& subject, const std::string& effect, SearchScope scope,
                            std::vector<std::string>& skipped) {
  Experiment e = subject.experiment;
  e.candidates = {{effect, "", false}};
  return MakeCandidates(e, {&subject.model}, {}, skipped, scope);
}

void ExpectActsOrSaysWhyNot(const Subject& subject, const std::string& effect, SearchScope scope) {
  SCOPED_TRACE(subject.name);
  std::vector<std::string> skipped;
  const auto found = Ask(subject, effect, scope, skipped);
  if (scope == SearchScope::kFew) {
    EXPECT_NE(found.size() + skipped.size(), 0u);
  }
  for (const std::string& why : skipped) EXPECT_THAT(why, StartsWith(effect));
  for (const Hypothesis& h : found) {
    SCOPED_TRACE(h.NameAtPlace());
    ExpectSteps(h, h.starts.front());
    ExpectSteps(h, h.starts.back());
  }
}

// The number of outputs that a parameter of the measurement changes.
std::size_t Changed(const Parameter& p, Experiment e) {
  const std::vector<Output> before = e.outputs;
  ApplyMeasurement(e, {p.target, p.attribute, 0.123, Change::Operation::kSet});
  std::size_t count = 0;
  for (std::size_t o = 0; o < before.size(); ++o)
    count += !(e.outputs[o].measurement == before[o].measurement);
  return count;
}

void ExpectActsOn(const Hypothesis& h, const Experiment& e) {
  if (h.objects.empty() || h.place == Place::kWorld) return;
  SCOPED_TRACE(h.NameAtPlace());
  for (const Parameter& p : h.extra) {
    if (IsMeasurement(p.target, p.attribute)) {
      const std::size_t components = p.attribute == "angle" ? 3 : 1;
      EXPECT_EQ(Changed(p, e), components * h.objects.size());
    } else if (!p.target.starts_with("plugin:")) {
      EXPECT_EQ(h.system.Named(p.target).size(), h.objects.size());
    }
  }
  if (h.instance.effect.empty()) return;
  const mjModel& m = h.system.model();
  const int id = mj_name2id(&m, mjOBJ_PLUGIN, h.instance.name.c_str());
  EXPECT_EQ(Config(m, id).Match(h.place).size(), h.objects.size());
}

template <class E>
struct EveryCandidate : ::testing::Test {};
TYPED_TEST_SUITE(EveryCandidate, All::Into<testing::Types>, testing::EffectName);

TYPED_TEST(EveryCandidate, ActsOnAModelOrSaysWhyNot) {
  for (const Subject& subject : Subjects()) {
    for (const SearchScope scope : {SearchScope::kFew, SearchScope::kOthers})
      ExpectActsOrSaysWhyNot(subject, std::string(TypeParam::kName), scope);
  }
}

// Whatever characters the names have.
TYPED_TEST(EveryCandidate, ActsOnItsObjectsAndOnNoOthers) {
  for (const Subject& subject : OddNames()) {
    SCOPED_TRACE(subject.name);
    std::vector<std::string> skipped;
    const std::string effect(TypeParam::kName);
    for (const Hypothesis& h : Ask(subject, effect, SearchScope::kFew, skipped))
      ExpectActsOn(h, subject.experiment);
  }
}

}  // namespace
}  // namespace continuum
