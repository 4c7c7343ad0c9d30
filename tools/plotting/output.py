"""The same bytes for the same figure, on disk whole or not at all."""

import io
import os
from pathlib import Path

from .errors import IoProblem

PNG_DOTS_PER_INCH = 160


def render(figure):
    """{suffix: bytes} of a figure as SVG and PNG, without date, software version or random identifiers."""
    title = figure.get_label()
    rendered = {}
    for suffix, options in {
        "svg": {"metadata": {"Title": title, "Date": None, "Creator": None}},
        "png": {"metadata": {"Title": title, "Software": None}, "dpi": PNG_DOTS_PER_INCH},
    }.items():
        buffer = io.BytesIO()
        figure.savefig(buffer, format=suffix, **options)
        rendered[suffix] = buffer.getvalue()
    return rendered


def write_atomically(path, content):
    """Writes beside `path`, syncs, renames. @raises IoProblem, and then `path` is as it was"""
    path = Path(path)
    partial = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        with partial.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except OSError as error:
        raise IoProblem(f"{path}: cannot be written: {error.strerror}") from None
    finally:
        partial.unlink(missing_ok=True)
