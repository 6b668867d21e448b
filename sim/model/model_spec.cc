#include "sim/model/model_spec.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "engine.h"
#include "error.h"
#include "sim/io/decimal.h"
#include "sim/io/file.h"
#include "sim/model/asset_folders.h"
#include "sim/model/engine_warnings.h"
#include "sim/model/mjcf_document.h"
#include "sim/model/mujoco_plugins.h"
#include "sim/model/native_effect.h"
#include "sim/model/spec_element.h"

namespace continuum {
namespace {

constexpr std::string_view kPluginTarget = "plugin:";

void RegisterOnce() {
  static const bool once = [] {
    mju_user_warning = EngineWarnings::Take;  // compile errors carry the text
    RegisterEffects();
    LoadMujocoPlugins();
    return true;
  }();
  (void)once;
}

// MuJoCo's errors span lines and repeat what a plugin said: each line once, in one line.
std::string OneLine(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == line.npos) continue;
    line = line.substr(first, line.find_last_not_of(" \t\r,;") - first + 1);
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  std::string all;
  for (const auto& line : lines) all += (all.empty() ? "" : "; ") + line;
  return all;
}

Owned<mjModel> Compile(mjSpec& spec, const std::string& name) {
  Owned<mjModel> model(mj_compile(&spec, nullptr));
  if (!model) throw Error::Input(name, OneLine(mjs_getError(&spec)));
  if (!(model->opt.timestep > 0) || std::isinf(model->opt.timestep)) {
    throw Error::Input(name + ": option timestep", "a positive number [s]",
                       Decimal(model->opt.timestep));
  }
  return model;
}

// While it lives, textures that MuJoCo paints itself have one pixel. It deletes them where it is to
// leave out what only looks.
class WithoutPaint {
 public:
  explicit WithoutPaint(mjSpec& spec) {
    if (spec.compiler.discardvisual) return;
    for (mjsElement* e = mjs_firstElement(&spec, mjOBJ_TEXTURE); e; e = mjs_nextElement(&spec, e)) {
      mjsTexture* const t = mjs_asTexture(e);
      if (t->builtin == mjBUILTIN_NONE) continue;
      sizes_.push_back({t, t->width, t->height});
      t->width = std::min(t->width, 1), t->height = std::min(t->height, 1);
    }
  }
  WithoutPaint(const WithoutPaint&) = delete;
  ~WithoutPaint() {
    for (const Size& s : sizes_) s.texture->width = s.width, s.texture->height = s.height;
  }

 private:
  struct Size {
    mjsTexture* texture;
    int width, height;
  };
  std::vector<Size> sizes_;
};

// For names and sizes: painting takes longest, and nobody looks.
Owned<mjModel> CompileForNames(mjSpec& spec, const std::string& name) {
  const WithoutPaint unpainted(spec);
  return Compile(spec, name);
}

bool IsPlugin(const Change& change) { return change.target.starts_with(kPluginTarget); }
// A body's mass scales its inertia, so that comes first: an inertia that is given is the body's. A
// weight that is put on a body comes last: what scales the body does not scale that. So does what
// scales an actuator's force: a gain that is given is the actuator's.
constexpr int kPasses = 3;
bool IsWeight(const std::string& target, const std::string& attribute) {
  return target.starts_with("body:") && attribute == "point_mass";
}
bool IsForceScale(const Change& change) {
  return change.target.starts_with("actuator:") && change.attribute == "force_scale";
}
int PassOf(const Change& change) {
  if (IsWeight(change.target, change.attribute) || IsForceScale(change)) return 2;
  return change.target.starts_with("body:") && change.attribute == "mass" ? 0 : 1;
}

int InstanceId(const mjModel& m, const std::string& target) {
  const std::string instance = target.substr(kPluginTarget.size());
  const int id = mj_name2id(&m, mjOBJ_PLUGIN, instance.c_str());
  if (id >= 0) return id;
  std::string all;
  for (int i = 0; i < m.nplugin; ++i) {
    const char* known = mj_id2name(&m, mjOBJ_PLUGIN, i);
    if (known) all += (all.empty() ? "" : ", ") + std::string(known);
  }
  throw Error::Input(target, "a plugin instance of the model", all.empty() ? "none" : all);
}

std::size_t IndexOn(const mjModel& m, int instance, const std::string& parameter) {
  return ParameterIndex(mjp_getPluginAtSlot(m.plugin[instance])->name, parameter);
}

void ApplyToPlugin(mjModel& m, mjData& d, const Change& change) {
  const int instance = InstanceId(m, change.target);
  auto values = BoundOf(m, d, instance).parameters();
  double& value = values[IndexOn(m, instance, change.attribute)];
  value = Changed(value, change);
  SetParameters(m, d, instance, values);
}

}  // namespace

bool LiesOnTop(const Change& change) {
  return IsNativeEffect(change) || IsWeight(change.target, change.attribute) ||
         IsForceScale(change);
}

ModelSpec ModelSpec::Load(const std::filesystem::path& model) {
  RegisterOnce();
  RefuseEmptyConfig(ReadFile(model), model.string());
  ModelSpec system;
  system.name_ = model.string();
  system.folder_ = std::filesystem::absolute(model).parent_path().string() + "/";
  char error[1000] = "";
  system.spec_.reset(mj_parseXML(model.c_str(), nullptr, error, sizeof error));
  if (!system.spec_) throw Error::Input(system.name_, OneLine(error));
  system.compiled_ = CompileForNames(*system.spec_, system.name_);
  return system;
}

ModelSpec ModelSpec::Parse(const std::string& xml, const std::filesystem::path& folder,
                           const std::string& name) {
  RegisterOnce();
  ModelSpec system;
  system.name_ = name;
  system.folder_ = std::filesystem::absolute(folder / "").string();
  char error[1000] = "";
  system.spec_.reset(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
  if (!system.spec_) throw Error::Input(system.name_, OneLine(error));
  mjs_setString(system.spec_->modelfiledir, system.folder_.c_str());
  system.compiled_ = CompileForNames(*system.spec_, system.name_);
  return system;
}

namespace {

// In words, where MuJoCo refuses a range for its order.
void RequireOrder(mjSpec& spec, const mjModel& compiled, std::span<const Change> changes) {
  for (const Change& change : changes) {
    if (IsPlugin(change) || IsWorld(change.target) || IsNativeEffect(change)) continue;
    for (const SpecElement& e : MatchElements(&spec, &compiled, change.target, change.target))
      e.RequireOrder(change.attribute);
  }
}

}  // namespace

class ModelSpec::Edits {
 public:
  Edits(const ModelSpec& system, std::span<const Change> changes)
      : spec_(*system.spec_), option_(spec_.option), compiler_(spec_.compiler) {
    try {
      for (int pass = 0; pass < kPasses; ++pass) {
        for (std::size_t i = 0; i < changes.size(); ++i) {
          if (!IsPlugin(changes[i]) && !RepeatsEffect(changes, i) && PassOf(changes[i]) == pass)
            Apply(system, changes, changes[i]);
        }
      }
      for (SpecElement& actuator : Elements(&spec_, mjOBJ_ACTUATOR, system.compiled_.get())) {
        elements_.push_back(actuator.Save());
        actuator.CoverDelay();
      }
    } catch (...) {
      Restore();
      throw;
    }
  }
  Edits(const Edits&) = delete;
  ~Edits() { Restore(); }

 private:
  void Restore() {
    for (auto e = elements_.rbegin(); e != elements_.rend(); ++e) e->Restore();
    spec_.option = option_;
    spec_.compiler = compiler_;
  }

  void Apply(const ModelSpec& system, std::span<const Change> changes, const Change& change) {
    if (IsWorld(change.target)) {
      if (IsNativeEffect(change)) return ApplyNativeEffect(spec_.option, changes, change);
      double& value = OptionAttribute(spec_.option, change.attribute, change.target);
      value = Changed(value, change);
      return;
    }
    for (SpecElement& e :
         MatchElements(&spec_, system.compiled_.get(), change.target, change.target)) {
      elements_.push_back(e.Save());
      ApplyTo(e, changes, change);
      elements_.insert(elements_.end(), e.others().begin(), e.others().end());
    }
  }

  static void ApplyTo(SpecElement& e, std::span<const Change> changes, const Change& change) {
    if (IsNativeEffect(change)) return ApplyNativeEffect(e, changes, change);
    switch (change.operation) {
      case Change::Operation::kSet:
        return e.Set(change.attribute, change.value);
      case Change::Operation::kScale:
        return e.Scale(change.attribute, change.value);
      case Change::Operation::kAdd:
        return e.Add(change.attribute, change.value);
    }
  }

  mjSpec& spec_;
  mjOption option_;
  mjsCompiler compiler_;
  std::vector<SpecElement::Saved> elements_;
};

// Bodies may get their inertia from visual geoms: then these stay.
void ModelSpec::DropVisuals() {
  const mjsBody* const world = mjs_findBody(spec_.get(), "world");
  for (mjsElement* e = mjs_firstElement(spec_.get(), mjOBJ_GEOM); e;
       e = mjs_nextElement(spec_.get(), e)) {
    const mjsGeom& geom = *mjs_asGeom(e);
    const mjsBody* const body = mjs_getParent(e);
    if (body == world) continue;
    const bool inferred =
        spec_->compiler.inertiafromgeom == mjINERTIAFROMGEOM_TRUE || !body->explicitinertial;
    const bool weighs = std::isnan(geom.mass) ? geom.density > 0 : geom.mass > 0;
    if (!geom.contype && !geom.conaffinity && inferred && weighs) return;
  }
  spec_->compiler.discardvisual = 1;
  last_ = {};
  CompileForNames(*spec_, name_);  // which deletes them, before an edit holds one
}

ModelSpec::ModelSpec(const ModelSpec& other)
    : ModelSpec(Parse(other.Xml(), other.folder_, other.name_)) {}

Owned<mjModel> ModelSpec::CompileWith(std::span<const Change> changes) const {
  const Edits edits(*this, changes);
  try {
    return Compile(*spec_, name_);
  } catch (const Error&) {
    RequireOrder(*spec_, *compiled_, changes);
    throw;
  }
}

ModelAndData ModelSpec::Build(std::span<const Change> changes) const {
  std::vector<Change> compiled;
  for (const Change& change : changes)
    if (!IsPlugin(change)) compiled.push_back(change);
  if (!last_.model || last_.changes != compiled) last_ = {compiled, CompileWith(compiled)};
  ModelAndData machine;
  machine.model.reset(mj_copyModel(nullptr, last_.model.get()));
  machine.data.reset(mj_makeData(machine.model.get()));
  if (!machine.data) throw Error::Job(name_ + ": MuJoCo cannot allocate its data");
  for (const Change& change : changes) {
    if (IsPlugin(change)) ApplyToPlugin(*machine.model, *machine.data, change);
  }
  return machine;
}

double ModelSpec::Value(const std::string& target, const std::string& attribute) const {
  if (IsNativeEffect({target, attribute})) {
    if (!IsWorld(target)) MatchElements(spec_.get(), compiled_.get(), target, target);
    return NullOfNativeEffect(attribute);
  }
  if (IsWorld(target)) return OptionAttribute(spec_->option, attribute, target);
  if (target.starts_with(kPluginTarget)) {
    const Owned<mjData> d(mj_makeData(compiled_.get()));
    const int instance = InstanceId(*compiled_, target);
    return BoundOf(*compiled_, *d, instance).parameters()[IndexOn(*compiled_, instance, attribute)];
  }
  return MatchElements(spec_.get(), compiled_.get(), target, target).front().Get(attribute);
}

std::vector<std::string> ModelSpec::Named(const std::string& target) const {
  if (IsWorld(target) || target.starts_with(kPluginTarget)) return {target};
  std::vector<std::string> names;
  for (const SpecElement& e : MatchElements(spec_.get(), compiled_.get(), target, target))
    names.push_back(e.Who());
  return names;
}

double ModelSpec::ValueAfter(std::span<const Change> changes, const std::string& target,
                             const std::string& attribute) const {
  if (!target.starts_with(kPluginTarget) && !LiesOnTop({target, attribute})) {
    const Edits edits(*this, changes);
    return Value(target, attribute);
  }
  double value = Value(target, attribute);
  for (const Change& change : changes) {
    if (change.target == target && change.attribute == attribute) value = Changed(value, change);
  }
  return value;
}

std::string ModelSpec::SavedXml() const {
  std::string xml(1 << 16, '\0');
  char error[1000] = "";
  while (true) {
    const int length = mj_saveXMLString(spec_.get(), xml.data(), static_cast<int>(xml.size()),
                                        error, sizeof error);
    if (length < 0) throw Error::Job(name_ + ": " + OneLine(error));
    if (length == 0) break;
    xml.resize(static_cast<std::size_t>(length) + 1);
  }
  xml.resize(xml.find('\0'));
  return xml;
}

std::string ModelSpec::Xml(std::span<const Change> changes, std::span<const EffectInstance> added,
                           const std::filesystem::path& folder) const {
  const Edits edits(*this, changes);
  const AssetFolders moved(*spec_, folder_,
                           folder.empty() ? std::filesystem::path(folder_) : folder);
  spec_->compiler.discardvisual = 0;
  spec_->compiler.savecompiled = 0;
  spec_->compiler.savecanonical = 0;
  const std::string xml = SavedXml();
  if (added.empty() && std::none_of(changes.begin(), changes.end(), IsPlugin)) return xml;
  MjcfDocument document(xml);
  for (const EffectInstance& effect : added) document.AddInstance(effect);
  for (const Change& change : changes) {
    if (!IsPlugin(change)) continue;
    const double value = Changed(
        change.operation == Change::Operation::kSet ? 0 : Value(change.target, change.attribute),
        change);
    document.SetConfig(change.target.substr(kPluginTarget.size()), change.attribute,
                       Decimal(value));
  }
  return document.Text();
}

ModelSpec ModelSpec::Replacing(const std::string& instance, const EffectInstance& by) const {
  MjcfDocument document(Xml());
  document.ReplaceInstance(instance, by);
  return Parse(document.Text(), folder_, name_);
}

ModelSpec ModelSpec::With(std::span<const Change> changes,
                          std::span<const EffectInstance> added) const {
  return Parse(Xml(changes, added), folder_, name_);
}

}  // namespace continuum
