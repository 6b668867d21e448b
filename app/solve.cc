#include "app/solve.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <iostream>
#include <memory>

#include "app/console.h"
#include "error.h"
#include "models/solve.h"
#include "sim/io/output_folder.h"

namespace continuum {

void AddSolve(CLI::App& app, int& exit_code) {
  CLI::App* const solve = app.add_subcommand(
      "solve",
      "Static shape of a robot (annelida, tdcr, twin_pivot, stiff_flop) for every row of a table");
  const auto request = std::make_shared<SolveRequest>();
  solve->add_option("robot", request->robot, "The robot: models/<robot>/<name>.yaml")->required();
  solve->add_option("--method", request->method,
                    "tdcr: eas (default), pcca, crt, crt_friction, fit; twin_pivot: virtual_work "
                    "(default), printed; stiff_flop: energy+body+chamber; annelida: "
                    "constant_curvature (default), chain, chain_friction");
  solve->add_option("--input", request->input,
                    "Cases: one row each (CSV); - with --out -: a stream, answered as it comes");
  solve->add_option("--measured", request->measured,
                    "Measured disks or tips of the cases (CSV), for errors; tdcr also for fit and "
                    "calibration");
  solve->add_option("--errors", request->errors,
                    "Table of the distances from --measured by disk (.csv or .json)");
  solve->add_option("--boxplot", request->boxplot,
                    "Box plot of the distances from --measured by disk (.png, .svg or .pdf)");
  solve
      ->add_option("--out", request->out,
                   "Results (.csv or .json), or the calibrated robot (.yaml)")
      ->required();
  solve->add_option("--plot", request->plot, "Picture of the shapes (.png, .svg or .pdf)");
  solve->add_option("--shape", request->shape,
                    "Places along the centre lines, with frames and tensions (.csv or .json)");
  solve->add_option("--outlines", request->outlines,
                    "stiff_flop: lines of the deformed sections, and the threads' angle around the "
                    "tubes (.csv, .json, or a picture as .svg)");
  solve->add_option("--compliance", request->compliance,
                    "How every tip moves by forces and by what drives the robot (.csv or .json)");
  solve->add_option("--reach", request->reach,
                    "Where tips or disks of the cases should be (CSV): the least tensions or "
                    "pressures that bring them there, or lengths of cases by lengths");
  solve->add_option("--follow", request->follow,
                    "twin_pivot: a path (CSV of points) that the whole robot lies on while its "
                    "base comes along its axis: the tensions for each point");
  solve->add_option("--sweep", request->sweep,
                    "Workspace: the grid between the two rows of --input, of so many values of "
                    "every column that differs");
  solve->add_flag("--equilibria", request->equilibria,
                  "All equilibria that a search finds, a row each, with energy and stability");
  solve->add_flag("--calibrate", request->calibrate,
                  "Fit the robot's parameters to the data instead of solving cases");
  solve
      ->add_option("--parameters", request->parameters,
                   "--calibrate: what to find. tdcr: E, GJ, mu, base_rotation, precurvature, "
                   "density, disk_mass, angle, radius; E_2: of section 2, angle_3: of tendon 3. "
                   "stiff_flop: E, gamma")
      ->delimiter(',');
  solve->add_option("--hybrid", request->hybrid,
                    "tdcr: train a linear correction on measured shapes, or apply one");
  solve->add_flag("--cross-validate", request->cross_validate,
                  "tdcr --hybrid train: the penalty that does best on cases left out (default)");
  solve->add_flag("--sensitivity", request->sensitivity,
                  "stiff_flop: derivatives by fibre angle and by E");
  solve
      ->add_option("--lambda", request->lambda,
                   "tdcr fit: weight of the curvatures (1e-7); --hybrid train: a given penalty on "
                   "the weights (the paper: 0)")
      ->check(NumberWithin(0, 1e9));
  solve->footer(
      "Example:\n"
      "  continuum solve models/tdcr/tdcr.yaml --method eas --input models/tdcr/cases.csv "
      "--out shapes.csv --plot shapes.png");
  solve->callback([request, &exit_code] {
    const std::vector<std::filesystem::path> inputs{
        request->robot, request->input, request->measured, request->reach, request->follow};
    const bool stream = request->input == "-";
    if (stream != (request->out == "-")) {
      throw Error::Input("--input and --out", "'-' for both, or files", "one of them");
    }
    if (!stream) RequireWritable(request->out, inputs);
    for (const auto* file : {&request->plot, &request->shape, &request->compliance,
                             &request->outlines, &request->errors, &request->boxplot}) {
      if (!file->empty()) RequireWritable(*file, inputs);
    }
    request->warn = [](const std::string& text) { std::cerr << "warning: " << text << '\n'; };
    request->say = [](const std::string& text) { std::cerr << text << '\n'; };
    if (stream) std::ios::sync_with_stdio(false);  // else it does not say what has come
    exit_code = stream ? SolveStream(*request, std::cin, std::cout) : Solve(*request);
  });
}

}  // namespace continuum
