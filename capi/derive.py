#!/usr/bin/python3
"""Derives from talus.h what must agree with it: the list of exported functions and the ctypes table of the Python binding.

Usage: capi/derive.py           write the derived files
       capi/derive.py --check   compare them with the header; exit status 1 where they differ

The header is regular on purpose: one-line #defines of integers, structs with one member a line, functions marked TALUS_API.
What does not fit that is an error here.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
HEADER = ROOT / "capi/include/talus/talus.h"

VALUES = {"int32_t": "c_int32", "talus_status": "c_int32", "int64_t": "c_int64", "double": "c_double"}
POINTERS = {"void": "c_void_p", "char": "c_char_p"}
HANDLES = {"talus_scene", "talus_engine"}


def fail(message):
    sys.exit(f"{HEADER.name}: {message}")


class Header:
    def __init__(self, text):
        text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
        self.constants = [(name, int(value)) for name, value in
                          re.findall(r"^#define TALUS_(\w+) (-?\d+)\s*$", text, re.MULTILINE)]
        self.callbacks = [(name, result, split(arguments)) for result, name, arguments in
                          re.findall(r"typedef (\w+) \(\*(\w+)\)\(([^)]*)\);", text)]
        self.structs = [(name, members(body)) for body, name in
                        re.findall(r"typedef struct \w+ \{(.*?)\} (\w+);", text, re.DOTALL)]
        self.functions = [(name, result.strip(), split(arguments)) for result, name, arguments in
                          re.findall(r"TALUS_API ([\w ]+?[ *]+)(talus_\w+)\(([^)]*)\);", text)]
        self.initialisers = {name: count_values(body) for name, body in
                             re.findall(r"#define TALUS_\w+_INIT \{ sizeof\((\w+)\)((?:[^\n]*\\\n)*[^\n]*)\}", text)}
        self.check(text)

    def check(self, text):
        if len(re.findall(r"^TALUS_API ", text, re.MULTILINE)) != len(self.functions):
            fail("a function is declared in a way that this script does not read")
        for name, fields in self.structs:
            if fields[0] != ("struct_size", "int32_t", 0):
                fail(f"{name} does not begin with struct_size")
            values = sum(length or 1 for _, _, length in fields)
            if self.initialisers.get(name) != values:
                fail(f"the INIT macro of {name} has {self.initialisers.get(name)} values for {values} members")


def split(arguments):
    """(name, type) of each argument."""
    if arguments.strip() == "void":
        return []
    return [(name, kind.strip()) for kind, name in
            (re.fullmatch(r"(.*?)(\w+)", " ".join(argument.split())).groups() for argument in arguments.split(","))]


def members(body):
    """(name, type, length of an array or 0) of each member."""
    found = []
    for line in filter(None, (line.strip() for line in body.split(";"))):
        match = re.fullmatch(r"(.*?)(\w+)(?:\[(\d+)\])?", line)
        found.append((match[2], match[1].strip(), int(match[3] or 0)))
    return found


def count_values(body):
    return 1 + len(re.findall(r"[\d.]+", body))


def ctype(kind, header):
    """The ctypes expression of a C type."""
    kind = kind.replace("const ", "").strip()
    stars = kind.count("*")
    base = kind.replace("*", "").strip()
    if stars == 0:
        callbacks = {name for name, _, _ in header.callbacks}
        return "None" if base == "void" else base if base in callbacks else VALUES[base]
    if base in POINTERS or base in HANDLES:
        inner = POINTERS.get(base, "c_void_p")
        return inner if stars == 1 else f"POINTER({inner})"
    if stars == 1:
        return f"POINTER({VALUES.get(base, base)})"
    fail(f"a type that this script does not read: {kind}")


def python_table(header):
    lines = ['"""Constants, structs and functions of talus.h. Derived by capi/derive.py; do not edit."""',
             "from ctypes import (CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int32, c_int64, c_void_p)", ""]
    lines += [f"{name} = {value}" for name, value in header.constants]
    lines.append("")
    for name, result, arguments in header.callbacks:
        types = [ctype(result, header)] + [ctype(kind, header) for _, kind in arguments]
        lines.append(f"{name} = CFUNCTYPE({', '.join(types)})")
    for name, fields in header.structs:
        lines += ["", "", f"class {name}(Structure):", "    _fields_ = ["]
        for member, kind, length in fields:
            text = ctype(kind, header) + (f" * {length}" if length else "")
            lines.append(f'        ("{member}", {text}),')
        lines.append("    ]")
    lines += ["", "", "# name: (result, [arguments])", "FUNCTIONS = {"]
    for name, result, arguments in header.functions:
        types = ", ".join(ctype(kind, header) for _, kind in arguments)
        lines.append(f'    "{name}": ({ctype(result, header)}, [{types}]),')
    return "\n".join(lines + ["}", ""])


def derived():
    header = Header(HEADER.read_text())
    return {
        ROOT / "capi/exports.txt": "".join(sorted(f"{name}\n" for name, _, _ in header.functions)),
        ROOT / "bindings/python/talus/_api.py": python_table(header),
    }


def main():
    stale = [path for path, text in derived().items() if not path.exists() or path.read_text() != text]
    if sys.argv[1:] == ["--check"]:
        for path in stale:
            print(f"{path.relative_to(ROOT)} does not agree with talus.h: run capi/derive.py")
        return 1 if stale else 0
    for path in stale:
        path.write_text(derived()[path])
        print(f"wrote {path.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
