#include "sim/model/native_effect.h"

#include <cmath>

#include "effects/all.h"
#include "error.h"
#include "sim/model/spec_element.h"

namespace continuum {
namespace {

constexpr std::string_view kPrefix = "effect:";

// "effect:NAME.PARAM" in parts; PARAM is empty for the first.
struct EffectParameter {
  std::string effect, parameter;
  explicit EffectParameter(const std::string& attribute)
      : effect(attribute.substr(kPrefix.size())) {
    const std::size_t dot = effect.find('.');
    if (dot == effect.npos) return;
    parameter = effect.substr(dot + 1);
    effect.resize(dot);
  }
  std::size_t Index() const {
    return parameter.empty() ? 0 : ParameterIndex("continuum." + effect, parameter);
  }
};

// The options of a model as an element: what belongs to the world.
class WorldElement {
 public:
  explicit WorldElement(mjOption& option) : option_(option) {}
  double Get(std::string_view name) const { return OptionAttribute(option_, name, "world"); }
  void Set(std::string_view name, double value) { OptionAttribute(option_, name, "world") = value; }
  void Add(std::string_view name, double value) { Set(name, Get(name) + value); }
  void Scale(std::string_view name, double factor) { Set(name, Get(name) * factor); }

 private:
  mjOption& option_;
};

double Null(const Param& param) { return std::isnan(param.null) ? 0 : param.null; }

// Calls use<E>() for the native effect of this name.
template <class Use>
void WithNative(const std::string& attribute, Use&& use) {
  const std::string name = EffectParameter(attribute).effect;
  bool known = false;
  All::ForEach([&]<class E>() {
    if constexpr (EditLaw<E>) {
      if (name == E::kName) known = true, use.template operator()<E>();
    }
  });
  if (!known) throw Error::Input(attribute, "a native effect", "'" + name + "'");
}

bool OfOneEffect(const Change& a, const Change& b) {
  return IsNativeEffect(a) && IsNativeEffect(b) && a.target == b.target &&
         EffectParameter(a.attribute).effect == EffectParameter(b.attribute).effect;
}

template <class Target>
void Apply(Target& target, std::span<const Change> changes, const Change& change) {
  WithNative(change.attribute, [&]<class E>() {
    ParamsOf<E, double> p;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = Null(E::kParams[i]);
    for (const Change& c : changes) {
      if (!OfOneEffect(c, change)) continue;
      double& value = p[EffectParameter(c.attribute).Index()];
      value = Changed(value, c);
    }
    E::Apply(target, p);
  });
}

}  // namespace

std::size_t ParameterIndex(const std::string& plugin, const std::string& parameter) {
  std::string all = "no parameters";
  std::size_t index = 0;
  bool found = false;
  const auto look = [&]<class E>() {
    if (plugin != "continuum." + std::string(E::kName)) return;
    all.clear();
    for (std::size_t i = 0; i < E::kParams.size(); ++i) {
      all += (i ? ", " : "") + std::string(E::kParams[i].name);
      if (parameter == E::kParams[i].name) found = true, index = i;
    }
  };
  All::ForEach(look);
  FormulaLaws::ForEach(look);
  if (!found) throw Error::Input(plugin, "one of the parameters " + all, "'" + parameter + "'");
  return index;
}

bool IsWorld(std::string_view target) {
  return target == "option" || target.substr(0, target.find(':')) == "world";
}

bool IsNativeEffect(const Change& change) { return change.attribute.starts_with(kPrefix); }

bool RepeatsEffect(std::span<const Change> changes, std::size_t index) {
  for (std::size_t i = 0; i < index; ++i) {
    if (OfOneEffect(changes[i], changes[index])) return true;
  }
  return false;
}

void ApplyNativeEffect(SpecElement& element, std::span<const Change> changes,
                       const Change& change) {
  Apply(element, changes, change);
}

void ApplyNativeEffect(mjOption& world, std::span<const Change> changes, const Change& change) {
  WorldElement element(world);
  Apply(element, changes, change);
}

Param ParameterOfNativeEffect(const std::string& attribute) {
  Param param{};
  WithNative(attribute, [&]<class E>() { param = E::kParams[EffectParameter(attribute).Index()]; });
  return param;
}

double NullOfNativeEffect(const std::string& attribute) {
  return Null(ParameterOfNativeEffect(attribute));
}

bool NativeEffectNeedsOwnStep(const std::string& attribute) {
  bool needs = false;
  WithNative(attribute, [&]<class E>() {
    if constexpr (requires { E::kOwnStep; }) needs = E::kOwnStep;
  });
  return needs;
}

std::string UnitOfNativeEffect(const std::string& attribute) {
  return std::string(ParameterOfNativeEffect(attribute).unit);
}

}  // namespace continuum
