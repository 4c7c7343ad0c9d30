#include "baselines/formulations/candidate_policy.h"

#include <charconv>
#include <cmath>
#include <string_view>

namespace touchstone {

namespace {

/// The number after `prefix` if that is all there is.
template <typename Number>
bool parse_after(std::string_view text, std::string_view prefix, Number& number) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && stop == text.data() + text.size();
}

}  // namespace

CandidatePolicy read_candidate_policy(OptionReader& read) {
  using Kind = CandidatePolicy::Kind;
  const std::string text = read.text("candidates", "reachable");
  CandidatePolicy policy;
  if (text == "reachable") return policy;
  if (text == "all") {
    policy.kind = Kind::all;
  } else if (parse_after(text, "nearest:", policy.count) && policy.count >= 1) {
    policy.kind = Kind::nearest;
  } else if (parse_after(text, "epsilon:", policy.distance) && policy.distance >= 0 &&
             std::isfinite(policy.distance)) {
    policy.kind = Kind::epsilon;
  } else {
    read.fail(
        "candidates", text,
        "reachable, nearest:k with an integer k >= 1, epsilon:e with a finite number e >= 0 [m], or all");
  }
  return policy;
}

}  // namespace touchstone
