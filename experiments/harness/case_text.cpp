#include "experiments/harness/case_text.h"

#include <nlohmann/json.hpp>

namespace touchstone::harness {

using Json = nlohmann::json;

std::string case_text(const std::string& key, const FinishedCase& finished) {
  const CaseResult& result = finished.result;
  return Json{{"case", key},
              {"status", to_string(result.status)},
              {"reason", result.reason},
              {"tables", result.tables},
              {"wall_s", finished.wall_s}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

KeyedCase parse_case_text(std::string_view text) {
  const Json json = Json::parse(text);
  KeyedCase one;
  json.at("case").get_to(one.key);
  one.finished.result.status = parse_case_status(json.at("status").get<std::string>());
  json.at("reason").get_to(one.finished.result.reason);
  json.at("tables").get_to(one.finished.result.tables);
  json.at("wall_s").get_to(one.finished.wall_s);
  return one;
}

}  // namespace touchstone::harness
