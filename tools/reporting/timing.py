"""Time of a step: measured when asked, kept in a table of its own, because no two runs give the same bytes."""

import csv
import io
import json
import subprocess
import tempfile
from pathlib import Path

from plotting.errors import InputProblem, IoProblem

FILE = "step_time.csv"
COLUMNS = ["method", "step_us", "ratio", "processor"]
SPHERES = "sphere_on_spheres "  # what the names of its rows begin with; the others are of the disc
REFERENCE = "stewart_trinkle edges=10"  # what ratios on the disc are to
OURS = "implicit_ncp rolling condensed"
SPHERES_REFERENCE = SPHERES + "stewart_trinkle"
SPHERES_OURS = SPHERES + "implicit_ncp"


def processor():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def measure(program):
    """Runs step_benchmark. @returns the bytes of the table: median processor time of a step, [us]"""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "times.json"
        command = [str(program), f"--benchmark_out={out}", "--benchmark_out_format=json",
                   "--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.05"]
        try:
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            runs = json.loads(out.read_text(encoding="utf-8"))["benchmarks"]
        except (OSError, subprocess.CalledProcessError) as error:
            raise IoProblem(f"{program}: {error}") from None
    medians = {run["run_name"]: run["cpu_time"] / 1000 for run in runs if run.get("aggregate_name") == "median"}
    for name in (REFERENCE, SPHERES_REFERENCE):
        if name not in medians:
            raise InputProblem(f"{program}: no time of '{name}'")
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(COLUMNS)
    for method, microseconds in sorted(medians.items()):
        ratio = microseconds / medians[SPHERES_REFERENCE if method.startswith(SPHERES) else REFERENCE]
        table.writerow([method, f"{microseconds:.3g}", f"{ratio:.2g}" if ratio < 100 else f"{ratio:.0f}", processor()])
    return text.getvalue().encode()


def read(path):
    """{method: row}; empty if it was never measured."""
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if rows and set(COLUMNS) - set(rows[0]):
        raise InputProblem(f"{path}: columns {', '.join(COLUMNS)} are expected")
    return {row["method"]: row for row in rows}
