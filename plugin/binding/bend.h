#pragma once

#include <cstddef>
#include <span>

namespace continuum {

/// Contacts of a cable between which nothing moves, and the moving segment behind them.
struct Bend {
  int cable, segment;  ///< segment as CableGeometry counts them
  double band;    ///< largest |ρ|, ρ = log(tension behind/tension before), sum over the contacts
  double grown;   ///< exp(band)
  double memory;  ///< ρ of the last step
  double speed;   ///< v, > 0 when pulled toward the actuator, as the step begins [m/s]
  double level;   ///< log(tension behind/base tension) of the last step
  bool fresh;     ///< no step has gone before

  int side = 0;                   ///< ±1: slides with ρ = ±band; 0: at rest
  double tension = 0, ratio = 1;  ///< behind it [N]; the same by that before it
  bool given = false;             ///< slides as its side says, whatever it is at the step's end
  double turned = 0;              ///< τ of (5): part of the step on the other side
};

/// How the tension behind a bend follows that before it, once it is known who slides which way:
///
///   t_g = ratio t_{g−1} − yield v_g − drop,   drop = yield (v_g⁺ − v_g)            (1)
struct Part {
  double ratio;   ///< exp of ρ when sliding, else of memory
  double yield;   ///< d tension/d v of a bend at rest [N s/m]; 0: it slides
  double drop;    ///< found with v⁺ [N]
  double spring;  ///< the yield of one that slides, were it at rest; 0 where the cable has no give
  int better;     ///< side it should have
};

inline bool IsFirst(std::span<const Bend> bends, std::size_t g) {
  return g == 0 || bends[g - 1].cable != bends[g].cable;
}
inline bool IsLast(std::span<const Bend> bends, std::size_t g) {
  return g + 1 == bends.size() || bends[g + 1].cable != bends[g].cable;
}

}  // namespace continuum
