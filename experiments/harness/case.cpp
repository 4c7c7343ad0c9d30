#include "experiments/harness/case.h"

#include <fmt/format.h>

#include "core/model/errors.h"

namespace touchstone::harness {

std::string_view to_string(CaseStatus status) {
  switch (status) {
    case CaseStatus::ok:
      return "ok";
    case CaseStatus::failed:
      return "failed";
    case CaseStatus::unsupported:
      return "unsupported";
    case CaseStatus::skipped:
      return "skipped";
  }
  return "unknown";
}

CaseStatus parse_case_status(std::string_view text) {
  using enum CaseStatus;
  for (const CaseStatus status : {ok, failed, unsupported, skipped}) {
    if (to_string(status) == text) return status;
  }
  throw InputError("status", fmt::format("'{}'", text), "ok, failed, unsupported, skipped");
}

Row CaseId::cells() const {
  Row row = {scenario, method, options};
  row.insert(row.end(), sweep.begin(), sweep.end());
  row.push_back(number_cell(h));
  row.push_back(number_cell(until));
  return row;
}

}  // namespace touchstone::harness
