#!/usr/bin/python3
"""What libtalus.so shows to a host: the functions of capi/exports.txt and nothing else, and what it needs from the system.

Usage: check_library.py LIST LIBRARY. Exit status 1 and one line a difference otherwise.
"""
import pathlib
import re
import subprocess
import sys

# Nothing else may come in (threads are oneTBB's): no SUNDIALS or SuiteSparse of the system's (linked statically), no OpenMP, no MPI.
MAY_NEED = re.compile(r"(libcapnp(-json)?|libkj)-[\d.]+\.so|(libstdc\+\+|libm|libgcc_s|libc|libtbb|ld-linux-x86-64)\.so\.\d+")


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def exported(library):
    symbols = [line.split()[-2:] for line in output("nm", "-D", "--defined-only", library).splitlines()]
    return {name.split("@")[0] for kind, name in symbols if kind != "A"}  # A: the version's own name


def dynamic(library, tag):
    return re.findall(rf"\({tag}\).*\[(.*)\]", output("readelf", "-dW", library))


def differences(listed, library):
    yield from (f"{name} is not exported" for name in sorted(listed - exported(library)))
    yield from (f"{name} is exported, but not listed" for name in sorted(exported(library) - listed))
    yield from (f"{name} is needed" for name in dynamic(library, "NEEDED") if not MAY_NEED.fullmatch(name))
    if dynamic(library, "SONAME") != ["libtalus.so.0"]:
        yield f"SONAME is {dynamic(library, 'SONAME')}"


def main():
    listed = set(pathlib.Path(sys.argv[1]).read_text().split())
    found = list(differences(listed, sys.argv[2]))
    print("\n".join(found) or f"{len(listed)} functions, as listed")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
