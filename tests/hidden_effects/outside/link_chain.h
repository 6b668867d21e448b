#pragma once

#include <cmath>

#include <Eigen/Dense>

namespace continuum::hidden {

/// N links in a vertical plane, hanging from a base, by the equations of absolute angles
/// φ_i = q_1 + … + q_i from straight down:
///
///   Σ_j B_ij cos(φ_i − φ_j) φ̈_j + Σ_j B_ij sin(φ_i − φ_j) φ̇_j² + g S_i sin φ_i = Q_i
///   B_ij = Σ_k m_k a_ik a_jk,  S_i = Σ_k m_k a_ik,  a_ik = l_i (i < k), c_k (i = k), 0 (i > k)
///
/// and summed over the links beyond each joint for the joints' own angles q.
template <int N>
struct LinkChain {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  Vector l, c, m, I;                 ///< m, m from the joint, kg, kg m² about the centre
  Vector armature = Vector::Zero();  ///< kg m²
  double payload = 0;                ///< kg at the tip

  /// To be called when the numbers above are set.
  void Prepare() {
    B.setZero(), S.setZero();
    for (int k = 0; k <= N; ++k) {  // link N is the payload
      const double mass = k < N ? m[k] : payload;
      Vector a = Vector::Zero();
      for (int i = 0; i < N; ++i) a[i] = i < k ? l[i] : i == k ? c[k] : 0;
      B += mass * a * a.transpose();
      S += mass * a;
    }
  }

  Matrix Inertia(const Vector& q) const {
    const Vector phi = Absolute(q);
    Matrix A;
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) A(i, j) = B(i, j) * std::cos(phi[i] - phi[j]);
      A(i, i) += I[i];
    }
    for (int i = N - 2; i >= 0; --i) A.row(i) += A.row(i + 1);
    for (int j = N - 2; j >= 0; --j) A.col(j) += A.col(j + 1);
    A.diagonal() += armature;
    return A;
  }
  /// Torques of gravity at the joints.
  Vector Gravity(const Vector& q) const {
    const Vector phi = Absolute(q);
    Vector f;
    for (int i = 0; i < N; ++i) f[i] = -9.81 * S[i] * std::sin(phi[i]);
    return Beyond(f);
  }
  /// Torques of the speeds alone at the joints.
  Vector Centrifugal(const Vector& q, const Vector& v) const {
    const Vector phi = Absolute(q), rate = Absolute(v);
    Vector f = Vector::Zero();
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) f[i] -= B(i, j) * std::sin(phi[i] - phi[j]) * rate[j] * rate[j];
    }
    return Beyond(f);
  }
  /// Down and aside of the tip [m].
  Eigen::Vector2d Tip(const Vector& q) const {
    const Vector phi = Absolute(q);
    Eigen::Vector2d tip(0, 0);
    for (int i = 0; i < N; ++i) tip += l[i] * Eigen::Vector2d(std::cos(phi[i]), std::sin(phi[i]));
    return tip;
  }

 private:
  static Vector Absolute(const Vector& q) {
    Vector sum = q;
    for (int i = 1; i < N; ++i) sum[i] += sum[i - 1];
    return sum;
  }
  static Vector Beyond(Vector f) {
    for (int i = N - 2; i >= 0; --i) f[i] += f[i + 1];
    return f;
  }

  Matrix B;
  Vector S;
};

}  // namespace continuum::hidden
