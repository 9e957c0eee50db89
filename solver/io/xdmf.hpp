#pragma once
// XDMF for viewers that cannot read VTKHDF (ParaView < 5.12): light data only, hyperslabs into the VTKHDF file's
// arrays.

#include <cstddef>
#include <span>
#include <string>

namespace talus {

/// The document. Stress comes as the scalars stress_xx, stress_yy, stress_zz, stress_xy, since readers disagree on the
/// order of tensors.
/// @param file       name of the VTKHDF file, which lies beside the document
/// @param particles  points at each step
/// @param times      of the steps [s]
std::string xdmf_document(const std::string& file, std::size_t particles, std::span<const double> times);

}  // namespace talus
