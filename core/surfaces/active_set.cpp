#include "core/surfaces/active_set.h"

#include <algorithm>

#include "core/surfaces/deepest_point.h"
#include "core/surfaces/normal_combination.h"

namespace touchstone {

namespace {
/// A multiplier below 0 by no more than this is 0; normals are of unit length.
constexpr double kRounding = 1e-14;
}  // namespace

template <int Dim>
ActiveSet<Dim>::ActiveSet(const ConvexSurface<Dim>& surface, const Vector<Dim>& x, const Vector<Dim>& normal,
                          double slack)
    : surface_(&surface), x_(x) {
  const NormalCombination<Dim> start = normal_combination(surface, x, normal, slack);
  for (int k = 0; k < start.size; ++k) {
    append(start.index[static_cast<std::size_t>(k)], start.multiplier[static_cast<std::size_t>(k)]);
  }
  update();
}

template <int Dim>
bool ActiveSet<Dim>::exchange(double tolerance) {
  const int before = size();
  for (int k = size() - 1; k >= 0; --k) {
    if (multipliers_[k] < -kRounding) remove(k);
  }
  const bool removed = size() != before;
  const int worst = largest_inequality(*surface_, x_);
  const bool known = std::find(index_.begin(), index_.begin() + size(), worst) != index_.begin() + size();
  if (known || size() == Dim || !(surface_->value(worst, x_) > tolerance)) return removed;
  append(worst, 0.0);
  return true;
}

template <int Dim>
void ActiveSet<Dim>::update() {
  values_.resize(size());
  gradients_.resize(Dim, size());
  normal_.setZero();
  hessian_.setZero();
  for (int k = 0; k < size(); ++k) {
    const SurfaceJet<Dim> jet = surface_->jet(index(k), x_);
    values_[k] = jet.value;
    gradients_.col(k) = jet.gradient;
    normal_ += multipliers_[k] * jet.gradient;
    hessian_ += multipliers_[k] * jet.hessian;
  }
}

template <int Dim>
void ActiveSet<Dim>::remove(int k) {
  const int last = size() - 1;
  index_[static_cast<std::size_t>(k)] = index_[static_cast<std::size_t>(last)];
  multipliers_[k] = multipliers_[last];
  multipliers_.conservativeResize(last);
}

template <int Dim>
void ActiveSet<Dim>::append(int i, double multiplier) {
  const int k = size();
  multipliers_.conservativeResize(k + 1);
  multipliers_[k] = multiplier;
  index_[static_cast<std::size_t>(k)] = i;
}

template class ActiveSet<2>;
template class ActiveSet<3>;

}  // namespace touchstone
