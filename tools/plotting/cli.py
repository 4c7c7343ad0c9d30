"""Command line of tools/plot."""

import argparse
import sys
from pathlib import Path

from . import style
from .errors import InputProblem, PlotError
from .output import render, write_atomically
from .registry import EXPERIMENTS

DEFAULT_RESULTS = Path(__file__).resolve().parents[2] / "results"


def arguments(argv):
    parser = argparse.ArgumentParser(
        prog="tools/plot",
        description="Draws the figures of experiments, as SVG and PNG, from the CSV files in the results directory.",
        epilog="Exit codes: 0 done, 2 bad usage or input, 3 a file cannot be read or written.",
    )
    parser.add_argument("experiments", metavar="EXPERIMENT", nargs="*", help="what to draw (default: everything)")
    parser.add_argument("--results", metavar="DIR", type=Path, default=DEFAULT_RESULTS,
                        help="holds DIR/EXPERIMENT/*.csv and receives the figures (default: results)")
    parser.add_argument("--list", action="store_true", help="list experiments and their figures, draw nothing")
    return parser.parse_args(argv)


def draw(experiment, directory):
    """All figures of an experiment: every one is rendered before the first is written.

    Each is closed once it is rendered: pyplot keeps what it has opened, and warns of more than 20.
    """
    rendered = {}
    for name, function in EXPERIMENTS[experiment].items():
        figure = function(directory)
        if figure is None:
            continue
        rendered[name] = render(figure)
        style.plt.close(figure)
    for name, files in rendered.items():
        for suffix, content in files.items():
            path = directory / f"{name}.{suffix}"
            write_atomically(path, content)
            print(path)


def run(options):
    if options.list:
        for experiment, figures in EXPERIMENTS.items():
            print(f"{experiment}: {', '.join(figures)}")
        return
    unknown = [name for name in options.experiments if name not in EXPERIMENTS]
    if unknown:
        raise InputProblem(f"EXPERIMENT: got {', '.join(unknown)}, allowed: {', '.join(EXPERIMENTS)}")
    style.apply()
    for experiment in options.experiments or EXPERIMENTS:
        draw(experiment, options.results / experiment)


def main(argv):
    try:
        run(arguments(argv))
    except PlotError as error:
        print(f"tools/plot: {error}", file=sys.stderr)
        return error.exit_code
    return 0
