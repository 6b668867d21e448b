#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/experiment/registration.h"
#include "sim/model/change.h"

namespace continuum {

/// What an actuator receives.
struct Input {
  std::string column;  ///< empty: control 0
  std::string unit, actuator, enable;
  bool linear = false;  ///< else held between rows
  std::string where;    ///< file:line: key, for messages
  bool unwrap = false;  ///< full turns that an angle lost are put back
  bool gaps = false;    ///< empty cells are filled: with the number before, or on a line if linear
};

/// How a channel is measured: y_meas(t) = scale · (e + Eccentricity(e)) + bias + rate (t − t_0), e
/// = R(axis, angle) y(t − delay).
struct Measurement {
  double bias = 0, scale = 1, delay = 0, rate = 0, angle = 0;
  double cosine = 0, sine = 0, harmonic = 1;  ///< of an encoder off its axis
  std::vector<double> axis{0, 0, 1};
  bool operator==(const Measurement&) const = default;
  /// What an encoder off its axis adds to y [unit of the output, both].
  double Eccentricity(double y) const {
    return cosine * std::cos(harmonic * y) + sine * std::sin(harmonic * y);
  }
};

/// What is compared: one column against one number of the simulation, or four columns against a
/// quaternion sensor (the error is a rotation vector).
struct Output {
  enum class Kind { kSensor, kForce, kControl };
  std::vector<std::string> columns;
  std::string unit;
  Kind kind = Kind::kSensor;
  std::string source;  ///< sensor ("tip_pos[1]" for a component) or actuator
  double sigma = 0;    ///< standard deviation of the noise in unit; 0: not given
  double weight = 1;
  bool unwrap = false;  ///< full turns that an angle lost are put back
  Measurement measurement;
  std::string where;  ///< file:line: key, for messages

  bool quaternion() const { return columns.size() == 4; }
  const std::string& name() const { return columns.front(); }
};

/// A recorded trial: rows of numbers in SI.
struct Log {
  std::string label;  ///< unique: file stem, with the window when a file gives several logs
  std::filesystem::path file;
  std::string variable;        ///< of a MAT file
  std::vector<double> window;  ///< [begin, end] in log time [s], or empty
  std::string trial, condition;
  bool train = true;
  std::vector<Change> set;  ///< known values of this log
  std::string set_where;    ///< file:line: key of these, for messages
  /// [joint] position and speed at the first row, where they are known: of hinges and slides.
  std::map<std::string, std::array<double, 2>> start;

  std::vector<double> time;                   ///< [s] in model time, increasing
  std::optional<double> begin;                ///< [s] of the whole recording; empty: time.front()
  std::vector<std::vector<double>> input;     ///< [input][row]
  std::vector<std::vector<bool>> enable;      ///< [input][row], empty when always on
  std::vector<std::vector<double>> measured;  ///< [channel][row] SI; NaN: not measured

  std::size_t rows() const { return time.size(); }
  /// When the recording began, of which this may be a window.
  double Begin() const { return begin.value_or(time.front()); }
};

/// One number that a fit may move.
struct Parameter {
  enum class Per { kAll, kLog, kCondition };
  std::string name, target, attribute;
  double initial = 0, lower = 0, upper = 0;
  bool has_initial = false;
  Change::Operation operation =
      Change::Operation::kSet;  ///< kScale: of what the model or `set` has
  bool frozen = false;
  Per per = Per::kAll;
  std::string condition = {};  ///< acts on the logs of this one only; empty: on all
  std::string where;           ///< file:line: key, for messages
  std::string unit;            ///< empty: that of its target

  /// Where it begins: as given, else at what changes nothing; present() gives what is there.
  template <class Present>
  double Start(Present&& present) const {
    if (has_initial) return initial;
    if (operation == Change::Operation::kScale) return 1;
    return operation == Change::Operation::kAdd ? 0 : present();
  }
};

/// A law that the experiment itself writes, as a formula.
struct WrittenLaw {
  std::string name;     ///< what results call it
  std::string formula;  ///< of q, v (a dry friction: also load) and the names of the parameters
  std::vector<Parameter> parameters;  ///< without target
  std::vector<double> null;  ///< [parameter] at which the law does nothing; NaN: it has none
};

/// An effect the diagnosis may try.
struct Candidate {
  std::string effect;
  std::string where;  ///< "joint:GLOB", "tendon:GLOB", …; empty: everywhere it makes sense
  bool per_condition = false;
  std::optional<WrittenLaw> law = {};

  const std::string& Name() const { return law ? law->name : effect; }
  bool operator==(const Candidate& o) const {
    return Name() == o.Name() && where == o.where && per_condition == o.per_condition;
  }
};

/// Everything a replay, a fit or a diagnosis needs, from one EXPERIMENT.yaml.
struct Experiment {
  enum class Start { kRest, kEquilibrium, kMeasured, kEstimate };
  enum class Folds { kTrial, kCondition, kWindow };

  std::filesystem::path file, model;
  std::string time_column = "time", time_unit = "s";
  double skew = 0;
  Start start = Start::kRest;
  bool quasi_static = false;  ///< rows in order, each at rest: sim/simulation/quasi_static.h
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  Registration registration;
  std::vector<Log> logs;
  std::vector<Parameter> parameters;
  bool all_candidates = true;
  std::vector<Candidate> candidates;
  std::vector<Folds> folds{Folds::kTrial};
  double soft = 0;  ///< residuals beyond this size count linearly in a fit [residual unit]; 0: off

  /// Channels are the columns of all outputs, in order; a quaternion has four.
  struct Channel {
    std::string name, unit;
    std::size_t output, component;
    double factor;  ///< SI per unit
  };
  std::vector<Channel> channels;

  /// The candidate with a law of this name that the experiment writes, or null.
  const Candidate* Written(std::string_view name) const;
  /// Reads the file, its logs included. Throws Error with file:line and key.
  static Experiment Read(const std::filesystem::path& file);
};

}  // namespace continuum
