#pragma once

#include <string>
#include <string_view>

#include "experiments/harness/case.h"

/// A finished case as one line of text, for the journal and for the way from one process to another.
namespace touchstone::harness {

/// JSON on one line, without a line break. Bytes that are not UTF-8 (of an engine's message, say) are
/// replaced.
/// @param key  of the case, as case_key() has it
std::string case_text(const std::string& key, const FinishedCase& finished);

struct KeyedCase {
  std::string key;
  FinishedCase finished;
};
/// What case_text() wrote. @throws std::exception if `text` is anything else
KeyedCase parse_case_text(std::string_view text);

}  // namespace touchstone::harness
