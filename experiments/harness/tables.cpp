#include "experiments/harness/tables.h"

#include <cassert>

namespace touchstone::harness {

namespace {

void append(Row& row, const Row& cells) { row.insert(row.end(), cells.begin(), cells.end()); }

Row identity_cells(const Experiment& experiment, const Case& one) {
  Row row = {experiment.command_line.name};
  append(row, one.id.cells());
  return row;
}

/// The rows that a case has for a table; a single empty one if the table is to have every case.
std::vector<Row> own_rows(const CaseResult& result, std::size_t index, std::size_t width) {
  if (index < result.tables.size() && !result.tables[index].empty()) return result.tables[index];
  return index == 0 ? std::vector<Row>{Row(width)} : std::vector<Row>{};
}

}  // namespace

Row identity_columns(const Experiment& experiment) {
  Row columns = {"experiment", "scenario", "method", "options"};
  append(columns, experiment.sweep_columns);
  append(columns, {"h_s", "until_s"});
  return columns;
}

Table result_table(const Experiment& experiment, std::size_t index, std::span<const Case> cases,
                   const Results& results) {
  const std::vector<std::string>& own = experiment.tables[index].columns;
  Table table{identity_columns(experiment), {}};
  append(table.header, {"status", "reason"});
  append(table.header, own);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CaseResult& result = results[i].value().result;
    for (const Row& cells : own_rows(result, index, own.size())) {
      Row row = identity_cells(experiment, cases[i]);
      append(row, {std::string(to_string(result.status)), result.reason});
      append(row, cells);
      assert(row.size() == table.header.size());
      table.rows.push_back(std::move(row));
    }
  }
  sort_rows(table);
  return table;
}

Table timing_table(const Experiment& experiment, std::span<const Case> cases, const Results& results) {
  Table table{identity_columns(experiment), {}};
  append(table.header, {"status", "wall_s"});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const FinishedCase& finished = results[i].value();
    Row row = identity_cells(experiment, cases[i]);
    append(row, {std::string(to_string(finished.result.status)), number_cell(finished.wall_s)});
    table.rows.push_back(std::move(row));
  }
  sort_rows(table);
  return table;
}

Table case_table(const Experiment& experiment, std::span<const Case> cases) {
  Table table{identity_columns(experiment), {}};
  for (const Case& one : cases) table.rows.push_back(identity_cells(experiment, one));
  return table;
}

}  // namespace touchstone::harness
