#include "models/annelida/pipe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/mjcf/mjcf_builder.h"

namespace continuum {
namespace {

using std::numbers::pi;

constexpr int kArm = 1, kWall = 2;      // bits of what touches
constexpr int kHidden = 4;              // a group of geoms that is not drawn
constexpr double kInside = 0.08;        // how far the tip is in the pipe at first [m]
constexpr double kCarriage = 1;         // what moves with the base [kg]
constexpr double kFeedStiffness = 2e4;  // of the feed's servo [N/m]
constexpr double kFeedDamping = 400;    // [N s/m]

Point Along(const Point& p, double s, const Point& d) {
  return {p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]};
}

void Touches(mjsGeom* geom, int self, int other) {
  geom->contype = self;
  geom->conaffinity = other;
  geom->condim = 1;
}

// A part of the pipe around a straight axis in the plane y = 0.
struct Part {
  Point centre;  // of its axis
  Point inward;  // across the axis, to the centre of the elbow
  double length;
  double taper;  // how much shorter it is per way inward [1]
};

// Staves meet their neighbours around the axis. In an elbow they meet those of the next part at
// the face inside, or lie across them behind it.
void AddStaves(Mjcf& mjcf, const Pipe& pipe, const Part& part) {
  const double outer = pipe.inner + pipe.wall;
  for (int k = 0; k < pipe.staves; ++k) {
    const double angle = 2 * pi * k / pipe.staves, c = std::cos(angle), s = std::sin(angle);
    const Point out{c * part.inward[0], s, c * part.inward[2]};
    const Point around{-s * part.inward[0], c, -s * part.inward[2]};
    const double length = part.length - part.taper * std::min(pipe.inner * c, outer * c);
    mjsGeom* const stave =
        mjcf.AddBox(mjcf.world(), Along(part.centre, pipe.inner + pipe.wall / 2, out), out, around,
                    {pipe.wall / 2, outer * std::tan(pi / pipe.staves), length / 2}, "pipe");
    Touches(stave, kWall, kArm);
    if (out[1] < -0.1) stave->group = kHidden;
  }
}

void AddPipe(Mjcf& mjcf, const Pipe& pipe) {
  mjcf.AddMaterial("pipe", {0.45F, 0.62F, 0.72F, 0.35F});
  AddStaves(mjcf, pipe, {{0, 0, -pipe.drop / 2}, {1, 0, 0}, pipe.drop, 0});
  const double turn = pi / 2 / pipe.segments, taper = 2 * std::tan(turn / 2);
  for (int i = 0; i < pipe.segments; ++i) {
    const double angle = (i + 0.5) * turn;
    const Point inward{std::cos(angle), 0, std::sin(angle)};
    AddStaves(
        mjcf, pipe,
        {Along({pipe.bend, 0, -pipe.drop}, -pipe.bend, inward), inward, pipe.bend * taper, taper});
  }
  AddStaves(mjcf, pipe,
            {{pipe.bend + pipe.out / 2, 0, -pipe.drop - pipe.bend}, {0, 0, 1}, pipe.out, 0});
}

// The base on its slide, with the rod that pushes it.
void AddFeed(Mjcf& mjcf, const AnnelidaParameters& p, const Pipe& pipe) {
  mjSpec& spec = mjcf.spec();
  mjsBody* const base = mjs_findBody(&spec, "base");
  base->pos[2] = p.Length() - kInside;
  mjcf.SetInertia(base, kCarriage, {0, 0, 0}, {1e-3, 1e-3, 1e-3});  // it never turns
  mjcf.AddFreeJoint(base, "feed", mjJNT_SLIDE, {0, 0, 1}, 0);
  const double top = p.lead + 0.008, travel = base->pos[2] + pipe.drop;
  mjcf.AddCylinder(base, {0, 0, -top - travel}, {0, 0, -top}, 0.01, "hub");

  mjsActuator* const feed = mjs_addActuator(&spec, nullptr);
  mjs_setName(feed->element, "feed");
  feed->trntype = mjTRN_JOINT;
  mjs_setString(feed->target, "feed");
  double damping = kFeedDamping;
  mjs_setToPosition(feed, kFeedStiffness, &damping, nullptr, nullptr, 0);
  feed->ctrllimited = mjLIMITED_TRUE;
  feed->ctrlrange[1] = travel;
  mjcf.AddSensor(mjSENS_JOINTPOS, "feed", mjOBJ_JOINT, "feed");
}

void AddContacts(Mjcf& mjcf, const AnnelidaParameters& p) {
  const double radius = std::hypot(p.R, p.b2 / 2);
  for (int i = 1; i <= p.Links(); ++i) {
    mjsBody* const link = mjs_findBody(&mjcf.spec(), ("link" + std::to_string(i)).c_str());
    mjsGeom* const ball = mjcf.AddSphere(link, {0, 0, p.b1 + p.b2 / 2}, radius, "plate");
    Touches(ball, kArm, kWall);
    ball->group = kHidden;
  }
}

// Seen with its captions above and its legends below.
void AddScene(Mjcf& mjcf, const AnnelidaParameters& p, const Pipe& pipe) {
  const double top = p.Length() - kInside + p.lead;
  const double bottom = -pipe.drop - pipe.bend - pipe.inner - pipe.wall, height = top - bottom;
  mjcf.AddStudio(bottom - 0.05, 0.6);
  const Point middle{(pipe.bend + pipe.out) / 2, 0, (top + bottom) / 2 - 0.04 * height};
  mjcf.AddCamera("side", Along(middle, height, {0.3, -2.2, 0.7}), middle, 33);
}

}  // namespace

std::string AnnelidaInPipeMjcf(const AnnelidaParameters& p, const Pipe& pipe) {
  Mjcf mjcf = AnnelidaArm(p);
  AddPipe(mjcf, pipe);
  AddFeed(mjcf, p, pipe);
  AddContacts(mjcf, p);
  AddScene(mjcf, p, pipe);
  return mjcf.Text(AnnelidaEffects(p));
}

}  // namespace continuum
