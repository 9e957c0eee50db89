// The constitutive models that a run can choose. Included once for every instruction set.

#if defined(TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL
#undef TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL
#else
#define TALUS_MATERIAL_CONSTITUTIVE_MODELS_INL
#endif

#include <hwy/highway.h>

#include <type_traits>

#include "material/bingham-inl.hpp"
#include "material/elastoviscoplastic-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

/// Calls f(std::type_identity of the model's type). A model is constructed from Rheology and has
/// stress(PointState, elastic stress).
template <class Real, class F>
void with_constitutive_model(const Rheology& rheology, F&& f) {
  if (rheology.yield == Yield::regularized)
    f(std::type_identity<RegularisedBingham<Real>>());
  else
    f(std::type_identity<ElastoViscoplastic<Real>>());
}

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
