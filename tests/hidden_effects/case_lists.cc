#include "hidden_effects/case_lists.h"

#include <iterator>
#include <utility>

#include "binding/effect_catalog.h"
#include "hidden_effects/outside/cases.h"

namespace continuum::hidden {
namespace {

constexpr double kFactors[] = {0.125, 0.25, 0.5, 1, 2, 4};

constexpr const char* kPairs[][2] = {
    {"payload", "coulomb"},           {"cubic_stiffness", "sensor_scale"},
    {"input_gain", "coulomb"},        {"gravity_tilt", "armature"},
    {"payload", "sensor_delay"},      {"coulomb", "input_offset"},
    {"dead_time", "cubic_stiffness"}, {"external_force", "armature"}};

bool Known(const std::string& effect) {
  for (const EffectInfo& info : Catalog()) {
    if (info.name == effect) return true;
  }
  return false;
}

void AddNone(const std::string& robot, NoiseKind noise, int times, std::vector<Case>& all) {
  for (int n = 0; n < times; ++n) all.push_back({{}, 1, noise, all.size() + 1, true, false, robot});
}

}  // namespace

std::vector<Case> Cases(const std::string& robot, int repeats) {
  std::vector<Case> all;
  for (int r = 0; r < repeats; ++r) {
    for (int kind = 0; kind < 5; ++kind) AddNone(robot, static_cast<NoiseKind>(kind), 4, all);
    int turn = r;
    const auto add = [&](std::vector<std::string> effects, double factor, bool listed) {
      const auto noise = static_cast<NoiseKind>(turn++ % 5);
      all.push_back({std::move(effects), factor, noise, all.size() + 1, listed, false, robot});
    };
    if (robot == "arm") {
      for (const auto& pair : kPairs) add({pair[0], pair[1]}, 2, true);
    }
    for (const Hidden& h : RobotNamed(robot).effects) {
      if (!Known(h.name)) continue;
      for (const double factor : kFactors) add({h.name}, factor, true);
      add({h.name}, 2, false);
    }
  }
  return all;
}

std::vector<Case> QuickCases(const std::string& robot) {
  std::vector<Case> all;
  AddNone(robot, NoiseKind::kWhite, 2, all);
  for (const Hidden& h : RobotNamed(robot).effects) {
    if (!Known(h.name)) continue;
    for (const double factor : {1.0, 2.0})
      all.push_back({{h.name}, factor, NoiseKind::kWhite, all.size() + 1, true, false, robot});
  }
  return all;
}

std::vector<Case> BackgroundCases(int repeats) {
  std::vector<Case> all;
  for (int r = 0; r < repeats; ++r) {
    for (const Hidden& h : RobotNamed("arm").effects) {
      if (!Known(h.name)) continue;
      for (const bool hidden : {true, false}) {
        Case c{{}, 1, NoiseKind::kWhite, 1000 * all.size() + 17};
        if (hidden) c.effects = {h.name};
        c.background = true;
        all.push_back(std::move(c));
      }
    }
  }
  return all;
}

std::vector<Case> SpoiltCases(int repeats) {
  std::vector<Case> all;
  for (int r = 0; r < repeats; ++r) {
    for (const char* const how : {"turned", "late", "flipped", "exchanged"}) {
      for (int kind = 0; kind < 5; ++kind) {
        Case c{{}, 1, static_cast<NoiseKind>(kind), 7000 + all.size()};
        c.spoilt = how;
        all.push_back(std::move(c));
      }
    }
  }
  return all;
}

std::vector<Case> AllCases(int repeats) {
  std::vector<Case> all;
  const auto add = [&](std::vector<Case> some) {
    all.insert(all.end(), std::make_move_iterator(some.begin()),
               std::make_move_iterator(some.end()));
  };
  for (const char* const robot : {"arm", "servo", "silverbox", "bouc_wen", "spa", "annelida"})
    add(Cases(robot, repeats));
  add(OutsideCases(false));
  add(BackgroundCases(repeats));
  add(SpoiltCases(repeats));
  return all;
}

std::vector<Case> DescribedCases(std::vector<Case> cases) {
  std::erase_if(cases, [](const Case& c) { return c.effects.size() != 1 || !c.listed; });
  for (Case& c : cases) c.told = true;
  return cases;
}

}  // namespace continuum::hidden
