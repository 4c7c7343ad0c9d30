#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace touchstone {

/// Accelerates an iteration x -> g(x) by steps that are added to g(x). f(x) = g(x) - x is its change.
///
/// x is made of many blocks of a few entries. Each remembers the iterations itself; this class finds how they
/// are combined. Use: begin(); then in each iteration record() of every block, decide(), and step() of every
/// block.
///
/// Memories are in single precision: they steer the iteration, and do not enter its fixed point.
class SweepAcceleration {
 public:
  enum class Kind {
    /// Anderson (1965; type II of Walker & Ni 2011): the last iterations are combined so that their changes
    /// cancel in the least-squares sense, which is GMRES where g is linear.
    anderson,
    /// Nonlinear conjugate gradients (Silcowitz, Niebe & Erleben 2010): goes on in the last direction for as
    /// long as changes fall. Converges more slowly, but is not led astray by contacts that have just opened
    /// or begun to slide, and gains speed where changes stay the same.
    conjugate_gradients,
  };

 private:
  static constexpr int kDepth = 8;         ///< iterations that are combined
  static constexpr double kRise = 5.0;     ///< factor of |f| at which they are forgotten
  static constexpr double kRidge = 1e-10;  ///< of the Gram matrix's trace: what single precision cannot tell
  /// Of |f|^2: where f stays the same any multiple of it would do; goes on by some 100 iterations at most.
  static constexpr double kHold = 1e-5;
  // Of conjugate gradients, factors of |f|^2:
  static constexpr double kRiseOfDirection = 1.1;  ///< at which they begin anew
  /// Where more contacts stick than the motion needs, some combination of impulses grows at the same rate in
  /// each iteration until one of its contacts slides: where changes stay at more than this of the last ones
  /// ...
  static constexpr double kSteady = 0.98;
  static constexpr double kGrowth = 1.05;  ///< ... the step is lengthened by this one

  using Column = Eigen::Matrix<double, kDepth, 1>;
  using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kDepth, kDepth>;

 public:
  template <int Entries>
  class Block {
   public:
    using Short = Eigen::Matrix<float, Entries, 1>;

    /// @param change  of this block in this iteration
    void record(SweepAcceleration& all, const Short& change) {
      if (all.combines()) {
        const Short difference = change - change_;
        changes_.row(all.slot_) = difference.transpose();
        results_.col(all.slot_) = move_ + difference;
        all.column_ += changes_.lazyProduct(difference).template cast<double>();
        all.right_side_ += changes_.lazyProduct(change).template cast<double>();
      }
      all.squared_ += static_cast<double>(change.squaredNorm());
      change_ = change;
    }
    /// What is to be added to this block. To be asked for once in an iteration.
    [[nodiscard]] Short step(const SweepAcceleration& all) {
      Short step = all.factor_ * move_;
      if (all.kind_ == Kind::anderson) step = -results_.lazyProduct(all.weights_);
      move_ = step + change_;
      return step;
    }
    /// That was recorded last.
    [[nodiscard]] const Short& change() const { return change_; }

   private:
    Eigen::Matrix<float, kDepth, Entries> changes_ = Eigen::Matrix<float, kDepth, Entries>::Zero();
    Eigen::Matrix<float, Entries, kDepth> results_ = Eigen::Matrix<float, Entries, kDepth>::Zero();
    Short change_ = Short::Zero();
    Short move_ = Short::Zero();  ///< change and step of the last iteration
  };

  /// Forgets all iterations.
  void begin(Kind kind) {
    kind_ = kind;
    forget();
    squared_ = last_squared_ = 0;
    is_first_ = true;
  }

  /// Chooses the steps, once all blocks were recorded.
  void decide() {
    if (kind_ == Kind::anderson) {
      combine();
    } else {
      choose_factor();
    }
    last_squared_ = squared_;
    squared_ = 0;
    is_first_ = false;
  }

 private:
  [[nodiscard]] bool combines() const { return kind_ == Kind::anderson && !is_first_; }

  void forget() {
    used_ = slot_ = 0;
    column_.setZero();
    right_side_.setZero();
    weights_.setZero();
    factor_ = 0;
  }

  /// Least squares over the differences of the last iterations.
  void combine() {
    if (!is_first_) {
      used_ = std::max(used_, slot_ + 1);
      gram_.col(slot_) = column_;
      gram_.row(slot_) = column_.transpose();
      slot_ = (slot_ + 1) % kDepth;
    }
    if (squared_ > kRise * kRise * last_squared_) forget();
    if (used_ > 0) {
      Gram gram = gram_.topLeftCorner(used_, used_);
      gram.diagonal().array() += kRidge * gram.trace() + kHold * squared_;
      weights_.head(used_) = gram.ldlt().solve(right_side_.head(used_)).template cast<float>();
    }
    column_.setZero();
    right_side_.setZero();
  }

  void choose_factor() {
    const double ratio = last_squared_ > 0 ? squared_ / last_squared_ : 0.0;
    const double factor = ratio > kRiseOfDirection ? 0.0 : ratio > kSteady ? kGrowth : ratio;
    factor_ = static_cast<float>(factor);
  }

  Kind kind_ = Kind::anderson;
  Eigen::Matrix<double, kDepth, kDepth> gram_ = Eigen::Matrix<double, kDepth, kDepth>::Zero();
  Column column_ = Column::Zero();      ///< of the Gram matrix, of this iteration
  Column right_side_ = Column::Zero();  ///< differences times f
  Eigen::Matrix<float, kDepth, 1> weights_ = Eigen::Matrix<float, kDepth, 1>::Zero();
  float factor_ = 0;           ///< of conjugate gradients
  int used_ = 0;               ///< columns
  int slot_ = 0;               ///< of the next one
  double squared_ = 0.0;       ///< |f|^2 of this iteration, so far
  double last_squared_ = 0.0;  ///< and of the last one
  bool is_first_ = true;
};

}  // namespace touchstone
