#pragma once

#include <array>

#include <mujoco/mujoco.h>

namespace continuum {

/// What a free camera has to see: everything that can move, and the fixed geoms within its reach,
/// in all poses that were included.
class Framing {
 public:
  void Include(const mjModel& m, const mjData& d);
  /// What another one has to see.
  void Include(const Framing& other);

  /// Sets a free camera of given direction so that every corner p of the box is inside its picture:
  /// with q = p - center, |q.up| and |q.right|/aspect <= fill tan(fovy/2) (distance + q.forward).
  void Aim(mjvCamera& camera, double fovy, double aspect);

  /// The clipping planes of a model may suit another scale: moves them off what must be seen.
  void KeepFromClipping(mjvScene& scene) const;

  using Vector = std::array<double, 3>;
  /// Along the axes of the world; empty as long as low > high.
  struct Box {
    Vector low, high;

    Box();
    void Add(const Vector& p, const Vector& half = {0, 0, 0});
    void Add(const Box& other);
    bool Empty() const { return low[0] > high[0]; }
    Vector Center() const;
    double Radius() const;
    Vector Corner(int k) const;
  };

 private:
  bool Near(const Box& box) const;

  Box moving_, shown_;
  double nearest_ = 0, farthest_ = 0;
};

}  // namespace continuum
