#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "identification/candidates/hypothesis.h"
#include "identification/diagnosis/verdict.h"

namespace continuum {

/// The effects of a set of causes, each once. One stands for its family; others are its relatives.
class NamesOfASet {
 public:
  void Insert(const Hypothesis& h) { kin_.emplace(h.effect, KinOf(h.Card())); }

  /// Goes to the relatives where the set has one of its family, else to the others; to neither
  /// where the set has it.
  void Add(const Hypothesis& h, std::vector<std::string>& relatives,
           std::vector<std::string>& others) {
    const Kin kin = KinOf(h.Card());
    const bool is_relative =
        std::any_of(kin_.begin(), kin_.end(), [&](const auto& one) { return one.second.Of(kin); });
    if (kin_.emplace(h.effect, kin).second) (is_relative ? relatives : others).push_back(h.effect);
  }

 private:
  std::map<std::string, Kin> kin_;
};

}  // namespace continuum
