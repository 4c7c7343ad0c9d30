"""The two ways in which drawing a figure fails, with the exit code of each."""


class PlotError(Exception):
    """A message for a person; the program prints it and ends with `exit_code`."""

    exit_code = 1


class InputProblem(PlotError):
    """A file, column or value that is missing or malformed, or a bad argument."""

    exit_code = 2


class IoProblem(PlotError):
    """A file that cannot be read or written."""

    exit_code = 3
