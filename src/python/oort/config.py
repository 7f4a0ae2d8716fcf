# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters as Python writes settings: by keyword and by attribute, over the engine's one table."""

import os
from collections.abc import Mapping
from typing import Any

from oort._core import Parameters, parameter_table, unknown_parameter
from oort.errors import ParameterError
from oort.parameters import read_parameters
from oort.parameters.reader import set_parameter

_Value = bool | int | float | str

_TABLE = {entry.path: entry for entry in parameter_table()}
_SECTIONS = {path[:at] for path in _TABLE for at, letter in enumerate(path) if letter == "."}


class Section:
    """One section of a Config; writing to it writes to the Config."""

    __slots__ = ("_path", "_root")

    def __init__(self, root: Parameters, path: str) -> None:
        """The section of ``root`` at a path."""
        object.__setattr__(self, "_root", root)
        object.__setattr__(self, "_path", path)

    def __getattr__(self, name: str) -> Any:
        """A value, or a section inside this one. Raises ParameterError."""
        return _look_up(self._root, f"{self._path}.{name}", name)

    def __setattr__(self, name: str, value: object) -> None:
        """Sets a value, or the values of a section from a mapping. Raises ParameterError."""
        _assign(self._root, f"{self._path}.{name}", value)

    def __dir__(self) -> list[str]:
        """The keys and sections there are, for completion."""
        return _names(self._path)

    def __repr__(self) -> str:
        """The keys with their values."""
        return _shown(self._path, self._root, self._path)


class Config(Parameters):
    """The parameters of the engine (docs/parameters.md), each at its default unless given.

    ``Config(linear_update=0.3, output_map={"robot_radius": 0.2})`` sets by keyword, and
    ``config.output_map.robot_radius = 0.2`` by attribute. Whatever takes Parameters takes a Config. Raises
    ParameterError, which names the key and what it takes, or the nearest known key.
    """

    def __init__(self, **values: Any) -> None:
        """The defaults, but for the ``values``: a section is a mapping."""
        super().__init__()
        self.update(values)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> "Config":
        """The parameters of a file, see read_parameters."""
        return cls.of(read_parameters(path))

    @classmethod
    def of(cls, parameters: Parameters) -> "Config":
        """A copy of some parameters."""
        config = cls()
        for path, value in parameters.to_dict().items():
            config.set(path, value)
        return config

    def copy(self) -> "Config":
        """Another Config with the same values."""
        return Config.of(self)

    def __copy__(self) -> "Config":
        """As copy()."""
        return self.copy()

    def __deepcopy__(self, memo: object) -> "Config":
        """As copy()."""
        return self.copy()

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets several values, then checks all against each other; a section is a mapping. Raises ParameterError."""
        for name, value in values.items():
            _assign(self, name, value)
        self.check()

    def __getattr__(self, name: str) -> Any:
        """A value, or a section. Raises ParameterError."""
        return _look_up(self, name, name)

    def __setattr__(self, name: str, value: object) -> None:
        """Sets a value, or the values of a section from a mapping. Raises ParameterError."""
        _assign(self, name, value)

    def __dir__(self) -> list[str]:
        """The keys and sections there are, for completion."""
        return [*_names(""), *(name for name in object.__dir__(self) if not name.startswith("__"))]

    def __eq__(self, other: object) -> bool:
        """Whether all values are the same."""
        return isinstance(other, Parameters) and self.to_dict() == other.to_dict()

    __hash__ = None  # type: ignore[assignment]  # its values change

    def __repr__(self) -> str:
        """The keys whose values differ from the defaults."""
        values = self.to_dict()
        changed = [f"{path}={values[path]!r}" for path, entry in _TABLE.items() if values[path] != entry.default]
        return f"Config({', '.join(changed)})"


def _look_up(root: Parameters, path: str, name: str) -> Any:
    if path in _TABLE:
        return root.get(path)
    if path in _SECTIONS:
        return Section(root, path)
    if name.startswith("_"):
        raise AttributeError(name)  # what copy, pickle and notebooks ask any object for
    raise ParameterError(unknown_parameter(path))


def _assign(root: Parameters, path: str, value: object) -> None:
    if path in _SECTIONS:
        if not isinstance(value, Mapping):
            raise ParameterError(f"{path}: is a section; it takes a mapping of its keys, not {value!r}")
        for name, inner in value.items():
            _assign(root, f"{path}.{name}", inner)
        return
    if path not in _TABLE:
        raise ParameterError(unknown_parameter(path))
    set_parameter(root, path, _plain(path, value))


def _plain(path: str, value: object) -> _Value:
    """The value as the engine takes it; numpy's numbers too."""
    item = getattr(value, "item", None)
    plain = item() if callable(item) and getattr(value, "ndim", None) == 0 else value
    if not isinstance(plain, bool | int | float | str):
        raise ParameterError(f"{path}: takes one value ({_TABLE[path].type}), not {value!r}")
    return plain


def _names(section: str) -> list[str]:
    prefix = f"{section}." if section else ""
    inner = (path[len(prefix) :].split(".")[0] for path in _TABLE if path.startswith(prefix))
    return list(dict.fromkeys(inner))


def _shown(title: str, root: Parameters, section: str) -> str:
    values = (f"{path[len(section) + 1 :]}={root.get(path)!r}" for path in _TABLE if path.startswith(f"{section}."))
    return f"{title}({', '.join(values)})"
