#include "engine.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

#include "binding/actuator_force.h"
#include "binding/attachment.h"
#include "binding/effect_catalog.h"
#include "binding/filter.h"
#include "binding/force.h"
#include "binding/formula_force.h"
#include "binding/formula_friction.h"
#include "binding/friction.h"
#include "binding/friction_guess.h"
#include "binding/path.h"
#include "binding/pull.h"
#include "binding/segment.h"
#include "binding/signal.h"
#include "binding/supply.h"
#include "effects/all.h"
#include "mujoco_compat.h"
#include "one_mujoco.h"
#include "plugin_data_slots.h"
#include "wrench_sensor.h"

namespace continuum {
namespace {

using Bind = std::unique_ptr<BoundLaw> (*)(const mjModel&, const Config&, int instance);

// What the engine keeps of one instance: its law, the configuration it was read from, the force it
// last gave. The last instance of a model also keeps the sum over all of them, and evaluates the
// rows once it is known: their levels may depend on every force.
struct Instance {
  Bind bind;
  std::string config;
  std::unique_ptr<BoundLaw> bound;
  std::vector<double> force;
  bool changed = false;             ///< force, since the last sum
  std::vector<int> sensors;         ///< of this instance
  std::vector<int> signals;         ///< in the first instance: all signals, in the order they act
  std::vector<int> givers;          ///< in the last instance: all that give forces, itself included
  std::vector<int> forces;          ///< in the last instance: those of them that are no rows
  std::vector<int> after_all;       ///< in the last instance: those that depend on all other forces
  std::vector<int> rows;            ///< in the last instance: all that are rows, itself included
  std::vector<double> before, sum;  ///< qfrc_passive without our share, and our share
  std::vector<double> next;         ///< our share, while it is summed up
  std::optional<FrictionGuess> guess;  ///< in the last instance, where there are rows
};

// Never destroyed: an mjData may outlive what the process destroys at its end.
PluginDataSlots<Instance>& instances = *new PluginDataSlots<Instance>;

// Null in data that never were init-ed: MuJoCo steps such data while it compiles, where it computes
// the length ranges of actuators. Every callback then does nothing, as if there were no effect.
Instance* Get(const mjData& d, int i) { return instances.Find(d.plugin_data[i]); }

bool IsOurs(const mjModel& m, int i) { return !EffectNameOf(m, i).empty(); }

void Warn(const std::string& text) { mju_warning("%s", text.c_str()); }

// For what is true of an instance as long as its model is: every mjData calls init, and so does the
// compiler.
void WarnOnce(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> said;
  {
    const std::lock_guard lock(mutex);
    if (!said.insert(text).second) return;
  }
  Warn(text);
}

// MuJoCo hands out the model as const, but rows and native damping must be in it before the first
// step. Only constants are assigned, so that every mjData of the model finds the same.
mjModel& Mutable(const mjModel& m) { return const_cast<mjModel&>(m); }

void WarnOfIdleLaws(const mjModel& m, const Instance& self, const Config& config) {
  const bool passive =
      !(m.opt.disableflags & mjDSBL_SPRING) || !(m.opt.disableflags & mjDSBL_DAMPER);
  if (self.bound->IsRow() && (m.opt.disableflags & (mjDSBL_FRICTIONLOSS | mjDSBL_CONSTRAINT))) {
    const bool all = m.opt.disableflags & mjDSBL_CONSTRAINT;
    WarnOnce(config.Who() + ": <flag " + (all ? "constraint" : "frictionloss") +
             "=\"disable\"> removes all dry friction");
  }
  if (self.bound->IsRow() && !passive) {
    WarnOnce(config.Who() +
             ": with springs and dampers disabled dry friction keeps its level, but neither its "
             "anchor nor its change with speed");
  }
  if (const char* const fault = FaultOfRelease(m)) WarnOnce(config.Who() + ": " + fault);
  if (self.bound->IsRow() && IsDiscrete(m)) {
    WarnOnce(config.Who() +
             ": under integrator=\"discrete\" a joint at rest creeps at 2e-4 of the speed that its "
             "load would give it in one step; integrator=\"implicitfast\" holds it");
  }
  if (self.bound->GivesForce() && !passive) {
    WarnOnce(config.Who() + ": with springs and dampers disabled MuJoCo applies no passive forces");
  }
  for (const std::string& why : {self.bound->WhyIdle(m), config.LeftOut()}) {
    if (!why.empty()) WarnOnce(config.Who() + ": " + why);
  }
}

// Instances of ours up to the last one, which is not registered in d yet.
std::vector<int> Those(const mjModel& m, const mjData& d, int last, const Instance& self,
                       bool (BoundLaw::*kind)() const) {
  std::vector<int> those;
  for (int j = 0; j < last; ++j) {
    if (IsOurs(m, j) && (*Get(d, j)->bound.*kind)()) those.push_back(j);
  }
  if ((*self.bound.*kind)()) those.push_back(last);
  return those;
}

// Both ascending.
std::vector<int> Less(const std::vector<int>& all, const std::vector<int>& but) {
  std::vector<int> rest;
  std::set_difference(all.begin(), all.end(), but.begin(), but.end(), std::back_inserter(rest));
  return rest;
}

// Signals act in the order of the effects' list, from the input of an actuator to its tendon: that
// is the order in which plugins are registered.
void OrderSignals(const mjModel& m, mjData& d, int last) {
  int first = last;
  std::vector<int> signals;
  for (int j = 0; j <= last; ++j) {
    if (!IsOurs(m, j)) continue;
    first = std::min(first, j);
    if (Get(d, j)->bound->IsSignal()) signals.push_back(j);
  }
  std::stable_sort(signals.begin(), signals.end(),
                   [&](int a, int b) { return m.plugin[a] < m.plugin[b]; });
  Get(d, first)->signals = signals;
}

// "site 'tip'"
std::string ObjectName(const mjModel& m, mjtObj kind, int id) {
  const char* const type = mju_type2Str(kind);
  const char* const name = id < 0 ? nullptr : mj_id2name(&m, kind, id);
  return type ? std::string(type) + " '" + (name ? name : "") + "'" : "no object";
}

void FindSensors(const mjModel& m, int i, Instance& self, const Config& config) {
  for (int s = 0; s < m.nsensor; ++s) {
    if (m.sensor_type[s] != mjSENS_PLUGIN || m.sensor_plugin[s] != i) continue;
    const auto kind = static_cast<mjtObj>(m.sensor_objtype[s]);
    const int id = m.sensor_objid[s];
    self.sensors.push_back(s);
    const std::string_view expected = self.bound->SensorPlace(m, kind, id);
    if (expected.empty()) continue;
    throw Error::Input(config.Who() + ": its sensor " + std::to_string(s), std::string(expected),
                       ObjectName(m, kind, id));
  }
}

// MuJoCo lays out the states when it compiles.
void RequireState(const mjModel& m, int i, const Config& config) {
  const int needed = mjp_getPluginAtSlot(m.plugin[i])->nstate(&m, i);
  if (needed == m.plugin_statenum[i]) return;
  throw Error::Input(config.Who(),
                     "an edited configuration that needs as many states as the model was compiled "
                     "with, " +
                         std::to_string(m.plugin_statenum[i]),
                     std::to_string(needed));
}

int Init(const mjModel& m, mjData& d, int i, Bind bind) noexcept {
  try {
    auto self = std::make_unique<Instance>();
    const Config config(m, i);
    self->bind = bind;
    self->config = ConfigBytes(m, i);
    self->bound = bind(m, config, i);
    RequireState(m, i, config);
    self->bound->Impose(Mutable(m));
    self->force.assign(m.nv, 0);
    bool last = true;
    for (int j = i + 1; j < m.nplugin; ++j) last &= !IsOurs(m, j);
    if (last) self->givers = Those(m, d, i, *self, &BoundLaw::GivesForce);
    if (last) self->after_all = Those(m, d, i, *self, &BoundLaw::NeedsAllForces);
    if (last) self->rows = Those(m, d, i, *self, &BoundLaw::IsRow);
    if (last) self->forces = Less(self->givers, self->rows);
    if (!self->rows.empty()) self->guess.emplace(m);
    self->before.assign(self->givers.empty() ? 0 : m.nv, 0);
    self->sum = self->next = self->before;
    FindSensors(m, i, *self, config);
    WarnOfIdleLaws(m, *self, config);
    instances.Put(d.plugin_data[i], std::move(self));
    if (last) OrderSignals(m, d, i);
    return 0;
  } catch (const std::exception& e) {
    Warn(e.what());
    return -1;
  }
}

// An edited configuration, or a model that d was not made from.
void Follow(const mjModel& m, Instance& self, int i) {
  const std::string_view now = ConfigBytes(m, i);
  if (now == self.config) return;
  self.config = now;
  try {
    auto bound = self.bind(m, Config(m, i), i);
    RequireState(m, i, Config(m, i));
    bound->CopyFrom(*self.bound);
    bound->Impose(Mutable(m));
    self.bound = std::move(bound);
  } catch (const Error& e) {
    Warn(std::string(e.what()) + "; the former configuration stays");
  }
}

// Adds the forces of instances to qfrc_passive so that repeating any part of the pipeline never
// adds twice: mj_forwardSkip and mjd_transitionFD run kActuator again without kPassive, mj_inverse
// runs kPassive only. The result is exactly before + sum, whatever was added in between, so that a
// restored state replays bit by bit. One instance may be left out.
void Total(const mjModel& m, mjData& d, Instance& last, Stage stage, const std::vector<int>& givers,
           int without = -1) {
  bool changed = stage == Stage::kPassive || without >= 0 || last.forces != last.givers;
  for (const int j : givers) changed |= std::exchange(Get(d, j)->changed, false);
  if (!changed) return;
  std::vector<double>& next = last.next;
  std::fill(next.begin(), next.end(), 0.0);
  for (const int j : givers) {
    const std::vector<double>& force = Get(d, j)->force;
    for (int dof = 0; j != without && dof < m.nv; ++dof) next[dof] += force[dof];
  }
  if (stage == Stage::kPassive) last.before.assign(d.qfrc_passive, d.qfrc_passive + m.nv);
  for (int dof = 0; dof < m.nv; ++dof) {
    double& total = d.qfrc_passive[dof];
    const bool untouched = stage == Stage::kPassive || total == last.before[dof] + last.sum[dof];
    total = untouched ? last.before[dof] + next[dof] : total + (next[dof] - last.sum[dof]);
  }
  last.sum.swap(next);
}

void Evaluate(const mjModel& m, mjData& d, int i, Stage stage) {
  Instance& self = *Get(d, i);
  Follow(m, self, i);
  const double* const z = d.plugin_state + m.plugin_stateadr[i];
  self.changed |= self.bound->Evaluate(m, d, z, stage, self.force);
}

void Sense(const mjModel& m, mjData& d, int i) {
  const Instance& self = *Get(d, i);
  for (const int s : self.sensors) {
    self.bound->Sense(m, d, s,
                      {d.sensordata + m.sensor_adr[s], static_cast<std::size_t>(m.sensor_dim[s])});
  }
}

// Laws that depend on all other forces, one after the other. Those that are still to come give what
// follows from their states.
void EvaluateAfterAll(const mjModel& m, mjData& d, Instance& last) {
  if (last.after_all.size() > 1) {
    for (const int j : last.after_all) Evaluate(m, d, j, Stage::kActuator);
  }
  for (const int j : last.after_all) {
    Total(m, d, last, Stage::kAfterAll, last.givers, j);
    Evaluate(m, d, j, Stage::kAfterAll);
    Get(d, j)->changed = true;
    Sense(m, d, j);
  }
}

// Forces of actuators that are plugins of somebody else and come after instance i: MuJoCo computes
// them after ours. The order of instances is no physics, so they are computed ahead, and taken back
// in the end: their own turn comes.
class PluginActuators {
 public:
  PluginActuators(const mjModel& m, mjData& d, int i, Stage stage) : m_(m), d_(d) {
    if (stage != Stage::kActuator || i + 1 >= m.nplugin) return;
    for (int j = i + 1; j < m.nplugin; ++j) {
      const mjpPlugin* const plugin = mjp_getPluginAtSlot(m.plugin[j]);
      if (IsOurs(m, j) || !plugin || !(plugin->capabilityflags & mjPLUGIN_ACTUATOR)) continue;
      for (int a = 0; a < m.nactuator; ++a) {
        if (m.actuator_plugin[a] == j) Keep(a);
      }
      plugin->compute(&m, &d, j, mjPLUGIN_ACTUATOR);
    }
  }
  PluginActuators(const PluginActuators&) = delete;
  ~PluginActuators() {
    for (const auto& [address, force] : before_) d_.actuator_force[address] = force;
  }

 private:
  void Keep(int a) {
    for (int o = m_.actuator_outadr[a]; o < m_.actuator_outadr[a] + m_.actuator_outnum[a]; ++o)
      before_.emplace_back(o, d_.actuator_force[o]);
  }

  const mjModel& m_;
  mjData& d_;
  std::vector<std::pair<int, double>> before_;
};

void Compute(const mjModel& m, mjData& d, int i, int capability) {
  if (capability == mjPLUGIN_SENSOR) return;  // written below, as soon as it is known
  Instance* const found = Get(d, i);
  if (!found) return;
  const Stage stage = capability == mjPLUGIN_PASSIVE ? Stage::kPassive : Stage::kActuator;
  Instance& self = *found;
  const PluginActuators ahead(m, d, i, stage);
  if (stage == Stage::kActuator) {
    for (const int j : self.signals) Evaluate(m, d, j, stage);
  }
  const bool later = stage == Stage::kActuator && self.bound->NeedsAllForces();
  if (!self.bound->IsSignal() && !self.bound->IsRow() && !later) Evaluate(m, d, i, stage);
  if (!later) Sense(m, d, i);
  if (stage == Stage::kActuator) EvaluateAfterAll(m, d, self);
  // The load of a row is what all others do, but for what friction itself does.
  if (!self.givers.empty()) Total(m, d, self, stage, self.forces);
  if (stage == Stage::kPassive && !self.after_all.empty() && IsUnactuated(m)) {
    mj_rne(&m, &d, 0, d.qfrc_bias);
    EvaluateAfterAll(m, d, self);
    Total(m, d, self, Stage::kActuator, self.forces);
  }
  for (const int j : self.rows) Evaluate(m, d, j, stage);
  if (self.forces != self.givers) Total(m, d, self, Stage::kActuator, self.givers);
  if (self.guess && (stage == Stage::kActuator || IsUnactuated(m))) {
    if (IsUnactuated(m) && self.after_all.empty()) mj_rne(&m, &d, 0, d.qfrc_bias);
    self.guess->Write(m, d);
  }
}

void Copy(mjData& to, const mjModel& m, const mjData& from, int i) {
  if (!Get(from, i) || !Get(to, i)) return;
  const Instance& a = *Get(from, i);
  Instance& b = *Get(to, i);
  b.config = a.config;
  b.bound = a.bind(m, Config(m, i), i);
  b.bound->Set(a.bound->parameters());
  b.bound->CopyFrom(*a.bound);
  b.force = a.force, b.changed = a.changed, b.after_all = a.after_all, b.rows = a.rows;
  b.sensors = a.sensors, b.signals = a.signals, b.givers = a.givers, b.forces = a.forces;
  b.before = a.before, b.sum = a.sum, b.next = a.next, b.guess = a.guess;
}

template <class E>
constexpr bool kInEngine =
    ForceLaw<E> || FrictionLaw<E> || PathLaw<E> || SegmentLaw<E> || SignalLaw<E> || FormulaLaw<E>;

// Numbers of one of an effect's sensors; 0: it has none.
template <class E>
constexpr int kSensorSize = PathLaw<E>      ? 1
                            : SegmentLaw<E> ? 3
                                            : 0;

template <class E>
auto BoundType() {
  if constexpr (std::same_as<E, Formula>)
    return std::type_identity<BoundFormula>{};
  else if constexpr (std::same_as<E, FormulaFriction>)
    return std::type_identity<BoundFormulaFriction>{};
  else if constexpr (ForceLaw<E>)
    return std::type_identity<BoundForce<E>>{};
  else if constexpr (FrictionLaw<E>)
    return std::type_identity<BoundFriction<E>>{};
  else if constexpr (PathLaw<E>)
    return std::type_identity<BoundPath<E>>{};
  else if constexpr (FilterLaw<E>)
    return std::type_identity<BoundFilter<E>>{};
  else if constexpr (PullLaw<E>)
    return std::type_identity<BoundPull<E>>{};
  else if constexpr (SupplyLaw<E>)
    return std::type_identity<BoundSupply<E>>{};
  else if constexpr (SegmentLaw<E>)
    return std::type_identity<BoundSegment<E>>{};
  else
    return std::type_identity<BoundSignal<E>>{};
}

template <class E>
std::unique_ptr<BoundLaw> BindEffect(const mjModel& m, const Config& c, int i) {
  using B = typename decltype(BoundType<E>())::type;
  if constexpr (std::constructible_from<B, const mjModel&, const Config&, int>)
    return std::make_unique<B>(m, c, i);
  else
    return std::make_unique<B>(m, c);
}

// In nstate an error cannot be reported: the same one stops init right afterwards.
template <class E>
int StateSize(const mjModel& m, int i) noexcept {
  try {
    return decltype(BoundType<E>())::type::StateSize(m, Config(m, i));
  } catch (const std::exception&) {
    return 0;
  }
}

template <class E>
void Register() {
  // MuJoCo keeps these pointers for the life of the process.
  static const std::string name = PluginName(E::kName);
  static const auto keys = [] {
    std::vector<std::string> all;
    for (const Place place : E::kPlaces) all.emplace_back(PlaceName(place));
    for (const Param& param : E::kParams) all.emplace_back(param.name);
    for (const Choice& choice : ChoicesOf<E>()) all.emplace_back(choice.name);
    if constexpr (FormulaLaw<E>) all.emplace_back(E::kText);
    if constexpr (PathLaw<E>) all.emplace_back("driven");
    return all;
  }();
  static const auto attributes = [] {
    std::vector<const char*> all;
    for (const std::string& key : keys) all.push_back(key.c_str());
    return all;
  }();

  mjpPlugin plugin;  // noexcept below: nothing may unwind through MuJoCo's C frames
  mjp_defaultPlugin(&plugin);
  plugin.name = name.c_str();
  plugin.capabilityflags = mjPLUGIN_PASSIVE | mjPLUGIN_ACTUATOR;
  plugin.nattribute = static_cast<int>(attributes.size());
  plugin.attributes = attributes.data();
  plugin.nstate = +[](const mjModel* m, int i) noexcept { return StateSize<E>(*m, i); };
  plugin.init =
      +[](const mjModel* m, mjData* d, int i) noexcept { return Init(*m, *d, i, &BindEffect<E>); };
  plugin.destroy = +[](mjData* d, int i) noexcept { instances.Erase(d->plugin_data[i]); };
  plugin.copy = +[](mjData* to, const mjModel* m, const mjData* from, int i) noexcept {
    Copy(*to, *m, *from, i);
  };
  plugin.reset = +[](const mjModel* m, mjtNum* state, void*, int i) noexcept {
    std::fill_n(state, m->plugin_statenum[i], 0.0);
  };
  plugin.compute = +[](const mjModel* m, mjData* d, int i, int capability) noexcept {
    Compute(*m, *d, i, capability);
  };
  plugin.advance = +[](const mjModel* m, mjData* d, int i) noexcept {
    const Instance* const self = Get(*d, i);
    if (self) self->bound->Advance(*m, *d, d->plugin_state + m->plugin_stateadr[i]);
  };
  constexpr int kSize = kSensorSize<E>;
  if constexpr (kSize > 0) {
    plugin.capabilityflags |= mjPLUGIN_SENSOR;
    // Sensors are written with the forces: a sensor of the acceleration stage would make MuJoCo
    // compute the forces between all bodies in every step.
    plugin.needstage = mjSTAGE_POS;
    plugin.nsensordata = +[](const mjModel*, int, int) noexcept { return kSize; };
    plugin.visualize =
        +[](const mjModel* m, mjData* d, const mjvOption*, mjvScene* scene, int i) noexcept {
          const Instance* const self = Get(*d, i);
          if (self) self->bound->Visualize(*m, *d, *scene);
        };
  }
  mjp_registerPlugin(&plugin);
}

}  // namespace

void RegisterEffects() {
  RequireOneMujoco();
  const auto add = []<class E>() {
    if constexpr (kInEngine<E>) Register<E>();
  };
  All::ForEach(add);
  FormulaLaws::ForEach(add);
  RegisterWrench(FindBound);
}

BoundLaw* FindBound(const mjModel& m, const mjData& d, int instance) {
  const Instance* const found = IsOurs(m, instance) ? Get(d, instance) : nullptr;
  return found ? found->bound.get() : nullptr;
}

BoundLaw& BoundOf(const mjModel& m, const mjData& d, int instance) {
  if (instance < 0 || instance >= m.nplugin || !IsOurs(m, instance)) {
    throw Error::Input("plugin instance " + std::to_string(instance), "an effect of ours", "none");
  }
  if (BoundLaw* const found = FindBound(m, d, instance)) return *found;
  throw Error::Input("plugin instance " + std::to_string(instance), "data of mj_makeData", "none");
}

void SettleEffects(const mjModel& m, mjData& d) {
  for (int i = 0; i < m.nplugin; ++i) {
    if (BoundLaw* const law = FindBound(m, d, i))
      law->Settle(m, d, d.plugin_state + m.plugin_stateadr[i]);
  }
}

void SetParameters(mjModel& m, mjData& d, int instance, const std::vector<double>& parameters) {
  BoundLaw& bound = BoundOf(m, d, instance);
  bound.Set(parameters);
  bound.Impose(m);
}

}  // namespace continuum
