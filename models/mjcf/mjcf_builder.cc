#include "models/mjcf/mjcf_builder.h"

#include <algorithm>
#include <cmath>

#include "error.h"

namespace continuum {
namespace {

void Name(mjsElement* element, const std::string& name) {
  if (!name.empty() && mjs_setName(element, name.c_str()) != 0) {
    throw Error::Input("MJCF", "different names", "'" + name + "' twice");
  }
}

template <class To, class From>
void Copy(To* to, const From& from) {
  std::copy(from.begin(), from.end(), to);
}

// Picometres, so that sums of lengths read as one would write them.
Point Tidy(Point p) {
  for (double& x : p) x = std::round(x * 1e12) / 1e12;
  return p;
}
double Tidy(double x) { return Tidy(Point{x, 0, 0})[0]; }

// Nine digits, so that products read as one would write them.
double Rounded(double x) {
  if (x == 0) return 0;
  const double unit = std::pow(10.0, 8 - std::floor(std::log10(std::abs(x))));
  return std::round(x * unit) / unit;
}

void FromTo(mjsGeom* geom, const Point& from, const Point& to, double radius) {
  Copy(geom->fromto, Tidy(from));
  Copy(geom->fromto + 3, Tidy(to));
  geom->size[0] = Tidy(radius);
}

Point Unit(Point v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  for (double& x : v) x /= length;
  return v;
}

Point Cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Plugin instances as text: mjs_setPluginAttributes takes a container of another C++ library.
std::string Extension(std::span<const EffectInstance> effects) {
  std::string text = "\n  <extension>\n";
  for (const EffectInstance& effect : effects) {
    text += "    <plugin plugin=\"continuum." + effect.effect + "\">\n      <instance name=\"" +
            effect.name + "\">\n";
    for (const auto& [key, value] : effect.config) {
      text += "        <config key=\"" + key + "\" value=\"" + value + "\"/>\n";
    }
    text += "      </instance>\n    </plugin>\n";
  }
  return text + "  </extension>\n";
}

// Each instance is referred to by a body, one a body from the base on: MuJoCo's attach leaves
// behind what nothing refers to.
void AddReferences(std::span<const EffectInstance> effects, std::string& xml) {
  std::size_t body = 0;
  for (const EffectInstance& effect : effects) {
    body = xml.find("<body ", body);
    if (body == xml.npos) {
      throw Error::Input("MJCF: instance '" + effect.name + "'", "as many bodies as instances",
                         "no body left to refer to it");
    }
    body = xml.find('\n', body);
    const std::string indent(xml.find_first_not_of(' ', body + 1) - body - 1, ' ');
    xml.insert(body, "\n" + indent + "<plugin plugin=\"continuum." + effect.effect +
                         "\" instance=\"" + effect.name + "\"/>");
  }
}

std::string Sensors(std::span<const EffectSensor> sensors) {
  std::string text;
  for (const EffectSensor& sensor : sensors) {
    text += "    <plugin name=\"" + sensor.name + "\" plugin=\"continuum." + sensor.effect +
            "\" instance=\"" + sensor.instance + "\"/>\n";
  }
  return text;
}

}  // namespace

Mjcf::Mjcf(const std::string& model, const std::string& comment) : spec_(mj_makeSpec()) {
  mjs_setString(spec_->modelname, model.c_str());
  mjs_setString(spec_->comment, comment.c_str());
  spec_->compiler.degree = 0;
  spec_->compiler.savecompiled = 0;
  spec_->compiler.savecanonical = 0;
  mjsGeom* const geom = mjs_getSpecDefault(spec_.get())->geom;
  geom->contype = geom->conaffinity = 0;
  geom->mass = 0;
}

mjsBody* Mjcf::world() { return mjs_findBody(spec_.get(), "world"); }

void Mjcf::AddMaterial(const std::string& name, const Colour& colour, float specular) {
  mjsMaterial* const material = mjs_addMaterial(spec_.get(), nullptr);
  Name(material->element, name);
  Copy(material->rgba, colour);
  material->specular = specular;
}

void Mjcf::AddStudio(double floor, double wall) {
  spec_->visual.global.offwidth = 1920;
  spec_->visual.global.offheight = 1080;
  auto& headlight = spec_->visual.headlight;
  std::fill_n(headlight.ambient, 3, 0.4F);
  std::fill_n(headlight.diffuse, 3, 0.35F);
  mjsTexture* const sky = mjs_addTexture(spec_.get(), nullptr);
  Name(sky->element, "sky");
  sky->type = mjTEXTURE_SKYBOX;
  sky->builtin = mjBUILTIN_GRADIENT;
  Copy(sky->rgb1, Point{0.95, 0.96, 0.98});
  Copy(sky->rgb2, Point{0.70, 0.76, 0.84});
  sky->width = sky->height = 256;
  AddMaterial("floor", {0.82F, 0.84F, 0.87F, 1}, 0);
  AddMaterial("wall", {0.90F, 0.91F, 0.93F, 1}, 0);

  mjsLight* const light = mjs_addLight(world(), nullptr);
  Copy(light->pos, Point{-0.5, -1.0, 1.5});
  Copy(light->dir, Point{0.25, 0.6, -1});
  Copy(light->diffuse, Point{0.5, 0.5, 0.5});

  mjsGeom* const ground = AddGeom(world(), mjGEOM_PLANE, "floor");
  Copy(ground->size, Point{2, 2, 0.1});
  Copy(ground->pos, Point{0, 0, floor});
  mjsGeom* const back = AddGeom(world(), mjGEOM_PLANE, "wall");
  Copy(back->size, Point{2, 2, 0.1});
  Copy(back->pos, Point{0, wall, 0});
  Copy(back->quat, std::array{std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0});
}

void Mjcf::AddCamera(const std::string& name, const Point& from, const Point& at,
                     double fovy_degree) {
  mjsCamera* const camera = mjs_addCamera(world(), nullptr);
  Name(camera->element, name);
  Copy(camera->pos, from);
  camera->fovy = fovy_degree;
  const Point back = Unit({from[0] - at[0], from[1] - at[1], from[2] - at[2]});
  const Point right = Unit(Cross({0, 0, 1}, back)), up = Cross(back, right);
  camera->alt.type = mjORIENTATION_XYAXES;
  Copy(camera->alt.xyaxes, right);
  Copy(camera->alt.xyaxes + 3, up);
}

mjsBody* Mjcf::AddBody(mjsBody* parent, const std::string& name, const Point& pos) {
  mjsBody* const body = mjs_addBody(parent, nullptr);
  Name(body->element, name);
  Copy(body->pos, Tidy(pos));
  return body;
}

void Mjcf::SetInertia(mjsBody* body, double mass, const Point& centre, const Point& moments) {
  body->explicitinertial = 1;
  body->mass = mass;
  Copy(body->ipos, Tidy(centre));
  Copy(body->inertia, moments);
}

void Mjcf::SetMovingInertia(mjsBody* body, double mass, const Point& centre, const Point& moments) {
  constexpr double kLeast = 2 * mjMINVAL;
  Point enough = moments;
  for (double& moment : enough) moment = std::max(moment, kLeast);
  SetInertia(body, std::max(mass, kLeast), centre, enough);
}

mjsJoint* Mjcf::AddJoint(mjsBody* body, const std::string& name, const Point& axis,
                         double stiffness) {
  mjsJoint* const joint = mjs_addJoint(body, nullptr);
  Name(joint->element, name);
  joint->type = mjJNT_HINGE;
  Copy(joint->axis, axis);
  joint->stiffness[0] = stiffness;
  return joint;
}

void Mjcf::AddHinge(mjsBody* body, const std::string& name, const Point& axis, double stiffness,
                    double stop) {
  mjsJoint* const joint = AddJoint(body, name, axis, stiffness);
  joint->limited = mjLIMITED_TRUE;
  joint->range[0] = -Tidy(stop);
  joint->range[1] = Tidy(stop);
  // MuJoCo keeps a constraint's time constant at two steps or more: the hardest at 2 ms.
  joint->solref_limit[0] = 0.004;
  joint->solimp_limit[0] = 0.95, joint->solimp_limit[1] = 0.99, joint->solimp_limit[2] = 1e-4;
}

void Mjcf::AddBend(mjsBody* body, const std::string& name, const Point& axis, double stiffness,
                   double damping) {
  AddJoint(body, name, axis, Rounded(stiffness))->damping[0] = Rounded(damping);
}

void Mjcf::AddElasticHinge(mjsBody* body, const std::string& name, const Point& axis,
                           double stiffness, const ModalLimit& pace, double rest) {
  mjsJoint* const joint = AddJoint(body, name, axis, stiffness);
  joint->springref = rest;
  joint->armature = stiffness / (pace.fastest * pace.fastest);
  joint->damping[0] = stiffness * pace.lag;
}

void Mjcf::AddFreeJoint(mjsBody* body, const std::string& name, mjtJoint type, const Point& axis,
                        double armature) {
  mjsJoint* const joint = AddJoint(body, name, axis, 0);
  joint->type = type;
  joint->armature = armature;
}

void Mjcf::AddCoupling(const std::string& joint, const std::string& leader, double ratio) {
  mjsEquality* const equality = mjs_addEquality(spec_.get(), nullptr);
  equality->type = mjEQ_JOINT;
  equality->objtype = mjOBJ_JOINT;
  mjs_setString(equality->name1, joint.c_str());
  mjs_setString(equality->name2, leader.c_str());
  std::fill_n(equality->data, mjNEQDATA, 0.0);
  equality->data[1] = ratio;
  equality->solref[0] = 1e-4;  // MuJoCo keeps it at two steps or more
  equality->solimp[0] = equality->solimp[1] = 0.9999;
}

void Mjcf::AddSpring(const std::vector<std::pair<std::string, double>>& joints, double stiffness,
                     double damping) {
  mjsTendon* const tendon = mjs_addTendon(spec_.get(), nullptr);
  tendon->stiffness[0] = Rounded(stiffness);
  tendon->damping[0] = Rounded(damping);
  for (const auto& [joint, factor] : joints) {
    mjs_wrapJoint(tendon, joint.c_str(), Rounded(factor));
  }
}

mjsSite* Mjcf::AddSite(mjsBody* body, const std::string& name, const Point& pos, double radius) {
  mjsSite* const site = mjs_addSite(body, nullptr);
  Name(site->element, name);
  Copy(site->pos, Tidy(pos));
  site->size[0] = radius;
  return site;
}

mjsGeom* Mjcf::AddGeom(mjsBody* body, mjtGeom type, const std::string& material) {
  mjsGeom* const geom = mjs_addGeom(body, nullptr);
  geom->type = type;
  mjs_setString(geom->material, material.c_str());
  return geom;
}

void Mjcf::AddCylinder(mjsBody* body, const Point& from, const Point& to, double radius,
                       const std::string& material) {
  FromTo(AddGeom(body, mjGEOM_CYLINDER, material), from, to, radius);
}

void Mjcf::AddCapsule(mjsBody* body, const Point& from, const Point& to, double radius,
                      const std::string& material) {
  FromTo(AddGeom(body, mjGEOM_CAPSULE, material), from, to, radius);
}

mjsGeom* Mjcf::AddSphere(mjsBody* body, const Point& centre, double radius,
                         const std::string& material) {
  mjsGeom* const geom = AddGeom(body, mjGEOM_SPHERE, material);
  Copy(geom->pos, Tidy(centre));
  geom->size[0] = Tidy(radius);
  return geom;
}

mjsGeom* Mjcf::AddBox(mjsBody* body, const Point& centre, const Point& x, const Point& y,
                      const Point& half, const std::string& material) {
  mjsGeom* const geom = AddGeom(body, mjGEOM_BOX, material);
  Copy(geom->pos, Tidy(centre));
  Copy(geom->size, Tidy(half));
  geom->alt.type = mjORIENTATION_XYAXES;
  Copy(geom->alt.xyaxes, Tidy(x));
  Copy(geom->alt.xyaxes + 3, Tidy(y));
  return geom;
}

void Mjcf::AddCable(const std::string& name, const std::vector<std::string>& sites, double width,
                    const Colour& colour) {
  mjsTendon* const tendon = mjs_addTendon(spec_.get(), nullptr);
  Name(tendon->element, name);
  tendon->width = width;
  Copy(tendon->rgba, colour);
  for (const std::string& site : sites) mjs_wrapSite(tendon, site.c_str());
}

mjsActuator* Mjcf::AddMotor(const std::string& name, double least, double largest) {
  mjsActuator* const actuator = mjs_addActuator(spec_.get(), nullptr);
  Name(actuator->element, name);
  mjs_setToMotor(actuator);
  actuator->ctrllimited = mjLIMITED_TRUE;
  actuator->ctrlrange[0] = least;
  actuator->ctrlrange[1] = largest;
  return actuator;
}

void Mjcf::AddTension(const std::string& name, const std::string& tendon, double largest) {
  mjsActuator* const actuator = AddMotor(name, 0, largest);
  actuator->trntype = mjTRN_TENDON;
  mjs_setString(actuator->target, tendon.c_str());
  actuator->gear[0] = -1;  // MuJoCo's positive force lengthens a tendon
}

void Mjcf::AddDrive(const std::string& name, const std::string& tendon, const Drive& d) {
  mjsActuator* const actuator = mjs_addActuator(spec_.get(), nullptr);
  Name(actuator->element, name);
  actuator->trntype = mjTRN_TENDON;
  mjs_setString(actuator->target, tendon.c_str());
  actuator->biastype = mjBIAS_AFFINE;
  // MuJoCo's force is minus the tension.
  actuator->gainprm[0] = Rounded(-d.stiffness * d.travel);
  actuator->biasprm[0] = Rounded(d.stiffness * d.length - d.pretension);
  actuator->biasprm[1] = Rounded(-d.stiffness);
  actuator->biasprm[2] = Rounded(-d.damping);
  actuator->forcelimited = mjLIMITED_TRUE;
  actuator->forcerange[0] = -d.largest;
  actuator->forcerange[1] = -d.smallest + 0.0;  // no -0
}

void Mjcf::AddForce(const std::string& site, const std::string& frame, double largest) {
  AddWrench(site, frame, 'f', 0, largest);
}

void Mjcf::AddMoment(const std::string& site, const std::string& frame, double largest) {
  AddWrench(site, frame, 'm', 3, largest);
}

void Mjcf::AddWrench(const std::string& site, const std::string& frame, char letter, int first,
                     double largest) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = site + '_' + letter + "xyz"[axis];
    mjsActuator* const actuator = AddMotor(name, -largest, largest);
    actuator->trntype = mjTRN_SITE;
    mjs_setString(actuator->target, site.c_str());
    mjs_setString(actuator->refsite, frame.c_str());
    actuator->gear[0] = 0;
    actuator->gear[first + axis] = 1;
  }
}

void Mjcf::AddPosition(const std::string& name, const std::string& site, const std::string& frame) {
  mjsSensor* const sensor = AddSensor(mjSENS_FRAMEPOS, name, mjOBJ_SITE, site);
  sensor->reftype = mjOBJ_SITE;
  mjs_setString(sensor->refname, frame.c_str());
}

void Mjcf::AddPressure(const std::string& name, const std::string& joint, double lag,
                       double largest) {
  mjsActuator* const actuator = mjs_addActuator(spec_.get(), nullptr);
  Name(actuator->element, name);
  actuator->trntype = mjTRN_JOINT;
  mjs_setString(actuator->target, joint.c_str());
  actuator->gear[0] = 0;
  actuator->gaintype = mjGAIN_FIXED;
  actuator->gainprm[0] = 1;
  if (lag > 0) {
    actuator->dyntype = mjDYN_FILTEREXACT;
    actuator->dynprm[0] = lag;
  }
  actuator->ctrllimited = mjLIMITED_TRUE;
  actuator->ctrlrange[1] = largest;
}

mjsSensor* Mjcf::AddSensor(mjtSensor type, const std::string& name, mjtObj kind,
                           const std::string& object) {
  mjsSensor* const sensor = mjs_addSensor(spec_.get());
  Name(sensor->element, name);
  sensor->type = type;
  sensor->objtype = kind;
  mjs_setString(sensor->objname, object.c_str());
  return sensor;
}

std::string Mjcf::Text(std::span<const EffectInstance> effects,
                       std::span<const EffectSensor> sensors) const {
  const Owned<mjModel> compiled(mj_compile(spec_.get(), nullptr));
  if (!compiled) throw Error::Input("MJCF", mjs_getError(spec_.get()));
  std::string xml(1 << 20, '\0');
  char error[1000] = "";
  const int missing =
      mj_saveXMLString(spec_.get(), xml.data(), static_cast<int>(xml.size()), error, sizeof error);
  if (missing != 0) throw Error::Job(std::string("MJCF: ") + error);
  xml.resize(xml.find('\0'));
  const std::size_t root = xml.find('>', xml.find("<mujoco"));
  if (!sensors.empty()) xml.insert(xml.rfind("  </sensor>"), Sensors(sensors));
  AddReferences(effects, xml);
  if (!effects.empty()) xml.insert(root + 1, Extension(effects));
  return xml;
}

}  // namespace continuum
