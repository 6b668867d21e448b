#pragma once

#include "identification/diagnosis/result.h"
#include "support/pendulum.h"

namespace continuum::testing {

/// A diagnosis of a pendulum and one log, in which nothing was done yet.
class BareDiagnosis : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    AddLog("t0", "trial: t0, use: train", {0, 0}, {0, 0});
    experiment_ = ReadExperiment("");
  }
  Diagnosis Bare() {
    return Diagnosis(experiment_, ModelSpec::Load(Write("model.xml", Pendulum().Xml())));
  }

 private:
  Experiment experiment_;
};

}  // namespace continuum::testing
