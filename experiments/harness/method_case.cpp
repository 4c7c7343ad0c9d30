#include "experiments/harness/method_case.h"

#include <chrono>
#include <nlohmann/json.hpp>

#include "baselines/isolation.h"

namespace touchstone::harness {

namespace {

constexpr std::chrono::seconds kTimeToLoad{60};
/// What a child answers instead of options when they are bad: no JSON.
constexpr const char* kBadInput = "bad input";

std::optional<Options> make_here(const std::function<Options()>& make) {
  try {
    return make();
  } catch (const Unsupported&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<Options> options_made_with(const std::function<Options()>& make, bool is_engine) {
  if (!is_engine) return make_here(make);
  const IsolatedResult made = run_isolated(
      [&] {
        try {
          return nlohmann::json(make()).dump();
        } catch (const InputError&) {
          return std::string(kBadInput);
        }
      },
      kTimeToLoad);
  if (made.outcome != Outcome::finished) return std::nullopt;
  if (made.text == kBadInput) return make_here(make);  // throws what it threw there
  return nlohmann::json::parse(made.text).get<Options>();
}

}  // namespace touchstone::harness
