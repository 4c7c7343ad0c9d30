#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace touchstone {

/// An integral and a bound of its error that holds for integrands smooth on the scale of the last intervals.
template <typename Value>
struct Quadrature {
  Value value;
  double error = 0.0;
};

/// The integral of a vector function over [from, to] by the 15-point Gauss-Kronrod rule on intervals that are
/// halved where the 7-point Gauss rule disagrees most (QUADPACK's QAG; Piessens et al. 1983): kinks are
/// closed in upon geometrically.
/// @param integrand  double -> an Eigen column of fixed size
/// @param tolerance  on the largest component's error
template <typename Value, typename Integrand>
class AdaptiveQuadrature {
 public:
  AdaptiveQuadrature(const Integrand& integrand, double tolerance)
      : integrand_(integrand), tolerance_(tolerance) {}

  [[nodiscard]] Quadrature<Value> over(double from, double to) const {
    constexpr std::size_t kMaximumIntervals = 2000;
    std::vector<Piece> heap{piece(from, to)};
    double error = heap.front().error;
    while (error > tolerance_ && heap.size() < kMaximumIntervals) {
      std::pop_heap(heap.begin(), heap.end());
      const Piece worst = heap.back();
      heap.pop_back();
      const double middle = 0.5 * (worst.from + worst.to);
      for (const Piece& half : {piece(worst.from, middle), piece(middle, worst.to)}) {
        heap.push_back(half);
        std::push_heap(heap.begin(), heap.end());
      }
      error = 0;
      for (const Piece& p : heap) error += p.error;
    }
    Quadrature<Value> sum{Value::Zero(), error};
    for (const Piece& p : heap) sum.value += p.value;
    return sum;
  }

 private:
  struct Piece {
    double from;
    double to;
    Value value;
    double error;
    bool operator<(const Piece& other) const { return error < other.error; }
  };

  [[nodiscard]] Piece piece(double from, double to) const {
    // Nodes >= 0 of the Kronrod rule, its weights, and the weights of the Gauss rule on every second node.
    static constexpr std::array<double, 8> kNode = {
        0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
        0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
        0.586087235467691130294144691693019, 0.405845151377397166906606412076961,
        0.207784955007898467600689403773245, 0.0};
    static constexpr std::array<double, 8> kKronrod = {
        0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
        0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
        0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
        0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
    static constexpr std::array<double, 4> kGauss = {
        0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
        0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
    const double middle = 0.5 * (from + to);
    const double half = 0.5 * (to - from);
    Value kronrod = Value::Zero();
    Value gauss = Value::Zero();
    for (std::size_t k = 0; k < kNode.size(); ++k) {
      Value at = integrand_(middle + half * kNode[k]);
      if (kNode[k] > 0) at += integrand_(middle - half * kNode[k]);
      kronrod += kKronrod[k] * at;
      if (k % 2 == 1) gauss += kGauss[k / 2] * at;
    }
    return {from, to, half * kronrod, half * (kronrod - gauss).cwiseAbs().maxCoeff()};
  }

  const Integrand& integrand_;
  double tolerance_;
};

}  // namespace touchstone
