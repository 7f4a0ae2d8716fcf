# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""JSON as params.json is written in practice: strict, or with the liberties of its documentation.

The liberties: comments from ``#``, ``//`` or a stray ``$`` to the end of the line, a missing comma between members, a
comma after the last one, and a key given twice (the last one wins).
"""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, NoReturn

from oort.errors import ParameterError

Scalar = bool | int | float | str

_TOKEN = re.compile(
    r"""(?P<skip>\s+|(?:\#|//|\$)[^\n]*)
    |(?P<string>"(?:[^"\\\n]|\\.)*")
    |(?P<word>[-+.\w]+)
    |(?P<mark>[][{}:,])
    |(?P<end>\Z)
    |(?P<bad>.)""",
    re.VERBOSE,
)
_NUMBER = re.compile(r"-?(?:0|[1-9]\d*)(?P<real>(?:\.\d+)?(?:[eE][-+]?\d+)?)", re.ASCII)
_WORDS = {"true": True, "false": False}
_MAX_DEPTH = 20
_MAX_INTEGER_DIGITS = 18  # longer ones do not fit the engine's 64 bits; as floats they are refused as out of range


@dataclass(frozen=True)
class Member:
    """One ``"key": value`` of a section, and the line of its key."""

    value: "Scalar | Section"
    line: int


Section = dict[str, Member]


class _Token(NamedTuple):
    kind: str
    text: str
    line: int


def parse(text: str, source: str) -> tuple[Section, list[str]]:
    """Parses a file's text; ``source`` is its name in messages.

    Returns the outermost section and a message for each key that was given twice.
    Raises ParameterError, which names the file and the line, where the text cannot be read.
    """
    parser = _Parser(text, source)
    return parser.document(), parser.duplicates


def _tokens(text: str) -> Iterator[_Token]:
    line = 1
    for match in _TOKEN.finditer(text):
        kind = match.lastgroup or ""
        if kind != "skip":
            yield _Token(kind, match[0], line)
        line += match[0].count("\n")


class _Parser:
    def __init__(self, text: str, source: str) -> None:
        self._tokens = _tokens(text)
        self._source = source
        self._next = next(self._tokens)
        self.duplicates: list[str] = []

    def document(self) -> Section:
        section = self._section("")
        if self._next.kind != "end":
            self._fail("the end of the file")
        return section

    def _section(self, prefix: str) -> Section:
        self._expect("{")
        if prefix.count(".") > _MAX_DEPTH:
            self._fail("fewer sections inside each other")
        section: Section = {}
        while not self._accept("}"):
            key = self._key()
            path = prefix + key.text
            self._expect(":")
            if key.text in section:
                first = section[key.text].line
                self.duplicates.append(f"{self._source}:{key.line}: {path} was given in line {first}; this one counts")
            section[key.text] = Member(self._value(path), key.line)
            self._accept(",")
        return section

    def _key(self) -> _Token:
        if self._next.kind != "string":
            self._fail('"key" or }')
        token = self._advance()
        return token._replace(text=self._text(token))

    def _value(self, path: str) -> "Scalar | Section":
        if self._next.text == "{":
            return self._section(path + ".")
        if self._next.kind == "string":
            return self._text(self._advance())
        number = _NUMBER.fullmatch(self._next.text)
        if not number and self._next.text not in _WORDS:
            self._fail(f'the value of {path}: true, false, a number, a "text" or {{')
        word = self._advance().text
        if not number:
            return _WORDS[word]
        return float(word) if number["real"] or len(word) > _MAX_INTEGER_DIGITS else int(word)

    def _text(self, token: _Token) -> str:
        try:
            return str(json.loads(token.text))
        except json.JSONDecodeError as error:
            raise ParameterError(f"{self._source}:{token.line}: bad string {token.text}: {error.msg}") from None

    def _accept(self, mark: str) -> bool:
        found = self._next.text == mark
        if found:
            self._advance()
        return found

    def _expect(self, mark: str) -> None:
        if not self._accept(mark):
            self._fail(mark)

    def _advance(self) -> _Token:
        token = self._next
        self._next = next(self._tokens, token)
        return token

    def _fail(self, expected: str) -> NoReturn:
        found = self._next.text or "the end of the file"
        raise ParameterError(f"{self._source}:{self._next.line}: expected {expected}, found {found}")
