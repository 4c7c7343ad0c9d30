#include "core/method.h"

namespace touchstone {

std::string_view to_string(StepStatus status) {
  switch (status) {
    case StepStatus::solved:
      return "solved";
    case StepStatus::not_converged:
      return "not_converged";
    case StepStatus::non_finite:
      return "non_finite";
  }
  return "unknown";
}

}  // namespace touchstone
