"""What stands beside each adapter: baselines/engines/<engine>.toml. An engine may do without: the page then says so."""

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


def without_notes(methods, notes):
    """In the place of notes for those of `methods` that none has, one an engine: what a key begins with, as its .cpp.
    @raises InputProblem if an engine has notes that leave a method of its out"""
    known = {method for note in notes for method in note["methods"]}
    engines = {}
    for method in sorted(set(methods) - known):
        engines.setdefault(method.split("_")[0], []).append(method)
    for note in notes:
        for method in note["methods"]:
            if method.split("_")[0] in engines:
                left_out = ", ".join(engines[method.split("_")[0]])
                raise InputProblem(f"notes of {note['name']}: methods: {left_out}: not among them")
    return [{"name": name, "package": "not noted", "methods": found, "settings": None, "effect_of_skin": "",
             "about": f"Nobody has written notes on this engine. They belong in `baselines/engines/{name}.toml`."}
            for name, found in engines.items()]


def cause(note, method, scenario, dimension):
    """Why `method` is off on a scenario, as far as it is known; empty if it is not."""
    texts = [one["text"] for one in note.get("causes", [])
             if method in one["methods"] and scenario in one["scenarios"] and one.get("dimension", dimension) == dimension]
    return "; ".join(texts)
