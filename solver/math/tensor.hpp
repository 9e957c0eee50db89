#pragma once
// Symmetric tensors of plane strain. Trace, deviator and shear rate live here and nowhere else.
//
// Plane strain has no strain across the plane but a deviator there: dev(e)_zz = -tr(e)/3. A deviatoric tensor therefore
// carries xx, yy, xy and its zz = -(xx + yy) is implied.

#include <cmath>

#include "math/vec2.hpp"

namespace talus {

/// A general tensor of the plane: velocity gradient L_ab = dv_a/dx_b.
struct Mat2 {
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;
};

/// A symmetric tensor of the plane.
struct Sym2 {
  double xx = 0.0, yy = 0.0, xy = 0.0;
  constexpr bool operator==(const Sym2&) const = default;
};

/// A deviatoric symmetric tensor of plane strain; zz = -(xx + yy).
struct Dev {
  double xx = 0.0, yy = 0.0, xy = 0.0;
  constexpr double zz() const { return -(xx + yy); }
  constexpr bool operator==(const Dev&) const = default;
};

constexpr Sym2 operator+(Sym2 a, Sym2 b) { return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy}; }
constexpr Sym2 operator*(double s, Sym2 a) { return {s * a.xx, s * a.yy, s * a.xy}; }
constexpr Vec2 operator*(Sym2 a, Vec2 v) { return {a.xx * v.x + a.xy * v.y, a.xy * v.x + a.yy * v.y}; }
constexpr Dev operator+(Dev a, Dev b) { return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy}; }
constexpr Dev operator*(double s, Dev a) { return {s * a.xx, s * a.yy, s * a.xy}; }

constexpr double trace(Mat2 L) { return L.xx + L.yy; }
/// e = (L + L^T)/2, [Z20] Eq. 9 with the sign of v_j - v_i (the printed one is minus the strain rate).
constexpr Sym2 strain_rate(Mat2 L) { return {L.xx, L.yy, 0.5 * (L.xy + L.yx)}; }
/// omega_xy of omega = (L - L^T)/2.
constexpr double spin(Mat2 L) { return 0.5 * (L.xy - L.yx); }
/// dev(e) = e - tr(e)/3 I with the 3D trace, [Z20] Eq. 8.
constexpr Dev deviator(Sym2 e) {
  const double third = (e.xx + e.yy) / 3.0;
  return {e.xx - third, e.yy - third, e.xy};
}
/// d:d over all nine components.
constexpr double double_dot(Dev d) { return d.xx * d.xx + d.yy * d.yy + d.zz() * d.zz() + 2.0 * d.xy * d.xy; }
/// sqrt(t:t/2), the magnitude that simple shear of stress tau gives as tau.
inline double magnitude(Dev t) { return std::sqrt(0.5 * double_dot(t)); }

/// sigma = -p I + t.
constexpr Sym2 cauchy(double p, Dev t) { return {t.xx - p, t.yy - p, t.xy}; }

/// The tensor with its shear on the plane of unit normal n turned round: what a smooth wall mirrors.
constexpr Sym2 mirrored(Sym2 s, Vec2 n) {
  const Vec2 t{-n.y, n.x};
  const double s_tn = dot(t, s * n);
  return {s.xx - 2.0 * s_tn * 2.0 * n.x * t.x, s.yy - 2.0 * s_tn * 2.0 * n.y * t.y,
          s.xy - 2.0 * s_tn * (n.x * t.y + n.y * t.x)};
}

}  // namespace talus
