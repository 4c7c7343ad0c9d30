"""What stands beside each adapter: baselines/engines/<engine>.toml."""

import tomllib

from plotting.errors import InputProblem

KEYS = {"name": str, "package": str, "methods": list, "about": str, "effect_of_skin": str, "settings": dict}
OPTIONAL = {"polygons": dict, "causes": list}


def check(path, note):
    for key, kind in KEYS.items():
        if not isinstance(note.get(key), kind):
            raise InputProblem(f"{path}: {key}: a {kind.__name__} is missing")
    unknown = set(note) - set(KEYS) - set(OPTIONAL)
    if unknown:
        raise InputProblem(f"{path}: {', '.join(sorted(unknown))}: unknown, allowed: {', '.join([*KEYS, *OPTIONAL])}")


def read_notes(directory):
    """One note an engine, sorted by name. @raises InputProblem if one is malformed"""
    notes = []
    for path in sorted(directory.glob("*.toml")):
        try:
            note = tomllib.loads(path.read_text(encoding="utf-8"))
        except tomllib.TOMLDecodeError as error:
            raise InputProblem(f"{path}: {error}") from None
        check(path, note)
        notes.append(note)
    return sorted(notes, key=lambda note: note["name"].lower())


def cause(note, method, scenario, dimension):
    """Why `method` is off on a scenario, as far as it is known; empty if it is not."""
    texts = [one["text"] for one in note.get("causes", [])
             if method in one["methods"] and scenario in one["scenarios"] and one.get("dimension", dimension) == dimension]
    return "; ".join(texts)
