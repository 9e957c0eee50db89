#pragma once
// Vectors and tensors of plane strain, for every number type that the laws are written for: double, or Lanes of the
// vectorised loops. What is computed with them stands in tensor-inl.hpp.
//
// Plane strain has no strain across the plane but a deviator there: dev(e)_zz = -tr(e)/3. A deviatoric tensor therefore
// carries xx, yy, xy; its zz = -(xx + yy) is implied.

namespace talus {

/// A vector of the plane.
template <class Real>
struct Vector {
  Real x, y;
};

/// A general tensor of the plane: velocity gradient L_ab = dv_a/dx_b.
template <class Real>
struct Gradient {
  Real xx, xy, yx, yy;
};

/// A symmetric tensor of the plane.
template <class Real>
struct Symmetric {
  Real xx, yy, xy;
};
using Sym2 = Symmetric<double>;

/// A deviatoric symmetric tensor of plane strain; zz = -(xx + yy).
template <class Real>
struct Deviator {
  Real xx, yy, xy;
};

}  // namespace talus
