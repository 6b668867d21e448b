#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <set>

#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "effects/all.h"
#include "hidden_effects/suite.h"
#include "identification/catalog.h"
#include "sim/file.h"

namespace continuum::hidden {
namespace {

constexpr double kFactors[] = {0.125, 0.25, 0.5, 1, 2, 4};

bool Known(const std::string& effect) {
  for (const EffectInfo& info : Catalog()) {
    if (info.name == effect) return true;
  }
  return false;
}

// The large suite: every effect at six sizes, nothing hidden, effects that are not listed; noise of
// five kinds in turn.
std::vector<Case> Cases(int repeats) {
  std::vector<Case> all;
  std::uint64_t seed = 1;
  for (int r = 0; r < repeats; ++r) {
    for (int kind = 0; kind < 5; ++kind) {
      const auto noise = static_cast<NoiseKind>(kind);
      for (int n = 0; n < 4; ++n) all.push_back({{}, 1, noise, seed++});
    }
    int turn = r;
    for (const Hidden& h : HiddenEffects()) {
      if (!Known(h.name)) continue;
      for (const double factor : kFactors)
        all.push_back({{h.name}, factor, static_cast<NoiseKind>(turn++ % 5), seed++});
      all.push_back({{h.name}, 2, static_cast<NoiseKind>(turn++ % 5), seed++, false});
    }
  }
  return all;
}

nlohmann::json ToJson(const Case& c, const Answer& a) {
  return {{"case", c.Name()},    {"verdict", a.verdict},     {"named", a.named},
          {"truth", a.truth},    {"value", a.value},         {"low", a.low},
          {"high", a.high},      {"explained", a.explained}, {"next", a.next},
          {"seconds", a.seconds}};
}

int Run(int argc, char** argv) {
  const std::filesystem::path out = argc > 1 ? argv[1] : "hidden_effects.jsonl";
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 1;
  const std::string only = argc > 3 ? argv[3] : "";
  std::set<std::string> done;
  std::ifstream before(out);
  for (std::string line; std::getline(before, line);) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (json.is_object()) done.insert(json.at("case"));
  }
  const auto folder =
      std::filesystem::temp_directory_path() / ("hidden_effects_" + std::to_string(getpid()));
  const auto cases = Cases(repeats);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    if (done.contains(c.Name()) || (!only.empty() && c.Name().find(only) == std::string::npos))
      continue;
    std::filesystem::remove_all(folder);
    nlohmann::json line;
    try {
      const Answer a = Solve(c, folder);
      line = ToJson(c, a);
      if (argc > 4) std::cout << a.detail << std::endl;
    } catch (const std::exception& e) {
      line = {{"case", c.Name()}, {"verdict", "error"}, {"what", e.what()}};
    }
    std::ofstream(out, std::ios::app) << line.dump() << std::endl;
    std::fprintf(stderr, "%zu/%zu %s: %s %s %.1f s\n", i + 1, cases.size(), c.Name().c_str(),
                 line.at("verdict").get<std::string>().c_str(),
                 line.value("named", nlohmann::json::array()).dump().c_str(),
                 line.value("seconds", 0.0));
  }
  std::filesystem::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace continuum::hidden

int main(int argc, char** argv) { return continuum::hidden::Run(argc, argv); }
