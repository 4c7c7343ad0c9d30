"""Command line of tools/report_engines."""

import argparse
import sys
from pathlib import Path

from plotting.errors import PlotError
from plotting.output import write_atomically

from . import timing
from .notes import read_notes
from .page import page

ROOT = Path(__file__).resolve().parents[2]


def arguments(argv):
    parser = argparse.ArgumentParser(
        prog="tools/report_engines",
        description="Writes DIR/engines.md from DIR/closed_forms, DIR/disc_rolling, DIR/engines/capabilities.csv, "
        "DIR/engines/step_time.csv and baselines/engines/*.toml. The same tables give the same bytes.",
        epilog="Exit codes: 0 done, 2 bad usage or input, 3 a file cannot be read or written.",
    )
    parser.add_argument("--results", metavar="DIR", type=Path, default=ROOT / "results", help="(default: results)")
    parser.add_argument("--timing", metavar="PROGRAM", type=Path,
                        help="first measure DIR/engines/step_time.csv with this step_benchmark, on a quiet machine")
    return parser.parse_args(argv)


def run(options):
    measured = options.results / "engines" / timing.FILE
    if options.timing:
        write_atomically(measured, timing.measure(options.timing))
        print(measured)
    elif not measured.exists():
        measured = ROOT / "results" / "engines" / timing.FILE
    text = page(options.results, read_notes(ROOT / "baselines" / "engines"), timing.read(measured))
    write_atomically(options.results / "engines.md", text.encode())
    print(options.results / "engines.md")


def main(argv):
    try:
        run(arguments(argv))
    except PlotError as error:
        print(f"tools/report_engines: {error}", file=sys.stderr)
        return error.exit_code
    return 0
