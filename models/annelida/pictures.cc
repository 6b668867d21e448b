#include "models/annelida/pictures.h"

#include <numbers>

#include <fmt/format.h>

#include "sim/film/renderer.h"
#include "sim/io/file.h"
#include "sim/page/chart.h"

namespace continuum {
namespace {

using Kind = ChartLine::Kind;

constexpr char kOurs[] = "#c0392b", kTruth[] = "#222222", kArc[] = "#2471a3", kCoarse[] = "#e59866";
constexpr char kChain[] = "chain written out, 20 µs";
constexpr double kDegree = std::numbers::pi / 180, kShown = 2;  // of the release [s]

std::vector<double> Scaled(const auto& values, double factor) {
  std::vector<double> out;
  for (const double value : values) out.push_back(factor * value);
  return out;
}

const std::vector<double> kJoint = {1, 2, 3, 4, 5};

double TipError(const Study& s, const Eigen::Vector2d& tip) {
  return (tip - PlanarChain(s.p).Tip(s.reference.bend.q.back())).norm();
}

Eigen::Vector2d ArcTip(const Study& s) {
  return ArcPoints(s.p, s.reference.bend.q.back(), 2).col(1);
}

// The pose of an arm whose joints share its angle evenly.
void TurnEvenly(const mjModel& m, mjData& d) {
  PlanarJoints q;
  const auto angle = [&](int i) -> double& {
    const std::string joint = fmt::format("bend{}_y", i + 1);
    return d.qpos[m.jnt_qposadr[mj_name2id(&m, mjOBJ_JOINT, joint.c_str())]];
  };
  for (int i = 0; i < kAnnelidaLinks; ++i) q[i] = angle(i);
  for (int i = 0; i < kAnnelidaLinks; ++i) angle(i) = q.mean();
  mj_fwdPosition(&m, &d);
}

Image BentArm(const Study& s, const ModelSpec& annelida) {
  constexpr int kWidth = 520, kHeight = 450;
  constexpr double kStep = 2e-3;
  BendAndRelease plan = s.plan;
  plan.after = 0;
  Image image;
  BendMujoco(annelida, plan, kStep, [&](const mjModel& m, const mjData& d) {
    const Owned<mjData> shown(mj_copyData(nullptr, &m, &d)), even(mj_copyData(nullptr, &m, &d));
    mj_forward(&m, shown.get());
    TurnEvenly(m, *even);
    Renderer renderer(m, kWidth, kHeight);
    Overlay overlay;
    const double even_error = TipError(s, PlanarChain(s.p).Tip(Even(s.reference.bend.q.back())));
    overlay.caption = fmt::format(
        "90° by {:.1f} N on cable 1. Translucent: the arm with equal angles, tip {:.1f} mm off "
        "(an arc of the same length: {:.1f} mm).",
        s.coarse.tension, 1e3 * even_error, 1e3 * TipError(s, ArcTip(s)));
    overlay.bar = ColorBar{"cable tension [N]", "0", fmt::format("{:.0f}", s.coarse.tension)};
    overlay.ghost = even.get();
    image = renderer.Draw(m, *shown, overlay);
  });
  return image;
}

Chart CurvatureChart(const Study& s) {
  const double unit = 1 / s.p.Pitch();
  const PlanarJoints ours = s.coarse.bend.q.back(), truth = s.reference.bend.q.back();
  return {"Curvature along the arm at 90°",
          {"joint", ""},
          {"angle / pitch", "1/m"},
          {{"constant curvature", kArc, kJoint, Scaled(Even(truth), unit)},
           {"MuJoCo and plugin, 2 ms", kOurs, kJoint, Scaled(ours, unit)},
           {kChain, kTruth, kJoint, Scaled(truth, unit), Kind::kDots}},
          false,
          5};
}

ChartLine Shape(const std::string& name, const char* colour, const Eigen::Matrix2Xd& points,
                Kind kind = Kind::kLine) {
  return {name, colour, Scaled(points.row(0), 1e3), Scaled(points.row(1), 1e3), kind};
}

Chart ShapeChart(const Study& s) {
  const PlanarChain chain(s.p);
  const PlanarJoints ours = s.coarse.bend.q.back(), truth = s.reference.bend.q.back();
  const auto error = [&](const Eigen::Vector2d& tip) {
    return fmt::format("tip {:.3g} mm off", 1e3 * TipError(s, tip));
  };
  return {"Base, joints and tip at 90°",
          {"x", "mm"},
          {"z", "mm"},
          {Shape("arc of constant curvature, " + error(ArcTip(s)), kArc, ArcPoints(s.p, truth, 40)),
           Shape("MuJoCo and plugin, 2 ms, " + error(chain.Tip(ours)), kOurs, chain.Points(ours)),
           Shape(kChain, kTruth, chain.Points(truth), Kind::kDots)},
          true};
}

Course Shown(const Course& course) {
  Course shown;
  for (std::size_t i = 0; i < course.q.size() && course.time[i] <= kShown + 1e-6; ++i) {
    shown.time.push_back(course.time[i]);
    shown.q.push_back(course.q[i]);
  }
  return shown;
}

Chart AnglesChart(const Study& s) {
  Chart chart{"Joints after the release", {"time", "s"}, {"angle", "°"}, {}};
  const char* const colours[] = {"#7b241c", "#c0392b", "#e67e22", "#d4ac0d", "#1e8449"};
  const Course ours = Shown(s.fine.release), truth = Shown(s.reference.release);
  const auto angle = [](const Course& course, int i) {
    std::vector<double> out;
    for (const PlanarJoints& q : course.q) out.push_back(q[i] / kDegree);
    return out;
  };
  for (int i = 0; i < kAnnelidaLinks; ++i)
    chart.lines.push_back({fmt::format("joint {}", i + 1), colours[i], ours.time, angle(ours, i)});
  for (int i = 0; i < kAnnelidaLinks; ++i) {
    chart.lines.push_back(
        {i == 0 ? kChain : "", kTruth, truth.time, angle(truth, i), Kind::kDashed});
  }
  return chart;
}

Chart TipChart(const Study& s) {
  const PlanarChain chain(s.p);
  const auto path = [&](const Course& course) {
    const Course shown = Shown(course);
    Eigen::Matrix2Xd points(2, static_cast<Eigen::Index>(shown.q.size()));
    for (std::size_t i = 0; i < shown.q.size(); ++i)
      points.col(static_cast<Eigen::Index>(i)) = chain.Tip(shown.q[i]);
    return points;
  };
  const Eigen::Vector2d rest = 1e3 * chain.Tip(s.fine.release.q.back());
  return {"Path of the tip",
          {"x", "mm"},
          {"z", "mm"},
          {Shape("MuJoCo and plugin, 0.1 ms", kOurs, path(s.fine.release)),
           Shape(kChain, kTruth, path(s.reference.release), Kind::kDashed),
           {fmt::format("held at x = {:.1f} mm after {:.0f} s", rest.x(), s.plan.after),
            kOurs,
            {rest.x()},
            {rest.y()},
            Kind::kDots}},
          true};
}

Chart OffsetChart(const Study& s) {
  const auto line = [&](const std::string& name, const char* colour, const BendResult& run,
                        Kind kind) {
    return ChartLine{name, colour, kJoint, Scaled(run.release.q.back(), 1 / kDegree), kind};
  };
  return {fmt::format("Where friction holds the joints, after {:.0f} s", s.plan.after),
          {"joint", ""},
          {"angle", "°"},
          {line("MuJoCo and plugin, 2 ms", kCoarse, s.coarse, Kind::kLine),
           line("MuJoCo and plugin, 0.1 ms", kOurs, s.fine, Kind::kLine),
           line(kChain, kTruth, s.reference, Kind::kDots),
           {"without friction", kArc, {1, 5}, {0, 0}, Kind::kDashed}},
          false,
          5};
}

}  // namespace

void WritePictures(const Study& study, const ModelSpec& annelida,
                   const std::filesystem::path& folder) {
  MakeFolder(folder);
  WritePng(folder / "bend.png", BentArm(study, annelida));
  WriteFile(folder / "bend.svg", ChartsSvg({CurvatureChart(study), ShapeChart(study)}));
  WriteFile(folder / "release.svg",
            ChartsSvg({AnglesChart(study), TipChart(study), OffsetChart(study)}));
}

}  // namespace continuum
