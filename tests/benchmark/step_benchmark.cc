// A step with our effects against the same step without, alternating in one run.
#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <chrono>
#include <memory>
#include <string>
#include <tuple>

#include "engine.h"
#include "models/spa/chain.h"

namespace continuum {
namespace {

struct Model {
  mjModel* m;
  mjData* d;
  explicit Model(const std::string& xml) {
    char error[1000] = "";
    mjSpec* const spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error);
    m = spec ? mj_compile(spec, nullptr) : nullptr;
    if (!m) mju_error("%s %s", error, spec ? mjs_getError(spec) : "");
    mj_deleteSpec(spec);
    d = mj_makeData(m);
  }
  ~Model() {
    mj_deleteData(d);
    mj_deleteModel(m);
  }
  double Steps(int n) {
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < n; ++k) {
      for (int a = 0; a < m->nu; ++a) d->ctrl[a] = 2 + std::sin(3 * d->time + a);
      mj_step(m, d);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
};

// A chain of 20 hinges, with four cables of ten contacts each.
std::string Chain(const std::string& extension, const std::string& joint) {
  std::string bodies, close, cables;
  for (int c = 0; c < 4; ++c) {
    const std::string xy = c == 0 ? ".03 0" : c == 1 ? "0 .03" : c == 2 ? "-.03 0" : "0 -.03";
    bodies += "<site name=\"s" + std::to_string(c) + "_0\" pos=\"" + xy + " .02\"/>";
  }
  for (int i = 1; i <= 20; ++i) {
    bodies += "<body pos=\"0 0 " + std::string(i == 1 ? "0" : "-.03") + "\"><joint name=\"j" +
              std::to_string(i) + "\" axis=\"" + (i % 2 ? "1 0 0" : "0 1 0") +
              "\" stiffness=\"1\" damping=\".02\" " + joint +
              "/><geom type=\"capsule\" size=\".01\" fromto=\"0 0 0 0 0 -.03\" mass=\".05\" "
              "contype=\"0\" conaffinity=\"0\"/>";
    if (i % 2 == 0) {
      const int contact = i / 2;
      const char* const xy[] = {".03 0", "0 .03", "-.03 0", "0 -.03"};
      for (int c = 0; c < 4; ++c) {
        bodies += "<site name=\"s" + std::to_string(c) + "_" + std::to_string(contact) +
                  "\" pos=\"" + xy[c] + " -.01\"/>";
        if (contact == 10) {
          bodies += "<site name=\"s" + std::to_string(c) + "_11\" pos=\"" + xy[c] + " -.025\"/>";
        }
      }
    }
    close += "</body>";
  }
  for (int c = 0; c < 4; ++c) {
    cables += "<spatial name=\"cable" + std::to_string(c) + "\">";
    for (int k = 0; k <= 11; ++k)
      cables += "<site site=\"s" + std::to_string(c) + "_" + std::to_string(k) + "\"/>";
    cables += "</spatial>";
  }
  std::string actuators;
  for (int c = 0; c < 4; ++c)
    actuators += "<motor tendon=\"cable" + std::to_string(c) + "\" gear=\"-1\"/>";
  return "<mujoco><option timestep=\".001\" integrator=\"implicitfast\"/>" + extension +
         "<worldbody>" + bodies + close + "</worldbody><tendon>" + cables + "</tendon><actuator>" +
         actuators + "</actuator></mujoco>";
}

std::string Instance(const std::string& effect, const std::string& config) {
  return "<extension><plugin plugin=\"continuum." + effect + "\"><instance name=\"i\">" + config +
         "</instance></plugin></extension>";
}

void Compare(benchmark::State& state, const std::string& with, const std::string& without) {
  Model a(with), b(without);
  a.Steps(500), b.Steps(500);
  double ours = 0, plain = 0, steps = 0;
  for (auto _ : state) {
    ours += a.Steps(100);
    plain += b.Steps(100);
    steps += 100;
  }
  state.counters["with_us"] = 1e6 * ours / steps;
  state.counters["without_us"] = 1e6 * plain / steps;
  state.counters["ratio"] = ours / plain;
}

void CableFriction(benchmark::State& state) {
  Compare(
      state,
      Chain(Instance("capstan",
                     "<config key=\"tendon\" value=\"cable*\"/><config key=\"mu\" value=\".15\"/>"),
            ""),
      Chain("", ""));
}
BENCHMARK(CableFriction);

void JointFrictionRows(benchmark::State& state) {
  Compare(state,
          Chain(Instance("stribeck",
                         "<config key=\"joint\" value=\"j*\"/><config key=\"tau_mu\" value=\"0\"/>"
                         "<config key=\"tau_c\" value=\".01\"/>"),
                ""),
          Chain("", "frictionloss=\".01\""));
}
BENCHMARK(JointFrictionRows);

// Without the tags from `begin` to `end`.
std::string Less(std::string xml, const std::string& begin, const std::string& end) {
  for (std::size_t from = 0; (from = xml.find(begin, from)) != xml.npos;) {
    xml.erase(from, xml.find(end, from) + end.size() - from);
  }
  return xml;
}

SpaFile Actuator() { return ReadSpa(std::string(CONTINUUM_SOURCE) + "/models/spa/spa.yaml"); }

// The same chain with the linear part of the law as native springs and dampers of the joints. Sums
// over the shares of the links: N of the stretch, N − 1/2 of the bend.
std::string WithNativeSprings(std::string xml, const SpaParameters<double>& p, int links) {
  xml = Less(Less(xml, "<extension>", "</extension>"), "<plugin ", "/>");
  const double bend = p.d * p.d * links * links / (links - 0.5);
  for (const auto& [joint, k, d] : {std::tuple{"bend", bend * p.k_theta, bend * p.d_theta},
                                    {"stretch", links * p.k_dL1, links * p.d_dL}}) {
    const std::string tag = std::string("<joint name=\"") + joint;
    const std::string springs =
        " stiffness=\"" + std::to_string(k) + "\" damping=\"" + std::to_string(d) + "\"";
    for (std::size_t at = 0; (at = xml.find(tag, at)) != xml.npos; at += tag.size()) {
      xml.insert(at + 6, springs);
    }
  }
  return xml;
}

void SoftActuator(benchmark::State& state) {
  const SpaFile spa = Actuator();
  Compare(state, SpaMjcf(spa), WithNativeSprings(SpaMjcf(spa), spa.parameters, 10));
}
BENCHMARK(SoftActuator);

// Simulated seconds per second.
void TenSoftActuators(benchmark::State& state) {
  Model ten(SpaMjcf(Actuator(), {.row = 10}));
  double simulated = 0, taken = 0;
  for (auto _ : state) {
    taken += ten.Steps(100);
    simulated += 100 * ten.m->opt.timestep;
  }
  state.counters["real_time_factor"] = simulated / taken;
}
BENCHMARK(TenSoftActuators);

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) {
  continuum::RegisterEffects();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
