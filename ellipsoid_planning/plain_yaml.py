"""A quick reader for plain YAML: rewritten as JSON, which a library in C reads.

What people and programs write into scenarios is nearly always plain: mappings and lists in block or
flow style, numbers as in JSON, words, strings without escapes, comments, one folded text. A
general reader takes about a millisecond for a body of a scene, this one some microseconds. It reads
a text as ruamel.yaml does or not at all: where anything is unusual or wrong it gives up, and the
general reader, which knows lines and columns, decides.
"""

from __future__ import annotations

import functools
import json
import re
from typing import Any

# Control characters, line breaks and spaces that only YAML knows, private and unpaired ones.
_UNUSUAL = re.compile("[^\\n -~\\xa1-\\u167f\\u1681-\\u1fff\\u2030-\\u2fff\\u3001-\\ud7ff]")
_INNER = r"[\w ./()+*°%-]*"
_WORD = "[A-Za-z]" + _INNER
_STRING = r"\"[^\"\\\n]*\"|'[^'\\\"\n]*'"
_LINE = re.compile(
    rf"(?P<indent> *)(?P<dashes>(?:- +)*)(?:(?P<key>{_WORD}|{_STRING}):(?: +|$))?(?P<rest>.*)"
)
# A word does not begin within a number: that is left to JSON's own rules.
# (The first character stands alone, so that the search for it is a quick one.)
_TOKEN = re.compile(
    rf"[A-Za-z\"'](?<![\w.+-].)"
    rf"(?:(?<=[A-Za-z]){_INNER}|(?<=\")[^\"\\\n]*\"|(?<=')[^'\\\"\n]*')",
)
_NUMBER = re.compile(r"-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][-+]?\d+)?", re.ASCII)
_TEXT = re.compile(r"[A-Za-z][\w ,.;()/+*°%-]*")
_STRINGS = re.compile(_STRING)
_DASH = re.compile("- +")
# In YAML a key and its colon stand on one line.
_KEY_BROKEN = re.compile("\n *:")
_COMMENT = re.compile(r"(?:^|(?<= ))#")
_QUOTES = "\"'"
_JSON_WORDS = ("true", "false", "null")
# A key is no longer in YAML.
_LONGEST = 1000


class _UnusualError(Exception):
    """The text is not plain."""


def plain_data(text: str) -> Any:
    """The content of a plain YAML text as Python data, None for a text that is not plain."""
    if _UNUSUAL.search(text):
        return None
    try:
        # A text in JSON means the same in YAML, but for escapes.
        if text[:1] == "{" and "\\" not in text and not _KEY_BROKEN.search(text):
            try:
                return _loaded(text)
            except ValueError:
                pass
        return _loaded(_Rewriter(text.split("\n")).json())
    except (_UnusualError, ValueError, RecursionError):
        return None


def _loaded(text: str) -> Any:
    return json.loads(text, object_pairs_hook=_unique, parse_constant=_refuse)


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    made = dict(pairs)
    if len(made) < len(pairs) or max(map(len, made), default=0) > _LONGEST:
        raise _UnusualError
    return made


def _refuse(text: str) -> Any:  # noqa: ARG001 (json calls it)
    raise _UnusualError


class _Rewriter:
    """Turns lines of plain YAML into JSON."""

    def __init__(self, lines: list[str]) -> None:
        self._lines = lines
        self._next = 0
        self._out: list[str] = []
        # Open blocks: the column of their entries, and the bracket that closes them.
        self._open: list[tuple[int, str]] = []
        self._pending = True  # a value is expected

    def json(self) -> str:
        """The whole document."""
        while self._next < len(self._lines):
            line = _without_comment(self._lines[self._next])
            self._next += 1
            if line:
                self._read(line)
        if self._pending:
            raise _UnusualError
        self._close(-1)
        return "".join(self._out)

    def _read(self, line: str) -> None:
        found = _LINE.fullmatch(line)
        if found is None:
            raise _UnusualError
        column = found.end("indent")
        dashes, key, rest = found.group("dashes", "key", "rest")
        if not (dashes or key) and (self._open or rest[:1] not in ("{", "[")):
            raise _UnusualError
        if dashes:
            for dash in _DASH.finditer(dashes):
                self._entry(column + dash.start(), "]")
                self._pending = True
            column += len(dashes)
        if key is not None:
            self._entry(column, "}")
            self._out.append(_key(key))
            self._pending = True
        if rest:
            self._value(rest, self._open[-1][0] if self._open else -1)

    def _entry(self, column: int, bracket: str) -> None:
        """Begin an entry of a list or mapping whose entries stand at a column."""
        if self._pending:
            # A list may stand right below its key, everything else further in.
            above, kind = self._open[-1] if self._open else (-1, "]")
            if not (column > above or (column == above and (kind, bracket) == ("}", "]"))):
                raise _UnusualError
            self._open.append((column, bracket))
            self._out.append("[" if bracket == "]" else "{")
        else:
            self._close(column)
            if self._open and self._open[-1] == (column, "]") and bracket == "}":
                self._out.append(self._open.pop()[1])
            if not self._open or self._open[-1] != (column, bracket):
                raise _UnusualError
            self._out.append(",")
        self._pending = False

    def _close(self, column: int) -> None:
        while self._open and self._open[-1][0] > column:
            self._out.append(self._open.pop()[1])

    def _value(self, text: str, column: int) -> None:
        """Write the value that begins at ``text``, of an entry at a column."""
        if not self._pending:
            raise _UnusualError
        self._pending = False
        if text[0] in "[{":
            self._out.append(self._flow(text, column))
        elif text == ">-":
            self._out.append(self._folded(column))
        elif _STRINGS.fullmatch(text) or (_TEXT.fullmatch(text) and not _is_special(text)):
            self._out.append(_string(text))
        elif text in ("true", "false") or _NUMBER.fullmatch(text):
            self._out.append(text)
        else:
            raise _UnusualError

    def _flow(self, text: str, column: int) -> str:
        """A value in brackets, with the lines that it goes on to."""
        lines, depth = [text], _depth(text)
        while depth > 0:
            if self._next == len(self._lines):
                raise _UnusualError
            line = _without_comment(self._lines[self._next])
            self._next += 1
            if (line and _indent(line) <= column) or line.lstrip(" ")[:1] == ":":
                raise _UnusualError
            lines.append(line)
            depth += _depth(line)
        return _TOKEN.sub(_token, "\n".join(lines))

    def _folded(self, column: int) -> str:
        """A folded text of lines that are indented alike."""
        begin = self._next
        indent = _indent(self._lines[begin]) if begin < len(self._lines) else 0
        while self._next < len(self._lines) and _indent(self._lines[self._next]) > column:
            line = self._lines[self._next]
            if line[-1] == " " or _indent(line) != indent:
                raise _UnusualError
            self._next += 1
        after = self._lines[self._next : self._next + 2]
        # After an empty line the text may go on.
        goes_on = after[:1] == [""] and (after[1:] == [""] or _indent(after[-1]) > column)
        if self._next == begin or goes_on:
            raise _UnusualError
        return json.dumps(" ".join(line[indent:] for line in self._lines[begin : self._next]))


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _without_comment(line: str) -> str:
    if "#" in line:
        found = _COMMENT.search(line)
        if found is not None:
            if ('"' in line or "'" in line) and line.lstrip(" ")[:1] != "#":
                raise _UnusualError
            line = line[: found.start()]
    return line.rstrip(" ")


def _depth(text: str) -> int:
    """How many brackets stay open."""
    if '"' in text or "'" in text:
        text = _STRINGS.sub("", text)
    opened = text.count("[") + text.count("{")
    return opened - text.count("]") - text.count("}")


def _token(found: re.Match[str]) -> str:
    """A string or word of a flow as JSON."""
    token = found.group()
    if token[0] in _QUOTES:
        return _string(token)
    after = found.string[found.end() : found.end() + 2]
    word = token.rstrip(" ")
    ends = not after or after[0] in ",]}\n"
    if word in _JSON_WORDS and ends:
        return word
    if _is_special(word) or not (ends or after in (": ", ":\n", ":")):
        raise _UnusualError
    return _string(word)


@functools.lru_cache(maxsize=256)
def _key(text: str) -> str:
    """A key of a block as JSON; the same few come again and again."""
    if _is_special(text.rstrip(" ")):
        raise _UnusualError
    return _string(text) + ":"


def _string(text: str) -> str:
    """A quoted string, or a word, as a string of JSON."""
    inner = text[1:-1] if text[0] in _QUOTES else text.rstrip(" ")
    if len(inner) > _LONGEST:
        raise _UnusualError
    return f'"{inner}"'


def _is_special(text: str) -> bool:
    """Whether a word is a truth value or null, or nearly: only YAML knows which spellings are."""
    return text.lower() in _JSON_WORDS
