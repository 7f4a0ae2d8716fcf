# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The shipped stub of the extension says what the extension has: it is compared with one made from the extension."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from importlib import resources

import pytest

_SPECIAL = {"__init__", "__len__", "__version__"}  # the only dunder names that the extension defines for its users


@pytest.fixture(scope="module")
def shipped() -> dict[str, str]:
    text = (resources.files("oort") / "_core.pyi").read_text(encoding="utf-8")
    return _api(_with_aliases_replaced(ast.parse(text)))


@pytest.fixture(scope="module")
def actual(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("stubs")
    subprocess.run(
        [sys.executable, "-m", "pybind11_stubgen", "oort._core", "-o", str(folder)], check=True, capture_output=True
    )
    return _api(ast.parse((folder / "oort/_core.pyi").read_text(encoding="utf-8")))


def test_same_names(shipped: dict[str, str], actual: dict[str, str]) -> None:
    assert sorted(shipped) == sorted(actual)


def test_same_signatures(shipped: dict[str, str], actual: dict[str, str]) -> None:
    assert shipped == {name: _loosened(text, shipped.get(name, "")) for name, text in actual.items()}


def test_what_the_check_sees() -> None:
    tree = ast.parse("class A(B):\n def f(self, x: int, *, y: float = 1.0) -> int: ...\n @property\n def z(self): ...")
    assert _api(tree) == {"A": "class(B)", "A.f": "def (self, x, *, y=) -> int", "A.z": "read-only -> "}


def test_package_is_marked_as_typed() -> None:
    assert (resources.files("oort") / "py.typed").is_file()


def _api(tree: ast.Module) -> dict[str, str]:
    """Every public name with what it is: a class and its bases, a function and its signature, or an attribute."""
    api: dict[str, str] = {}
    for name, text in _members(tree.body, ""):
        api[name] = api[name].replace("read-only", "read-write") if text == "setter" else text
    return api


def _members(body: list[ast.stmt], prefix: str) -> Iterator[tuple[str, str]]:
    for node in body:
        if isinstance(node, ast.ClassDef):
            if _public(node.name):
                yield prefix + node.name, f"class({', '.join(map(ast.unparse, node.bases))})"
                yield from _members(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            if _public(node.name):
                yield prefix + node.name, _function(node)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and _public(node.target.id):
            yield prefix + node.target.id, f"read-write -> {_short(ast.unparse(node.annotation))}"


def _public(name: str) -> bool:
    return name in _SPECIAL or not name.startswith("_")


def _function(node: ast.FunctionDef) -> str:
    decorators = {ast.unparse(decorator).rpartition(".")[2] for decorator in node.decorator_list}
    if "setter" in decorators:
        return "setter"
    arguments, returns = node.args, _short(ast.unparse(node.returns)) if node.returns else ""
    if "property" in decorators:
        return f"read-only -> {returns}"
    positional = [*arguments.posonlyargs, *arguments.args]
    required = len(positional) - len(arguments.defaults)
    names = [argument.arg + ("=" if at >= required else "") for at, argument in enumerate(positional)]
    if arguments.kwonlyargs:
        names.append("*")
        names.extend(
            argument.arg + ("=" if default else "")
            for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
        )
    return f"def ({', '.join(names)}) -> {returns}"


def _short(annotation: str) -> str:
    for long, short in (("numpy.typing.", ""), ("typing.", ""), ("numpy.", "np.")):
        annotation = annotation.replace(long, short)
    return annotation


def _loosened(actual: str, shipped: str) -> str:
    """A dict or list of which the extension does not tell the members may be told more exactly by the stub."""
    for container in ("dict", "list"):
        if actual.endswith(f"-> {container}") and shipped.startswith(f"{actual}["):
            return shipped
    return actual


def _with_aliases_replaced(tree: ast.Module) -> ast.Module:
    aliases = {
        node.target.id: node.value
        for node in tree.body
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value is not None
    }

    class Replacer(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.expr:
            return self.visit(aliases[node.id]) if node.id in aliases else node

    for node in tree.body:
        if not isinstance(node, ast.AnnAssign):
            Replacer().visit(node)
    return tree
