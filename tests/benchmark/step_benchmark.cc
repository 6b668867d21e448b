// A step with our effects against the same step without, alternating in one run.
#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <time.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine.h"
#include "models/annelida/annelida.h"
#include "models/annelida/pipe.h"
#include "models/spa/chain.h"

namespace continuum {
namespace {

// Of the process, which other work on the machine does not lengthen.
double CpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

struct Model {
  mjModel* m;
  mjData* d;
  double level = 1;  // of the controls
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
    const double begin = CpuSeconds();
    for (int k = 0; k < n; ++k) {
      for (int a = 0; a < m->nu; ++a) d->ctrl[a] = level * (2 + std::sin(3 * d->time + a));
      mj_step(m, d);
    }
    return CpuSeconds() - begin;
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

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Medians over blocks of steps that alternate: a block that something disturbed does not count.
void Compare(benchmark::State& state, const std::string& with, const std::string& without,
             int block = 100, double level = 1) {
  Model a(with), b(without);
  a.level = b.level = level;
  a.Steps(3 * block), b.Steps(3 * block);
  std::vector<double> ours, plain;
  for (auto _ : state) {
    ours.push_back(a.Steps(block) / block);
    plain.push_back(b.Steps(block) / block);
  }
  state.counters["with_us"] = 1e6 * Median(ours);
  state.counters["without_us"] = 1e6 * Median(plain);
  state.counters["ratio"] = Median(ours) / Median(plain);
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

// The snake arm with both its frictions, all cables moving, and the same with native friction rows.
void SnakeArm(benchmark::State& state) {
  const std::string with =
      AnnelidaMjcf(ReadAnnelida(std::string(CONTINUUM_SOURCE) + "/models/annelida/annelida.yaml"));
  std::string without = Less(Less(with, "<extension>", "</extension>"), "<plugin ", "/>");
  for (std::size_t at = 0; (at = without.find("<joint name=\"bend", at)) != without.npos;)
    without.insert(at += 7, "frictionloss=\".0413\" damping=\".0314\" ");
  Compare(state, with, without, 50, 4);
}
BENCHMARK(SnakeArm);

std::string InPipe(bool friction, bool contact) {
  std::string xml = AnnelidaInPipeMjcf(
      ReadAnnelida(std::string(CONTINUUM_SOURCE) + "/models/annelida/annelida.yaml"));
  if (!friction) xml = Less(Less(xml, "<extension>", "</extension>"), "<plugin ", "/>");
  if (!contact) xml.insert(xml.find("<worldbody>"), "<option><flag contact=\"disable\"/></option>");
  return xml;
}

// The snake arm at the end of its way through a pipe, and without contact.
void SnakeArmInPipe(benchmark::State& state) {
  Compare(state, InPipe(true, true), InPipe(true, false), 50, 4);
}
BENCHMARK(SnakeArmInPipe);

void SnakeArmInPipeWithoutFriction(benchmark::State& state) {
  Compare(state, InPipe(false, true), InPipe(false, false), 50, 4);
}
BENCHMARK(SnakeArmInPipeWithoutFriction);

// Links on universal joints, and three cables that pass all of them.
std::string Arm(const std::string& prefix, int links, double place) {
  const auto around = [](int c) {
    const double angle = 2 * M_PI / 3 * c;
    return std::to_string(0.01 * std::cos(angle)) + " " + std::to_string(0.01 * std::sin(angle));
  };
  std::string text = "<body pos=\"" + std::to_string(place) + " 0 1\">", close = "</body>";
  for (int c = 0; c < 3; ++c) {
    text +=
        "<site name=\"" + prefix + "s" + std::to_string(c) + "_0\" pos=\"" + around(c) + " .02\"/>";
  }
  for (int k = 1; k <= links; ++k) {
    text += "<body pos=\"0 0 " + std::string(k == 1 ? "0" : "-.03") +
            "\"><joint axis=\"1 0 0\" stiffness=\".5\" damping=\".01\"/><joint axis=\"0 1 0\" "
            "stiffness=\".5\" damping=\".01\"/><geom type=\"capsule\" size=\".004\" "
            "fromto=\"0 0 0 0 0 -.02\" mass=\".01\" contype=\"0\" conaffinity=\"0\"/>";
    for (int c = 0; c < 3; ++c) {
      text += "<site name=\"" + prefix + "s" + std::to_string(c) + "_" + std::to_string(k) +
              "\" pos=\"" + around(c) + " -.015\"/>";
    }
    close += "</body>";
  }
  return text + close;
}

std::string ArmCables(const std::string& prefix, int links) {
  std::string text;
  for (int c = 0; c < 3; ++c) {
    text += "<spatial name=\"" + prefix + "t" + std::to_string(c) + "\">";
    for (int k = 0; k <= links; ++k) {
      text += "<site site=\"" + prefix + "s" + std::to_string(c) + "_" + std::to_string(k) + "\"/>";
    }
    text += "</spatial>";
  }
  return text;
}

std::string ArmMotors(const std::string& prefix) {
  std::string text;
  for (int c = 0; c < 3; ++c)
    text += "<motor tendon=\"" + prefix + "t" + std::to_string(c) + "\" gear=\"-1\"/>";
  return text;
}

// Arms side by side; instances: one for all of them (1), one each, or none (0).
std::string Arms(int arms, int links, int instances) {
  std::string bodies, cables, motors, friction;
  for (int i = 0; i < arms; ++i) {
    const std::string prefix = "a" + std::to_string(i) + "_";
    bodies += Arm(prefix, links, 0.2 * i);
    cables += ArmCables(prefix, links), motors += ArmMotors(prefix);
    if (i >= instances) continue;
    friction += "<instance name=\"" + prefix + "friction\"><config key=\"tendon\" value=\"" +
                (instances == 1 ? "*" : prefix + "t*") +
                "\"/><config key=\"mu\" value=\".2\"/></instance>";
  }
  const std::string extension =
      friction.empty()
          ? ""
          : "<extension><plugin plugin=\"continuum.capstan\">" + friction + "</plugin></extension>";
  return "<mujoco><option integrator=\"implicitfast\"/>" + extension + "<worldbody>" + bodies +
         "</worldbody><tendon>" + cables + "</tendon><actuator>" + motors + "</actuator></mujoco>";
}

void SixtyLinks(benchmark::State& state) { Compare(state, Arms(1, 60, 1), Arms(1, 60, 0), 20); }
BENCHMARK(SixtyLinks);

void FortyArmsInOneInstance(benchmark::State& state) {
  Compare(state, Arms(40, 8, 1), Arms(40, 8, 0), 5);
}
BENCHMARK(FortyArmsInOneInstance);

void FortyArmsOneInstanceToForty(benchmark::State& state) {
  Compare(state, Arms(40, 8, 1), Arms(40, 8, 40), 5);
}
BENCHMARK(FortyArmsOneInstanceToForty);

// A leg or an arm of so many joints, each with a motor.
std::string Limb(const std::string& name, const std::string& place, int joints,
                 const std::string& joint, std::string& motors) {
  std::string text, close;
  for (int k = 0; k < joints; ++k) {
    const std::string at = name + std::to_string(k);
    text += "<body pos=\"" + (k == 0 ? place : std::string("0 0 -.12")) + "\"><joint name=\"" + at +
            "\" axis=\"" +
            (k % 3 == 0   ? "1 0 0"
             : k % 3 == 1 ? "0 1 0"
                          : "0 0 1") +
            "\" stiffness=\"5\" damping=\".2\" armature=\".01\" " + joint +
            "/><geom type=\"capsule\" size=\".03\" fromto=\"0 0 0 0 0 -.1\" contype=\"0\" "
            "conaffinity=\"0\"/>";
    close += "</body>";
    motors += "<motor joint=\"" + at + "\"/>";
  }
  return text + close;
}

// Floating trunks with 21 joints each, in two legs of six, two arms of three and a waist of three.
std::string Humanoids(int count, const std::string& extension, const std::string& joint) {
  std::string bodies, motors;
  for (int i = 0; i < count; ++i) {
    const std::string name = "h" + std::to_string(i) + "_";
    bodies += "<body pos=\"" + std::to_string(2 * i) +
              " 0 2\"><freejoint/><geom size=\".15\" contype=\"0\" conaffinity=\"0\"/>" +
              Limb(name + "left_arm", ".2 0 .1", 3, joint, motors) +
              Limb(name + "right_arm", "-.2 0 .1", 3, joint, motors) +
              Limb(name + "waist", "0 0 -.1", 3, joint, motors) +
              Limb(name + "left_leg", ".1 0 -.2", 6, joint, motors) +
              Limb(name + "right_leg", "-.1 0 -.2", 6, joint, motors) + "</body>";
  }
  return "<mujoco><option gravity=\"0 0 0\" integrator=\"implicitfast\"/>" + extension +
         "<worldbody>" + bodies + "</worldbody><actuator>" + motors + "</actuator></mujoco>";
}

void LoadFrictionOfTwentyHumanoids(benchmark::State& state) {
  Compare(state,
          Humanoids(20,
                    Instance("load_friction",
                             "<config key=\"joint\" value=\"h*\"/><config key=\"tau_c\" "
                             "value=\".2\"/><config key=\"mu_l\" value=\".05\"/>"),
                    ""),
          Humanoids(20, "", "frictionloss=\".3\""), 5);
}
BENCHMARK(LoadFrictionOfTwentyHumanoids);

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
