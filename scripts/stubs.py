#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the stub of the extension: what pybind11-stubgen makes of it, in Oort's style.

pybind11 says of a number that it may be whatever converts to one; that is shortened. Of a dict or list it says nothing;
MEMBERS does. Docstrings are wrapped.
"""

import ast
import re
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Iterator
from pathlib import Path

from oort import _core

HEADER = '''# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Written by scripts/stubs.sh from the extension.
"""{doc}"""

import enum
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
'''
WIDTH = 120

SHORTER = (
    (r"typing\.SupportsInt( \| typing\.SupportsIndex)?", "int"),
    (r"typing\.SupportsFloat( \| typing\.SupportsIndex)?", "float"),
    (r"typing\.Annotated\[numpy\.typing\.ArrayLike, [\w.]+(, '[^']*')?\]", "ArrayLike"),
    (r"typing\.Annotated\[(.+?), 'FixedSize\(\d+\)'\]", r"\1"),
    (r"\b(collections\.abc|numpy\.typing|typing)\.", ""),
    (r"\bnumpy\.", "np."),
)
"""Patterns in the text of an annotation and what stands for them, in this order."""

ARRAYS = "dict[str, NDArray[Any]]"
LOCATIONS = "list[tuple[str, str, int, tuple[float, float, float]]]"
MEMBERS = {
    "Parameters.to_dict": "dict[str, bool | int | float | str]",
    "Map.edges": ARRAYS,
    "Map.switchable_edges": ARRAYS,
    "Map.incremental_results": ARRAYS,
    "Map.loop_results": ARRAYS,
    "Map.clouds": "list[NDArray[np.float64]]",
    "Map.loose_parts": "list[NDArray[np.uint64]]",
    "Map.locations": LOCATIONS,
    "Mapper.locations": LOCATIONS,
    "Mapper.statistics": "dict[str, Any]",
    "Mapper.work_seconds": "dict[str, float]",
    "Mapper.closure_attempts": "list[tuple[int, int, str | None, tuple[float, float, float], float]]",
    "Hypothesis.counts": "dict[str, int]",
    "Localizer.statistics": "dict[str, Any]",
    "Merged.closures": "dict[str, Any]",
    "Merged.dropped": "list[tuple[str, str, float]]",
}
"""What a function or property returns, where the extension says only that it is a dict or a list."""


def main() -> int:
    """The command line."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pybind11_stubgen", "oort._core", "-o", folder]
        subprocess.run(command, check=True, capture_output=True)
        tree = ast.parse((Path(folder) / "oort/_core.pyi").read_text(encoding="utf-8"))
    text = HEADER.format(doc=ast.get_docstring(tree)) + "\n".join(lines(tree.body, "", ""))
    ruff = [str(Path(sys.executable).parent / "ruff"), "format", "--stdin-filename", "_core.pyi"]
    print(subprocess.run(ruff, input=text, text=True, check=True, capture_output=True).stdout, end="")
    return 0


def lines(body: list[ast.stmt], prefix: str, indent: str) -> Iterator[str]:
    """The declarations of a module or class, each with its docstring."""
    for node in body:
        if isinstance(node, ast.ClassDef):
            bases = ", ".join(ast.unparse(base) for base in node.bases)
            yield f"{indent}class {node.name}" + (f"({bases}):" if bases else ":")
            yield from docstring(node, indent + "    ")
            if bases == "enum.StrEnum":
                yield from (f'{indent}    {member.name} = "{member.value}"' for member in getattr(_core, node.name))
                continue
            yield from lines(node.body, f"{node.name}.", indent + "    ")
        elif isinstance(node, ast.FunctionDef) and shown(node.name):
            yield from function(node, prefix, indent)
        elif isinstance(node, ast.AnnAssign) and shown(ast.unparse(node.target)):
            yield f"{indent}{ast.unparse(node.target)}: {shorter(ast.unparse(node.annotation))}"


def function(node: ast.FunctionDef, prefix: str, indent: str) -> Iterator[str]:
    """A function or one half of a property."""
    setter = any(ast.unparse(decorator).endswith(".setter") for decorator in node.decorator_list)
    arguments = shorter(ast.unparse(node.args)).replace("arg1:", "value:")
    returns = shorter(ast.unparse(node.returns)) if node.returns else "None"
    if returns in ("dict", "list"):
        name = prefix + node.name
        if name not in MEMBERS:
            raise SystemExit(f"{name} is a {returns}, of what? Say so in MEMBERS of scripts/stubs.py.")
        returns = MEMBERS[name]
    for decorator in node.decorator_list:
        yield f"{indent}@{ast.unparse(decorator).removeprefix('typing.')}"
    yield f"{indent}def {node.name}({arguments}) -> {returns}:"
    yield from docstring(node, indent + "    ", shown=not setter)


def docstring(node: ast.ClassDef | ast.FunctionDef, indent: str, *, shown: bool = True) -> Iterator[str]:
    """The docstring with its paragraphs wrapped, or dots where there is none."""
    text = (ast.get_docstring(node) or "").replace("\\", "\\\\") if shown else ""
    if not text:
        yield indent + "..."
        return
    text = re.sub(r'"$', r'\\"', text)
    if "\n" not in text and len(text) <= WIDTH - len(indent) - len('""""""'):
        yield f'{indent}"""{text}"""'
        return
    room = WIDTH - len(indent) - len('"""')
    paragraphs = [textwrap.wrap(" ".join(paragraph.split()), room) for paragraph in re.split(r"\n\s*\n", text)]
    wrapped = "\n\n".join("\n".join(paragraph) for paragraph in paragraphs)
    yield textwrap.indent(f'"""{wrapped}\n"""', indent)


def shown(name: str) -> bool:
    """Whether users of the extension see it."""
    return name in ("__init__", "__len__") or not name.startswith("_")


def shorter(annotation: str) -> str:
    """An annotation, or several in a signature, as a person would write them."""
    for pattern, text in SHORTER:
        annotation = re.sub(pattern, text, annotation)
    return annotation


if __name__ == "__main__":
    sys.exit(main())
