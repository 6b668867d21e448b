#pragma once

#include <string>
#include <vector>

#include "identification/problem.h"

namespace continuum {

/// What the model lacks, as a generalized force on one joint, at every row of the logs:
///
///   missing = (M (a_measured − a_model))_j                             (1)
///
/// with the model's acceleration at the measured state (angles and speeds by a local quadratic fit
/// over 11 rows) and its mass matrix M. An equation error: no simulation drifts in it.
struct MissingForce {
  std::string joint;
  bool slides = false;  ///< the joint: m and N, else rad and N m
  std::vector<std::size_t> log;
  std::vector<double> time, angle, velocity, load, force;  ///< SI
};

/// The joint on which most is missing; empty joint when not every joint is measured.
MissingForce FindMissingForce(const Problem& problem, const Problem::Vector& x);

}  // namespace continuum
