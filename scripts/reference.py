#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the reference pages of the Python API with pdoc: scripts/reference.py FOLDER.

What is of the extension is described by its stub: only there signatures and types are as a reader needs them.
"""

import __future__

import importlib
import importlib.util
import pkgutil
import sys
import types
from pathlib import Path
from typing import Generic, TypeVar

import numpy.typing
import pdoc

T = TypeVar("T")


class ArrayLike:
    """As it is read. What numpy has in its place is lines of its internals."""

    __module__ = "builtins"


class NDArray(Generic[T]):
    """Likewise."""

    __module__ = "builtins"


vars(numpy.typing).update(ArrayLike=ArrayLike, NDArray=NDArray)  # before oort takes them

import oort  # noqa: E402
from oort import _core  # noqa: E402

STUB = Path(__file__).resolve().parents[1] / "src/python/oort/_core.pyi"
PROGRAMS = {"cli", "node"}
"""No API, as the modules that `python -m` runs are none: docs/usage.md and docs/ros.md describe them."""


def stub_of_core() -> types.ModuleType:
    """The stub as if it were the extension."""
    stub = types.ModuleType(_core.__name__)
    # A stub may use the name of a class that it declares further down.
    code = compile(
        STUB.read_text(encoding="utf-8"), STUB, "exec", flags=__future__.annotations.compiler_flag, dont_inherit=True
    )
    exec(code, vars(stub))
    return stub


class Verbatim:
    """An annotation that is shown as the stub has it."""

    def __init__(self, text: str) -> None:
        """Its text."""
        self.text = text

    def __repr__(self) -> str:
        """What pdoc prints."""
        return self.text


def show_annotations_verbatim(stub: types.ModuleType) -> None:
    """Resolved, NDArray[np.float64] would be a line of numpy's internals."""
    members = [member for value in vars(stub).values() if isinstance(value, type) for member in vars(value).values()]
    for member in [*members, *vars(stub).values()]:
        for function in (member.fget, member.fset) if isinstance(member, property) else (member,):
            if isinstance(function, types.FunctionType) and function.__module__ == _core.__name__:
                annotations = function.__annotations__
                function.__annotations__ = {name: Verbatim(str(text)) for name, text in annotations.items()}


def describe_by(stub: types.ModuleType) -> None:
    """Puts classes and functions of the stub in the place of those of the extension, in every module that has them."""
    for module in [module for name, module in sys.modules.items() if name.partition(".")[0] == "oort"]:
        for name, value in list(vars(module).items()):
            if getattr(value, "__module__", "") == _core.__name__ and hasattr(stub, value.__name__):
                setattr(module, name, getattr(stub, value.__name__))


def is_command(name: str) -> bool:
    """Whether `python -m` runs a module. It is not imported: the module oort.replay would hide the function."""
    spec = importlib.util.find_spec(f"oort.{name}")
    text = Path(spec.origin).read_text(encoding="utf-8") if spec and spec.origin else ""
    return '"""``python -m' in text


def main() -> int:
    """The command line."""
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    names = {module.name for module in pkgutil.iter_modules(oort.__path__) if not module.name.startswith("_")}
    commands = {name for name in names if is_command(name)}
    modules = [oort, *(importlib.import_module(f"oort.{name}") for name in sorted(names - PROGRAMS - commands))]
    stub = stub_of_core()
    show_annotations_verbatim(stub)
    describe_by(stub)
    pdoc.render.configure(docformat="google", show_source=False)
    left_out = (f"!oort.{name}" for name in sorted(commands))
    pdoc.pdoc(*(module.__name__ for module in modules), *left_out, output_directory=Path(sys.argv[1]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
