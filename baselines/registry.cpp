#include "baselines/registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

#include "baselines/blas.h"
#include "baselines/engines/engines.h"
#include "baselines/formulations/extrapolated.h"
#include "baselines/formulations/implicit_ncp.h"
#include "baselines/formulations/stewart_trinkle.h"
#include "core/model/errors.h"

namespace touchstone {

namespace {

std::string no_library() { return {}; }

/// Our own formulations; they have no version but the repository's.
template <int Dim>
constexpr std::array kFormulations = {
    MethodEntry<Dim>{"implicit_ncp",
                     "Geometrically implicit NCP time-stepper (Chakraborty et al. 2007, Eqs. 10-11)",
                     &make_implicit_ncp<Dim>, &no_library},
    MethodEntry<Dim>{
        "implicit_ncp_extrapolated",
        "implicit_ncp at h and h/2, run side by side and combined (Richardson), with an error estimate",
        &make_extrapolated<Dim, &make_implicit_ncp<Dim>>, &no_library},
    MethodEntry<Dim>{"stewart_trinkle",
                     "LCP time-stepper, linearised gaps, friction pyramid (Stewart & Trinkle 1996)",
                     &make_stewart_trinkle<Dim>, &no_library},
    MethodEntry<Dim>{"stewart_trinkle_extrapolated",
                     "stewart_trinkle at h and h/2, run side by side and combined (Richardson): a control",
                     &make_extrapolated<Dim, &make_stewart_trinkle<Dim>>, &no_library},
};

template <int Dim>
std::span<const MethodEntry<Dim>> engine_entries(const engines::Rows& rows) {
  if constexpr (Dim == 2) {
    return rows.planar;
  } else {
    return rows.spatial;
  }
}

/// Once, before anybody can have made an engine: no thread is then within BLAS.
template <int Dim>
std::vector<MethodEntry<Dim>> sorted_table() {
  use_same_blas_everywhere();
  std::vector<MethodEntry<Dim>> table(kFormulations<Dim>.begin(), kFormulations<Dim>.end());
  for (const auto& rows : engines::all_rows()) {
    const auto entries = engine_entries<Dim>(rows);
    table.insert(table.end(), entries.begin(), entries.end());
  }
  std::sort(table.begin(), table.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  return table;
}

}  // namespace

template <int Dim>
std::span<const MethodEntry<Dim>> methods() {
  static const std::vector<MethodEntry<Dim>> table = sorted_table<Dim>();
  return table;
}

template <int Dim>
const MethodEntry<Dim>& find_method(std::string_view key, std::span<const MethodEntry<Dim>> table) {
  std::vector<std::string_view> known;
  for (const auto& entry : table) {
    if (entry.key == key) return entry;
    known.push_back(entry.key);
  }
  throw InputError("method", fmt::format("'{}'", key), fmt::format("one of {}", fmt::join(known, ", ")));
}

template std::span<const MethodEntry<2>> methods<2>();
template std::span<const MethodEntry<3>> methods<3>();
template const MethodEntry<2>& find_method<2>(std::string_view, std::span<const MethodEntry<2>>);
template const MethodEntry<3>& find_method<3>(std::string_view, std::span<const MethodEntry<3>>);

}  // namespace touchstone
