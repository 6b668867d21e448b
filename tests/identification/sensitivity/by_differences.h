#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "identification/sensitivity/step_sensitivity.h"
#include "sim/model/model_spec.h"

namespace continuum::testing {

/// Something that has no derivative in closed form on the stepped path.
struct ByDifferences {
  std::string what, reason;
  /// Parts of a model that has it: attributes of <option>, its flags, attributes of the joint 'b',
  /// of the cable 'c' and of the motor 'u'; bodies, sites of the cable, and further elements.
  struct Parts {
    std::string option = {}, joint = {}, cable = {}, motor = {}, body = {}, route = {}, more = {},
                sensor = {};
  } parts = {};
};

/// Two arms with a cable, a motor, and what a case adds.
inline std::string ModelOf(const ByDifferences::Parts& p) {
  return fmt::format(
      "<mujoco><option timestep='2e-3' {}</option><worldbody><site name='s0' pos='0.03 0 0'/>"
      "<body name='link'><joint name='a' axis='0 1 0'/><inertial pos='0 0 -0.1' mass='1' "
      "diaginertia='0.01 0.01 0.01'/><site name='s1' pos='0.03 0 -0.1'/><geom name='g' "
      "type='cylinder' size='0.02 0.05' pos='0.03 0 -0.15' euler='90 0 0' mass='0' contype='0' "
      "conaffinity='0'/><body name='tip' pos='0 0 -0.2'><joint name='b' axis='0 1 0' {}/>"
      "<inertial pos='0 0 -0.1' mass='1' diaginertia='0.01 0.01 0.01'/><site name='s2' "
      "pos='0.03 0 -0.1'/></body></body><body name='other' pos='1 0 0'><joint name='d' "
      "axis='0 1 0'/><inertial pos='0 0 -0.1' mass='1' diaginertia='0.01 0.01 0.01'/><site "
      "name='s3' pos='0.03 0 -0.05'/><site name='s4' pos='0.03 0 -0.1'/></body>{}</worldbody>"
      "<tendon><spatial name='c' {}><site site='s0'/><site site='s1'/>{}<site site='s2'/></spatial>"
      "<spatial name='e'><site site='s0'/><site site='s3'/><site site='s4'/></spatial></tendon>"
      "<actuator><general name='u' {}/></actuator>{}<sensor>{}</sensor></mujoco>",
      p.option.empty() ? ">" : p.option, p.joint, p.body, p.cable, p.route,
      p.motor.empty() ? "joint='a'" : p.motor, p.more,
      p.sensor.empty() ? "<jointpos name='y' joint='a'/>" : p.sensor);
}

/// Why `identify` goes by differences for such a model, in its own words.
inline std::string WhyByDifferences(const ByDifferences& c) {
  const ModelAndData machine = ModelSpec::Parse(ModelOf(c.parts)).Build();
  Experiment e;
  e.outputs.emplace_back();
  e.outputs[0].columns = {"y"}, e.outputs[0].unit = "1";
  e.outputs[0].source = "y";
  return StepSensitivity::Obstacle(*machine.model, *machine.data, Wiring(e, *machine.model));
}

inline std::string Effect(const std::string& name, const std::string& keys,
                          const std::string& instance = "law") {
  return "<extension><plugin plugin='continuum." + name + "'><instance name='" + instance + "'>" +
         keys + "</instance></plugin></extension>";
}
inline std::string Key(const std::string& key, const std::string& value) {
  return "<config key='" + key + "' value='" + value + "'/>";
}

/// All that a model can have.
inline std::vector<ByDifferences> CasesByDifferences() {
  const std::string kCable = Key("tendon", "c");
  const std::string kNotWritten = "its second derivatives are not written";
  return {
      {"integrator `discrete`",
       "the metric of its solver holds stiffness too",
       {.option = "integrator='discrete'>"}},
      {"ball joints", "positions are no vectors", {.joint = "type='ball'"}},
      {"free joints",
       "positions are no vectors",
       {.body = "<body><freejoint/><geom size='0.1' contype='0' conaffinity='0'/></body>"}},
      {"sleeping islands",
       "what sleeps has other equations",
       {.option = "><flag sleep='enable'/>"}},
      {"steps of the solver against slip",
       "they solve once more, without (1) of SolverRows",
       {.option = "noslip_iterations='2'>"}},
      {"curved springs and dampers of joints", kNotWritten, {.joint = "stiffness='1 0.5'"}},
      {"the same of tendons", kNotWritten, {.cable = "stiffness='1 0.5'"}},
      {"springs of joints that yield",
       "their rest is a state",
       {.joint = "stiffness='1' springyield='0.1'"}},
      {"the same of tendons",
       "their rest is a state",
       {.cable = "stiffness='1' springyield='0.1'"}},
      {"limits of all actuators of a joint",
       "a clamp over a sum",
       {.joint = "actuatorfrcrange='-1 1'"}},
      {"the same of tendons", "a clamp over a sum", {.cable = "actuatorfrcrange='-1 1'"}},
      {"actuators on sites or bodies",
       "their moment arms are not differentiated",
       {.motor = "site='s2'"}},
      {"muscles",
       kNotWritten,
       {.motor = "joint='a' gaintype='muscle' gainprm='0.75 1.05 1 200 0.5 1.6 1.5 1.3 1.2' "
                 "dyntype='muscle' lengthrange='0 1'"}},
      {"activations with limits",
       "a clamp of a state",
       {.motor = "joint='a' dyntype='integrator' actlimited='true' actrange='-1 1'"}},
      {"activations with dynamics of a user",
       "nobody knows them",
       {.motor = "joint='a' dyntype='user'"}},
      {"actuators of a group that is switched off",
       "the switch may be turned on the way",
       {.option = "actuatorgroupdisable='0'>"}},
      {"actuators with damping or armature",
       "they add to the inertia",
       {.motor = "joint='a' damping='0.1'"}},
      {"tendons around geoms", kNotWritten, {.route = "<geom geom='g'/>"}},
      {"tendons over pulleys",
       "branches share one tension",
       {.route = "<site site='s2'/><pulley divisor='2'/><site site='s1'/>"}},
      {"armatures of tendons", "the inertia follows moment arms", {.cable = "armature='0.1'"}},
      {"dampers of tendons across branches, under `implicitfast` and `implicit`",
       "MuJoCo's step leaves out how they couple both",
       {.option = "integrator='implicitfast'>",
        .cable = "damping='0.1'",
        .route = "<site site='s3'/>"}},
      {"fluids", kNotWritten, {.option = "density='1'>"}},
      {"flexes",
       kNotWritten,
       {.body = "<body name='cloth'><flexcomp name='f' type='grid' count='2 2 1' spacing='.1 .1 "
                ".1' dim='2' "
                "mass='1' radius='0.01'><contact contype='0' conaffinity='0' selfcollide='none'/>"
                "</flexcomp></body>"}},
      {"gravity that is compensated",
       kNotWritten,
       {.body = "<body gravcomp='1'><geom size='0.1' contype='0' conaffinity='0'/></body>"}},
      {"equalities other than of joints",
       kNotWritten,
       {.more = "<equality><weld body1='tip' body2='world'/></equality>"}},
      {"sensors with a delay or an interval",
       "MuJoCo keeps their past",
       {.sensor = "<jointpos name='y' joint='a' delay='0.01' nsample='8'/>"}},
      {"effects on models without springs and dampers",
       "MuJoCo calls them differently",
       {.option = "><flag spring='disable' damper='disable'/>",
        .more = Effect("dahl", Key("joint", "a") + Key("f", "1") + Key("sigma", "1"))}},
      {"plugins of others",
       "nobody knows their derivatives",
       {.more = "<extension><plugin plugin='mujoco.sensor.touch_grid'/></extension><sensor><plugin "
                "name='touch' plugin='mujoco.sensor.touch_grid' objtype='site' objname='s1'>"
                "<config key='size' value='3 3'/><config key='fov' value='45 45'/><config "
                "key='gamma' value='0'/><config key='nchannel' value='1'/></plugin></sensor>"}},
      {"dry friction with a give",
       "the row's softness follows its level",
       {.more =
            Effect("gear_friction", Key("joint", "a") + Key("tau_c", "1") + Key("give", "0.01"))}},
      {"friction of cables at its null",
       "contacts at rest have no memory yet",
       {.more = Effect("capstan", kCable + Key("mu", "0"))}},
      {"the same where limits or equalities pull the cable",
       "its tension is solved with them",
       {.cable = "limited='true' range='0 1'",
        .more = Effect("capstan", kCable + Key("mu", "0.1"))}},
      {"one instance over several robots",
       "its islands are solved one by one",
       {.more = Effect("capstan", Key("tendon", "c e") + Key("mu", "0.1"))}},
      {"several instances of it",
       "each waits for the other's force",
       {.more = Effect("capstan", kCable + Key("mu", "0.1")) +
                Effect("capstan", Key("tendon", "e") + Key("mu", "0.1"), "other")}},
  };
}

/// What no model shows: the question, a parameter, or a log on its way. Reasons are those of
/// `identify --derivatives`.
inline std::vector<std::pair<std::string, std::string>> QuestionsByDifferences() {
  return {
      {"fewer than four parameters", "differences are cheaper for fewer than four parameters"},
      {"`--differences`", "as asked for"},
      {"a smooth force without a law", "a force of free form acts"},
      {"`quasi_static` logs", "the logs are quasi-static"},
      {"the skew of the clock", "the rows' times change"},
      {"all other parameters beside it, once it moves", "the clock is another one"},
      {"a parameter that changes how many numbers a model has",
       "it changes a size of the model (...)"},
      {"a delay of a history that holds samples (`interp='zoh'`)",
       "the history holds samples: a delay counts whole ones"},
      {"a log on which contacts act", "a contact acts at ... s"},
      {"a log on which a signal is outside of its control's range",
       "a signal is outside of the range of its control at ... s"},
  };
}

/// The table of docs/closed-form.md.
inline std::string TableOfDifferences() {
  std::string table = "| by differences | what `identify` says | why |\n|---|---|---|\n";
  for (const ByDifferences& c : CasesByDifferences())
    table += fmt::format("| {} | {} | {} |\n", c.what, WhyByDifferences(c), c.reason);
  for (const auto& [what, reason] : QuestionsByDifferences())
    table += fmt::format("| {} | {} | |\n", what, reason);
  return table;
}

}  // namespace continuum::testing
