"""Tidy CSV files as tables of text, with numbers on request and messages that name file, line and column."""

import csv
import math
from pathlib import Path

from .errors import InputProblem, IoProblem


class Table:
    """Rows of a CSV file; `where` filters them, `numbers` reads a column."""

    def __init__(self, path, columns, rows):
        self.path = path
        self.columns = columns
        self.rows = rows  # each (line number, {column: text})

    def __len__(self):
        return len(self.rows)

    def where(self, **wanted):
        """The rows whose columns equal `wanted`: by value for numbers, by letter for text.

        @raises InputProblem if a column is not there
        """
        self.require(wanted)

        def equal(line, row, column, value):
            if isinstance(value, str):
                return row[column] == value
            return self._number(line, row, column) == value

        rows = [(line, row) for line, row in self.rows if all(equal(line, row, c, v) for c, v in wanted.items())]
        return Table(self.path, self.columns, rows)

    def groups(self, column):
        """(number, rows) for every number in `column`, ascending; rows without a number are left out."""
        values = sorted({v for v in self.numbers(column) if not math.isnan(v)})
        return [(value, self.where(**{column: value})) for value in values]

    def texts(self, column):
        self.require([column])
        return [row[column] for _, row in self.rows]

    def numbers(self, column):
        """The column as floats; an empty cell is NaN."""
        self.require([column])
        return [self._number(line, row, column) for line, row in self.rows]

    def require(self, columns):
        missing = [column for column in columns if column not in self.columns]
        if missing:
            raise InputProblem(f"{self.path}: no column {', '.join(missing)}; it has {', '.join(self.columns)}")

    def require_rows(self, what):
        """Returns itself. @raises InputProblem if it is empty, saying that `what` is not in the file"""
        if not self.rows:
            raise InputProblem(f"{self.path}: no rows of {what}")
        return self

    def _number(self, line, row, column):
        text = row[column]
        try:
            return float(text) if text else math.nan
        except ValueError:
            raise InputProblem(f"{self.path}:{line}: {column}: got {text!r}, allowed: a number or nothing") from None


def read_table(path, columns):
    """The CSV file at `path`. @raises InputProblem if it is not there or lacks one of `columns`"""
    path = Path(path)
    try:
        with path.open(newline="", encoding="utf-8") as file:
            reader = csv.reader(file)
            header = next(reader, None)
            if header is None:
                raise InputProblem(f"{path}: empty file, a header line is expected")
            rows = []
            for cells in reader:
                if len(cells) != len(header):
                    raise InputProblem(f"{path}:{reader.line_num}: {len(cells)} cells, the header has {len(header)}")
                rows.append((reader.line_num, dict(zip(header, cells))))
    except FileNotFoundError:
        raise InputProblem(f"{path}: no such file; the experiment writes it") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputProblem(f"{path}: not a CSV file: {error}") from None
    except OSError as error:
        raise IoProblem(f"{path}: cannot be read: {error.strerror}") from None
    table = Table(path, header, rows)
    table.require(columns)
    return table
