#!/usr/bin/python3
"""Writes docs/scenes.md from the comments of engine/scene/scene.capnp; with --check, only says whether it is up to date.

Every line of the schema must be one of the forms below, so that nothing is left out in silence."""

import pathlib
import re
import sys

here = pathlib.Path(__file__).resolve().parent
schema_file = here.parent / "engine" / "scene" / "scene.capnp"
page_file = here / "scenes.md"

introduction = """\
<!-- Written by docs/generate_scenes.py from engine/scene/scene.capnp. Do not edit. -->
# Scenes

A scene says what is simulated: soils, ground, boundaries, rain, the initial state. It is JSON text (see `samples/scenes`) or
a Cap'n Proto message of the schema `engine/scene/scene.capnp`, from which this page is written. Both have the same names.

- SI units throughout: m, s, kg, Pa, m/s, and angles in degrees. x is horizontal, y is up. Pore pressures are positive in
  compression, stresses in tension; suction is the negative pore pressure.
- A field that is left out has its default. `-` in the column *default* means that there is none: the number is open, the text or
  list empty.
- Unknown fields, `null`, `NaN` and infinities are errors. So is an entry that would have no effect.
- All problems of a scene are said at once, each with its entry's path, its value and what is allowed:

      soils[0].hydraulics.retention.alpha = 0.04 1/Pa: must be between 1e-08 and 0.01 1/Pa (did you mean 1/kPa or 1/m?)
"""

field_form = re.compile(r"(?P<name>\w+) @\d+ :(?P<type>[\w()]+)(?: = (?P<default>\S+))?(?: \$limits\((?P<limits>.*)\))?;")
enumerant_form = re.compile(r"(?P<name>\w+) @\d+;")
outer_form = re.compile(r"(?P<kind>struct|enum) (?P<name>\w+) \{")
skipped_form = re.compile(r"@0x\w+;|using .*;|\$.*;|const .*;|annotation .*;|union \{|\}|")


def parse(text):
    """The structs and enumerations in order: {name: {kind, comment, members: [{name, type, default, limits, comment}]}}."""
    types = {}
    target = {"comment": []}  # of the next comment
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if line.startswith("#"):
            target["comment"].append(line[1:].strip())
        elif form := outer_form.fullmatch(line):
            target = {"kind": form["kind"], "comment": [], "members": []}
            types[form["name"]] = outer = target
        elif form := field_form.fullmatch(line) or enumerant_form.fullmatch(line):
            target = {**form.groupdict(), "comment": []}
            outer["members"].append(target)
        elif not skipped_form.fullmatch(line):
            sys.exit(f"{schema_file.name}:{number}: not understood: {line}")
    return {name: kind for name, kind in types.items() if name not in ("Limits", "Slip")}


def linked(name):
    return f"[{name}](#{name.lower()})"


def type_text(name, types):
    plain = {"Float64": "number", "Int32": "whole number", "Bool": "true or false", "Text": "text"}
    if name in plain:
        return plain[name]
    if name == "List(List(Float64))":
        return "array of [x, y]"
    if inner := re.fullmatch(r"List\((\w+)\)", name):
        return "array of " + (linked(inner[1]) if inner[1] in types else plain[inner[1]] + "s")
    return linked(name)


def limits_text(limits):
    """Unit and allowed values."""
    if not limits:
        return "", ""
    value = {key: item.strip('"') for key, item in re.findall(r'(\w+) = ("[^"]*"|[-+.\w]+)', limits)}
    unit, low, high = value.get("unit", "-"), value.get("low", "-inf"), value.get("high", "inf")
    allowed = f"{low} to {high}" if high != "inf" else f"at least {low}" if low != "-inf" else ""
    return unit, ("0, " if value.get("orZero") else "") + allowed


def default_text(member):
    if member["default"] in (None, "nan"):
        return "0" if member["type"] == "Int32" else "-"
    return {"inf": "unbounded", "-inf": "unbounded"}.get(member["default"], member["default"])


def struct_lines(members, types):
    yield "| field | type | unit | allowed | default | |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for member in members:
        unit, allowed = limits_text(member["limits"])
        kind, default, comment = type_text(member["type"], types), default_text(member), " ".join(member["comment"])
        if types.get(member["type"], {}).get("kind") == "enum":
            allowed = ", ".join(choice["name"] for choice in types[member["type"]]["members"])
        yield f"| `{member['name']}` | {kind} | {unit} | {allowed} | {default} | {comment} |"


def paths(types):
    """Where each struct is in a scene."""
    found = {"Scene": [""]}
    for name in types:  # a struct comes before those in it
        for member in types[name]["members"]:
            inner = re.fullmatch(r"(?:(List)\()?(\w+?)\)?", member.get("type") or "")
            if inner and inner[2] in types:
                ends = [path + member["name"] + ("[]" if inner[1] else "") for path in found[name]]
                found.setdefault(inner[2], []).extend(end + ("." if types[inner[2]]["kind"] == "struct" else "") for end in ends)
    return found


def page(types):
    yield introduction
    where = paths(types)
    for name, described in types.items():
        yield f"## {name}"
        places = [f"`{path.rstrip('.')}`" for path in where[name] if path]
        yield " ".join(described["comment"] + (["At " + ", ".join(places) + "."] if places else [])) + "\n"
        if described["kind"] == "enum":
            yield from (f"- `{choice['name']}`: {' '.join(choice['comment'])}" for choice in described["members"])
        else:
            yield from struct_lines(described["members"], types)
        yield ""


def main():
    text = "\n".join(page(parse(schema_file.read_text(encoding="utf-8"))))
    if sys.argv[1:] == ["--check"]:
        if not page_file.exists() or page_file.read_text(encoding="utf-8") != text:
            sys.exit("docs/scenes.md is not what docs/generate_scenes.py writes: run it")
        return
    page_file.write_text(text, encoding="utf-8")


main()
