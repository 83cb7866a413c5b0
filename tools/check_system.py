# SPDX-License-Identifier: LGPL-2.1-or-later
"""Says what this machine lacks before anything heavy is installed (standard library only).

Looked at: the Python version, its venv module, the platform (NGSolve has no wheel for some), and
the shared libraries that the gmsh, NGSolve and VTK wheels expect to find on a Linux system. Each
library of the list was found necessary by hiding it, importing the wheels and drawing off screen.

    python3 tools/check_system.py              print what is missing; exit code 1 if anything is
    python3 tools/check_system.py --packages   print only the names of the missing system packages
"""

from __future__ import annotations

import ctypes
import importlib.util
import platform
import shutil
import subprocess
import sys
from typing import NamedTuple

OLDEST, NEWEST = (3, 11), (3, 13)
GLIBC = (2, 28)


class Library(NamedTuple):
    """A shared library, who needs it, and the packages that bring it."""

    soname: str
    needed_by: str
    debian: str
    fedora: str


LIBRARIES = (
    Library("libGL.so.1", "gmsh", "libgl1", "libglvnd-glx"),
    Library("libGLU.so.1", "gmsh", "libglu1-mesa", "mesa-libGLU"),
    Library("libX11.so.6", "gmsh, VTK", "libx11-6", "libX11"),
    Library("libXext.so.6", "gmsh", "libxext6", "libXext"),
    Library("libXrender.so.1", "gmsh", "libxrender1", "libXrender"),
    Library("libXcursor.so.1", "gmsh", "libxcursor1", "libXcursor"),
    Library("libXfixes.so.3", "gmsh", "libxfixes3", "libXfixes"),
    Library("libXft.so.2", "gmsh", "libxft2", "libXft"),
    Library("libXinerama.so.1", "gmsh", "libxinerama1", "libXinerama"),
    Library("libfontconfig.so.1", "gmsh", "libfontconfig1", "fontconfig"),
    Library("libgomp.so.1", "gmsh", "libgomp1", "libgomp"),
    Library("libquadmath.so.0", "NGSolve", "libquadmath0", "libquadmath"),
    Library("libEGL.so.1", "VTK, to draw off screen", "libegl1", "mesa-libEGL"),
    Library("libstdc++.so.6", "gmsh, NGSolve, VTK", "libstdc++6", "libstdc++"),
    Library("libz.so.1", "gmsh, NGSolve, VTK", "zlib1g", "zlib"),
)


def loads(soname: str) -> bool:
    """Whether the dynamic loader finds a shared library and all that it needs in turn."""
    try:
        ctypes.CDLL(soname)
    except OSError:
        return False
    return True


def runs(interpreter: str) -> bool:
    """Whether an interpreter is on the path and starts (a version manager's shim may not)."""
    if not shutil.which(interpreter):
        return False
    return subprocess.run([interpreter, "-c", ""], capture_output=True, check=False).returncode == 0


def python_problem(version: tuple[int, int]) -> str | None:
    """Say what is wrong with this Python version, and which one on the path would do."""
    if OLDEST <= version <= NEWEST:
        return None
    names = [f"python3.{minor}" for minor in range(NEWEST[1], OLDEST[1] - 1, -1)]
    found = next((name for name in names if runs(name)), None)
    remedy = (
        f"{found} is on the path: make PYTHON={found}"
        if found
        else "install one of them and name it: make PYTHON=python3.12"
    )
    return (
        f"Python {version[0]}.{version[1]} ({sys.executable}) cannot run quietblade, which needs "
        f"{OLDEST[0]}.{OLDEST[1]} to {NEWEST[0]}.{NEWEST[1]}. {remedy}"
    )


def platform_problem(system: str, machine: str, libc: tuple[str, str]) -> str | None:
    """Say why the wheels cannot be installed on this platform."""
    if system != "Linux":
        return None
    if machine != "x86_64":
        return f"NGSolve has no wheel for Linux on {machine}; x86_64 is needed"
    name, number = libc
    if name != "glibc":
        return "the wheels need a Linux system with the GNU C library (glibc)"
    if tuple(int(part) for part in number.split(".")[:2]) < GLIBC:
        return (
            f"glibc {number} is too old for the wheels, which need {GLIBC[0]}.{GLIBC[1]} or newer"
        )
    return None


def missing_libraries() -> list[Library]:
    """Libraries of the list that the loader does not find; always empty off Linux."""
    if platform.system() != "Linux":
        return []
    return [library for library in LIBRARIES if not loads(library.soname)]


def venv_package() -> str | None:
    """Debian package that brings the missing venv module, or None when it is there."""
    complete = all(importlib.util.find_spec(name) for name in ("venv", "ensurepip"))
    return None if complete else f"python3.{sys.version_info.minor}-venv"


def install_advice(debian: list[str], fedora: list[str]) -> list[str]:
    """Commands that bring the missing packages, for the package managers of this machine."""
    debian_line = "apt-get install --no-install-recommends " + " ".join(debian)
    fedora_line = "dnf install " + " ".join(fedora)
    known = {"apt-get": debian_line, "dnf": fedora_line}
    here = [line for tool, line in known.items() if shutil.which(tool)]
    return here or [f"Debian, Ubuntu: {debian_line}", f"Fedora: {fedora_line}"]


def main() -> int:
    """Print what is missing and return the exit code."""
    libraries = missing_libraries()
    venv = venv_package()
    debian = [library.debian for library in libraries] + ([venv] if venv else [])
    if sys.argv[1:] == ["--packages"]:
        print(" ".join(debian))
        return 0

    problems = [
        python_problem((sys.version_info.major, sys.version_info.minor)),
        platform_problem(platform.system(), platform.machine(), platform.libc_ver()),
        "Python lacks its venv and ensurepip modules" if venv else None,
        *(f"{library.soname} is missing (needed by {library.needed_by})" for library in libraries),
    ]
    said = [problem for problem in problems if problem]
    if not said:
        return 0
    print("quietblade cannot be installed on this machine yet:", file=sys.stderr)
    for problem in said:
        print(f"  - {problem}", file=sys.stderr)
    if debian:
        print("Install the missing packages (as root) and try again:", file=sys.stderr)
        fedora = [library.fedora for library in libraries] + (["python3"] if venv else [])
        for line in install_advice(debian, fedora):
            print(f"  {line}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
