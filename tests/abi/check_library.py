#!/usr/bin/python3
"""What libtalus.so shows to a host: the header's functions and nothing else, and what it needs from the system.

Usage: check_library.py HEADER              print the functions that the header declares (capi/exports.txt is this list)
       check_library.py HEADER LIST LIBRARY  compare header, committed list and library; exit status 1 where they differ
"""
import pathlib
import re
import subprocess
import sys

# Nothing else may come in: no SUNDIALS or SuiteSparse of the system's (linked statically), no OpenMP, no MPI.
MAY_NEED = re.compile(r"(libcapnp(-json)?|libkj)-[\d.]+\.so|(libstdc\+\+|libm|libgcc_s|libc|ld-linux-x86-64)\.so\.\d+")


def declared(header):
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", header.read_text(), flags=re.DOTALL)
    text = re.sub(r"^\s*#(.*\\\n)*.*$", "", text, flags=re.MULTILINE)
    return sorted(set(re.findall(r"\b(talus_\w+)\s*\(", text)))


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def exported(library):
    symbols = [line.split()[-2:] for line in output("nm", "-D", "--defined-only", library).splitlines()]
    return sorted(name.split("@")[0] for kind, name in symbols if kind != "A")  # A: the version's own name


def dynamic(library, tag):
    return re.findall(rf"\({tag}\).*\[(.*)\]", output("readelf", "-dW", library))


def differences(header, committed, library):
    functions = declared(header)
    for name, other in {str(committed): committed.read_text().split(), str(library): exported(library)}.items():
        yield from (f"{name}: lacks {function}" for function in functions if function not in other)
        yield from (f"{name}: {function} is not in the header" for function in other if function not in functions)
    yield from (f"{library}: needs {name}" for name in dynamic(library, "NEEDED") if not MAY_NEED.fullmatch(name))
    if dynamic(library, "SONAME") != ["libtalus.so.0"]:
        yield f"{library}: SONAME is {dynamic(library, 'SONAME')}"


def main():
    header, *others = map(pathlib.Path, sys.argv[1:])
    if not others:
        print("\n".join(declared(header)))
        return 0
    found = list(differences(header, *others))
    print("\n".join(found) or f"{len(declared(header))} functions, as declared")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
