#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "models/annelida/pictures.h"
#include "models/annelida/study.h"
#include "models/tool_main.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFine = 2e-5;  // step of the chain [s]

// RMS distance from the best straight line over the joints' numbers, relative to the spread.
double Unevenness(const PlanarJoints& q) {
  const PlanarJoints off = q - Even(q);
  const PlanarJoints place = PlanarJoints::LinSpaced(-1, 1);
  const PlanarJoints residual = off - (place.dot(off) / place.squaredNorm()) * place;
  return residual.norm() / off.norm();
}

std::string Angles(const std::string& name, const PlanarJoints& q) {
  std::string row = fmt::format("| {} |", name);
  for (const double angle : q) row += fmt::format(" {:.2f} |", angle / kDegree);
  return row;
}

std::string StaticTable(const AnnelidaParameters& p, const PlanarChain& chain,
                        const BendResult& ours, const BendResult& reference) {
  const PlanarJoints q = ours.bend.q.back(), r = reference.bend.q.back();
  const Eigen::Vector2d truth = chain.Tip(r);
  const auto row = [&](const std::string& name, const PlanarJoints& angles,
                       const Eigen::Vector2d& tip) {
    const double error = (tip - truth).norm();
    return Angles(name, angles) + fmt::format(" {:.2f} | {:.1f}, {:.1f} | {:.2f} ({:.2f} % L) |\n",
                                              (angles - r).norm() / std::sqrt(5.0) / kDegree,
                                              1e3 * tip.x(), 1e3 * tip.y(), 1e3 * error,
                                              100 * error / p.Length());
  };
  std::string text = fmt::format(
      "Static bend to 90 degrees: {:.2f} N (chain {:.2f} N)\n\n"
      "| Angle / ° | 1 | 2 | 3 | 4 | 5 | rms error | tip x, z / mm | tip error / mm |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      ours.tension, reference.tension);
  text += row("MuJoCo and plugin, 2 ms", q, chain.Tip(q));
  text += row("chain written out, 20 us", r, truth);
  text += row("equal angles", Even(r), chain.Tip(Even(r)));
  text += row("constant curvature, eq. 2", Even(r), ArcPoints(p, r, 2).col(1));
  text += Angles("curvature θ/(2 b1 + b2) / (°/mm)", r / (1e3 * p.Pitch()));
  return text +
         fmt::format("\n\nDeparture from a straight line over the joints: {:.0f} % of the spread\n",
                     100 * Unevenness(r));
}

double Distance(const Course& a, const Course& b, double until) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < a.q.size() && a.time[i] <= until + 1e-6; ++i, ++count) {
    sum += (a.q[i] - b.q[i]).squaredNorm() / kAnnelidaLinks;
  }
  return std::sqrt(sum / count);
}

std::string ReleaseRow(const std::string& name, const BendResult& run, const BendResult& truth) {
  return Angles(name + ", after 2 s", At(run.release, 2)) +
         fmt::format(" {:.2f} |\n", Distance(run.release, truth.release, 2) / kDegree) +
         Angles(name + ", after 3 s", At(run.release, 3)) +
         fmt::format(" {:.2f} |\n", Distance(run.release, truth.release, 3) / kDegree);
}

std::string FrictionTable(AnnelidaParameters p, const BendAndRelease& plan) {
  std::string text = "\n| mu | tension / N | 1 | 2 | 3 | 4 | 5 |\n|---|---|---|---|---|---|---|\n";
  for (const double mu : {0.0, 0.10, 0.15, 0.20}) {
    p.mu = mu;
    const BendResult run = BendChain(PlanarChain(p), plan, kFine);
    text += Angles(fmt::format("{:.2f} | {:.2f}", mu, run.tension), run.bend.q.back()) + "\n";
  }
  return text;
}

// Smallest stiffness of the straight arm [N m/rad], negative when it buckles.
double Softest(AnnelidaParameters p, double gravity) {
  p.gravity = gravity;
  const PlanarChain chain(p);
  const double e = 1e-4;
  const auto energy = [&](int i, double a, int j, double b) {
    PlanarState state;
    state.q[i] += a;
    state.q[j] += b;
    return chain.Energy(state);
  };
  Eigen::Matrix<double, kAnnelidaLinks, kAnnelidaLinks> stiffness;
  for (int i = 0; i < kAnnelidaLinks; ++i) {
    for (int j = 0; j < kAnnelidaLinks; ++j) {
      stiffness(i, j) =
          (energy(i, e, j, e) - energy(i, e, j, -e) - energy(i, -e, j, e) + energy(i, -e, j, -e)) /
          (4 * e * e);
    }
  }
  return stiffness.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
}

std::string BendCsv(const Study& runs) {
  std::string csv = "time,tension,tension_chain";
  for (int i = 1; i <= kAnnelidaLinks; ++i) csv += fmt::format(",bend{}_y,chain{}_y", i, i);
  csv += "\n";
  const Course &a = runs.coarse.bend, &b = runs.reference.bend;
  for (std::size_t k = 0; k < std::min(a.q.size(), b.q.size()); ++k) {
    csv += fmt::format("{:.3f},{:.4f},{:.4f}", a.time[k], a.tension[k], b.tension[k]);
    for (int i = 0; i < kAnnelidaLinks; ++i)
      csv += fmt::format(",{:.6f},{:.6f}", a.q[k][i], b.q[k][i]);
    csv += "\n";
  }
  return csv;
}

std::string ReleaseCsv(const Study& runs, const PlanarChain& chain) {
  std::string csv = "time";
  for (const char* name : {"mujoco", "mujoco_fine", "chain"}) {
    for (int i = 1; i <= kAnnelidaLinks; ++i) csv += fmt::format(",{}_bend{}_y", name, i);
    csv += fmt::format(",{}_tip_x,{}_tip_z", name, name);
  }
  csv += "\n";
  for (std::size_t k = 0; k < runs.reference.release.q.size(); ++k) {
    csv += fmt::format("{:.3f}", runs.reference.release.time[k]);
    for (const BendResult* run : {&runs.coarse, &runs.fine, &runs.reference}) {
      const PlanarJoints& q = run->release.q[k];
      for (const double angle : q) csv += fmt::format(",{:.6f}", angle);
      const Eigen::Vector2d tip = chain.Tip(q);
      csv += fmt::format(",{:.6f},{:.6f}", tip.x(), tip.y());
    }
    csv += "\n";
  }
  return csv;
}

std::string ShapeCsv(const Study& runs, const PlanarChain& chain) {
  const PlanarJoints q = runs.coarse.bend.q.back(), r = runs.reference.bend.q.back();
  const auto ours = chain.Points(q), truth = chain.Points(r);
  std::string csv = "mujoco_x,mujoco_z,chain_x,chain_z,arc_x,arc_z\n";
  const Eigen::Matrix2Xd arc = ArcPoints(runs.p, r, static_cast<int>(ours.cols()));
  for (int i = 0; i < ours.cols(); ++i) {
    csv += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", ours(0, i), ours(1, i),
                       truth(0, i), truth(1, i), arc(0, i), arc(1, i));
  }
  return csv;
}

std::string Report(const Study& runs) {
  const AnnelidaParameters& p = runs.p;
  const PlanarChain chain(p);
  std::string text = StaticTable(p, chain, runs.coarse, runs.reference);
  text +=
      "\nRelease: angles that friction leaves, and rms distance from the chain up to then\n\n"
      "| Angle / ° | 1 | 2 | 3 | 4 | 5 | distance |\n|---|---|---|---|---|---|---|\n";
  text += ReleaseRow("MuJoCo and plugin, 2 ms", runs.coarse, runs.reference);
  text += ReleaseRow("MuJoCo and plugin, 0.5 ms", runs.medium, runs.reference);
  text += ReleaseRow("MuJoCo and plugin, 0.1 ms", runs.fine, runs.reference);
  text += ReleaseRow("chain written out, 20 us", runs.reference, runs.reference);
  text += "\nStatic bend by the chain for other cable friction\n" + FrictionTable(p, runs.plan);
  return text + fmt::format(
                    "\nSmallest stiffness of the straight arm / (N m/rad): hanging {:.3f}, "
                    "upright {:.3f}\n",
                    Softest(p, p.gravity), Softest(p, -p.gravity));
}

int Main(int argc, char** argv) {
  std::filesystem::path folder = CONTINUUM_ANNELIDA_FOLDER, out, pictures;
  CLI::App app{"Static bend, release and constant curvature of the snake arm"};
  app.add_option("--model", folder, "folder of annelida.xml and annelida.yaml")
      ->capture_default_str();
  app.add_option("--out", out, "folder for bend.csv, release.csv, shape.csv");
  app.add_option("--pictures", pictures, "folder for bend.png, bend.svg, release.svg");
  return RunTool(app, argc, argv, [&] {
    const AnnelidaParameters p = ReadAnnelida(folder / "annelida.yaml");
    const ModelSpec system = ModelSpec::Load(folder / "annelida.xml");
    const PlanarChain chain(p);
    const BendAndRelease plan;
    const Study runs{p,
                     plan,
                     BendMujoco(system, plan, 2e-3),
                     BendMujoco(system, plan, 5e-4),
                     BendMujoco(system, plan, 1e-4),
                     BendChain(chain, plan, kFine)};
    fmt::print("{}", Report(runs));
    if (!pictures.empty()) WritePictures(runs, system, pictures);
    if (!out.empty()) {
      MakeFolder(out);
      WriteFile(out / "bend.csv", BendCsv(runs));
      WriteFile(out / "release.csv", ReleaseCsv(runs, chain));
      WriteFile(out / "shape.csv", ShapeCsv(runs, chain));
    }
  });
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) { return continuum::Main(argc, argv); }
