#include "random_diagnoses/random_model.h"

#include <fmt/format.h>

namespace continuum::random_diagnoses {
namespace {

// The name of the i-th object of a kind, in one of the ways in which people write names; none at
// times.
class Names {
 public:
  explicit Names(Draw& draw)
      : draw_(draw),
        style_(draw.Chance(0.6) ? "{}{}"
                                : draw.Of({"{} {}", "{}[{}]", "{}*{}", "?{}{}", "{}\\{}", "{}, {}",
                                           "{}/{}", "{}#{}", "{}: {}"})) {}

  std::string operator()(const char* kind, std::size_t i) {
    if (draw_.Chance(0.05)) return "";
    return fmt::format(fmt::runtime(style_), kind, i + 1);
  }

 private:
  Draw& draw_;
  std::string style_;
};

std::string Name(const std::string& name) { return name.empty() ? "" : " name=\"" + name + "\""; }

// MJCF as the user has it and as it truly is, written side by side.
class Writer {
 public:
  explicit Writer(Draw& draw) : draw_(draw), names_(draw) {}

  RandomModel Run() {
    Begin();
    const int joints = draw_.Whole(1, 6);
    const bool chain = draw_.Chance(0.7);
    for (int i = 0; i < joints; ++i) {
      AddBody(static_cast<std::size_t>(i), chain);
      if (!chain) Both("</body>\n");
    }
    for (int i = 0; chain && i < joints; ++i) Both("</body>\n");
    Both("</worldbody>\n");
    AddTendons();
    AddActuators();
    AddSensors();
    if (draw_.Chance(0.1)) Both("<keyframe><key name=\"home\" time=\"0\"/></keyframe>\n");
    Both("</mujoco>\n");
    return std::move(model_);
  }

 private:
  void Both(const std::string& text) { model_.xml += text, model_.truth += text; }
  // A number that may truly be other.
  void Number(const char* attribute, double value, double share) {
    const double truth = draw_.Chance(0.4) ? value * draw_.Within(1 - share, 1 + share) : value;
    model_.xml += fmt::format(" {}=\"{:.6g}\"", attribute, value);
    model_.truth += fmt::format(" {}=\"{:.6g}\"", attribute, truth);
  }

  void Begin() {
    Both(fmt::format("<mujoco><option timestep=\"{}\" integrator=\"{}\"{}/>\n<worldbody>\n",
                     draw_.Of({"0.002", "0.005", "0.001"}),
                     draw_.Of({"implicitfast", "implicitfast", "Euler", "implicit", "RK4"}),
                     draw_.Chance(0.3) ? " gravity=\"0 0 0\"" : ""));
    contacts_ = draw_.Chance(0.2);
    if (contacts_) Both("<geom type=\"plane\" size=\"2 2 .1\" pos=\"0 0 -.35\"/>\n");
    Both("<site name=\"base\" pos=\"0 .02 .02\"/>\n");
  }

  void AddBody(std::size_t i, bool chain) {
    const std::string body = names_("link", i), joint = names_("j", i);
    model_.bodies.push_back(body), model_.joints.push_back(joint);
    slides_.push_back(draw_.Chance(0.3));
    const std::string at = chain ? (i ? ".1 0 0" : "0 0 0") : fmt::format("0 {} 0", i);
    Both(fmt::format("<body{} pos=\"{}\"><joint{} type=\"{}\" axis=\"{}\"", Name(body), at,
                     Name(joint), slides_[i] ? "slide" : "hinge",
                     draw_.Of({"0 1 0", "0 0 1", "1 0 0", "0 1 1"})));
    Number("damping", draw_.Chance(0.1) ? 0 : draw_.Within(0.01, 0.2) * (slides_[i] ? 20 : 1), 0.8);
    if (draw_.Chance(0.6)) Number("stiffness", draw_.Within(0.1, 2) * (slides_[i] ? 100 : 1), 0.4);
    if (draw_.Chance(0.3)) Number("armature", draw_.Within(1e-4, 1e-2), 0.8);
    if (draw_.Chance(0.2)) Both(fmt::format(" range=\"{}\"", slides_[i] ? "-.1 .1" : "-60 60"));
    if (draw_.Chance(0.1)) {
      Both(" frictionloss=\"0.02\"");
    } else if (draw_.Chance(0.3)) {
      model_.truth += " frictionloss=\"0.05\"";
    }
    Both(fmt::format("/><geom type=\"capsule\" size=\".01\" fromto=\"0 0 0 .1 0 0\"{}",
                     contacts_ ? "" : " contype=\"0\" conaffinity=\"0\""));
    Number("mass", draw_.Within(0.02, 0.3), 0.5);
    Both(fmt::format("/><site name=\"s{}\" pos=\".05 .02 .01\"/>\n", i));
  }

  void AddTendons() {
    const std::size_t n = model_.joints.size();
    Both("<tendon>\n");
    if (draw_.Chance(0.3) && !model_.joints[0].empty()) {
      model_.tendons.push_back(names_("rod", 0));
      Both(fmt::format("<fixed{}><joint joint=\"{}\" coef=\"{}\"/></fixed>\n",
                       Name(model_.tendons.back()), model_.joints[0], draw_.Of({"1", "-0.5"})));
    }
    if (draw_.Chance(0.4)) {
      model_.tendons.push_back(names_("cable", 0));
      Both(fmt::format("<spatial{}{}><site site=\"base\"/>", Name(model_.tendons.back()),
                       draw_.Of({"", " stiffness=\"20\"", " damping=\"1\"",
                                 " limited=\"true\" range=\"0 1\""})));
      for (std::size_t i = 0; i < n; ++i) Both(fmt::format("<site site=\"s{}\"/>", i));
      Both("</spatial>\n");
    }
    Both("</tendon>\n");
  }

  // What it acts on; empty where nothing has a name.
  std::string Transmission(std::size_t joint) {
    if (!model_.tendons.empty() && draw_.Chance(0.3)) {
      const std::string& tendon = draw_.From(model_.tendons);
      if (!tendon.empty()) return fmt::format(" tendon=\"{}\"", tendon);
    }
    return model_.joints[joint].empty() ? "" : fmt::format(" joint=\"{}\"", model_.joints[joint]);
  }

  void AddActuators() {
    Both("<actuator>\n");
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const std::string on = Transmission(i);
      if (on.empty() || draw_.Chance(0.2)) continue;
      model_.actuators.push_back(names_("m", i));
      AddActuator(Name(model_.actuators.back()) + on);
    }
    Both("</actuator>\n");
  }

  void AddActuator(const std::string& on) {
    const std::string kind =
        draw_.Chance(0.4)
            ? "motor"
            : draw_.Of({"position", "position", "velocity", "intvelocity actrange=\"-1 1\"",
                        "damper ctrlrange=\"0 1\"", "cylinder timeconst=\".05\"",
                        "muscle lengthrange=\".05 1\"", "pid kv=\".1\"",
                        "dcmotor motorconst=\".1\" resistance=\"2\"",
                        "general dyntype=\"filterexact\" dynprm=\".03\"",
                        "general dyntype=\"integrator\"",
                        "general gaintype=\"affine\" biastype=\"affine\" biasprm=\"0 -1 -.1\"",
                        "general dyntype=\"filter\" dynprm=\".03\" actearly=\"true\"",
                        "motor delay=\".01\" nsample=\"30\""});
    Both("<" + kind + on);
    if (kind == "position" || kind.starts_with("pid") || kind.starts_with("intvelocity"))
      Number("kp", draw_.Within(1, 20), 0.3);
    if (kind == "velocity" || kind.starts_with("damper")) Number("kv", draw_.Within(0.1, 1), 0.3);
    if (kind == "motor") Number("gear", draw_.Within(0.5, 2), 0.3);
    if (draw_.Chance(0.15) && (kind == "motor" || kind == "position"))
      Both(" ctrlrange=\"-.6 .6\"");
    if (draw_.Chance(0.1) && !kind.starts_with("dcmotor")) Both(" forcerange=\"-3 3\"");
    Both("/>\n");
  }

  // component: of how many; 1: a scalar.
  void AddSensor(const std::string& text, const std::string& name, const std::string& unit,
                 int components) {
    Both(fmt::format(fmt::runtime(text), Name(name)) + "\n");
    if (name.empty()) return;
    if (components == 1) return model_.seen.push_back({name, unit});
    for (int c = 0; c < components; ++c)
      model_.seen.push_back({fmt::format("{}[{}]", name, c), unit});
  }

  void AddSensors() {
    Both("<sensor>\n");
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const std::string& joint = model_.joints[i];
      if (joint.empty()) continue;
      const std::string of = "{} joint=\"" + joint + "\"/>";
      if (draw_.Chance(0.8))
        AddSensor("<jointpos" + of, names_("q", i), slides_[i] ? "m" : "rad", 1);
      if (draw_.Chance(0.2))
        AddSensor("<jointvel" + of, names_("v", i), slides_[i] ? "m/s" : "rad/s", 1);
    }
    const std::string tip = fmt::format("s{}", model_.joints.size() - 1);
    AddSensor("<framepos{} objtype=\"site\" objname=\"" + tip + "\"/>", "tip", "m", 3);
    if (draw_.Chance(0.2)) AddSensor("<accelerometer{} site=\"" + tip + "\"/>", "acc", "m/s^2", 3);
    if (draw_.Chance(0.2)) AddSensor("<gyro{} site=\"" + tip + "\"/>", "gyro", "rad/s", 3);
    for (std::size_t i = 0; i < model_.tendons.size(); ++i) {
      const std::string& tendon = model_.tendons[i];
      if (!tendon.empty())
        AddSensor("<tendonpos{} tendon=\"" + tendon + "\"/>", names_("length", i), "m", 1);
    }
    if (!model_.actuators.empty() && !model_.actuators[0].empty() && draw_.Chance(0.3))
      AddSensor("<actuatorfrc{} actuator=\"" + model_.actuators[0] + "\"/>", "effort", "N", 1);
    Both("</sensor>\n");
  }

  Draw& draw_;
  Names names_;
  RandomModel model_;
  std::vector<bool> slides_;
  bool contacts_ = false;
};

}  // namespace

RandomModel DrawModel(Draw& draw) { return Writer(draw).Run(); }

}  // namespace continuum::random_diagnoses
