#include "experiments/harness/record.h"

#include <algorithm>
#include <stdexcept>

namespace touchstone::harness {

Record& Record::set(std::string_view column, std::string value) {
  const auto it = std::find(columns_.begin(), columns_.end(), column);
  if (it == columns_.end()) throw std::logic_error("no column '" + std::string(column) + "'");
  cells_[static_cast<std::size_t>(it - columns_.begin())] = std::move(value);
  return *this;
}

}  // namespace touchstone::harness
