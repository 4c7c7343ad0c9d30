#pragma once

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "core/method.h"

namespace touchstone::test {

/// A method that moves nothing, and does what it is told in its third step.
class BadMethod final : public Method<2> {
 public:
  using Misdeed = void (*)(BodyState<2>&);

  BadMethod(Scene<2> scene, Misdeed misdeed)
      : scene_(std::move(scene)), state_(initial_state(scene_)), misdeed_(misdeed) {}

  [[nodiscard]] Capabilities capabilities() const override { return {}; }
  [[nodiscard]] const Scene<2>& scene() const override { return scene_; }
  [[nodiscard]] std::span<const BodyState<2>> state() const override { return state_; }
  [[nodiscard]] std::span<const ContactImpulse<2>> contacts() const override { return {}; }
  [[nodiscard]] StepReport step(double) override {
    if (++steps_ == 3) misdeed_(state_[0]);
    return state_[0].velocity.allFinite() ? StepReport{} : StepReport{.status = StepStatus::non_finite};
  }
  [[nodiscard]] Options effective_options() const override { return {{"a", "1"}}; }

 private:
  Scene<2> scene_;
  std::vector<BodyState<2>> state_;
  Misdeed misdeed_;
  int steps_ = 0;
};

inline void behave(BodyState<2>&) {}
inline void crash(BodyState<2>&) {
  std::signal(SIGSEGV, SIG_DFL);  // a sanitizer has its own handler, which exits
  std::raise(SIGSEGV);
}
inline void give_up(BodyState<2>&) { std::abort(); }
inline void leave(BodyState<2>&) { _exit(7); }
inline void hang(BodyState<2>&) {
  while (true) pause();
}
inline void spoil(BodyState<2>& state) { state.velocity[0] = std::numeric_limits<double>::quiet_NaN(); }

}  // namespace touchstone::test
