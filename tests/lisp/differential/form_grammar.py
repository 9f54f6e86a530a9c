"""Random forms of a chapter of Common Lisp, from a grammar that is a file of text.

A line ``name = text`` begins what a name may stand for, and lines ``| text`` below it are its other alternatives. In a text ``{name}``
is an alternative of that name, ``{name?}`` is one or nothing, ``{name*}`` up to three, ``{name+}`` one to three, and ``{"name}`` the text of
one, written as a string of Lisp. ``{number}`` stays, for the names of what the question defines, until it is asked; ``{newline}`` breaks a line.
Before a text, behind the sign, may stand a weight, ``3|``. A question is an alternative of ``question``. Nested too deeply, a name becomes one
of its shallowest texts, so each question ends.
"""

from __future__ import annotations

import re
from pathlib import Path
from random import Random

CHAPTERS = Path(__file__).parent / "chapters"
NAMES = "objects structures types strings sequences printer reader floats".split()
HOLE = re.compile(r'\{("?)([a-z][a-z0-9-]*)([*+?]?)\}')
ALTERNATIVE = re.compile(r"(?:([a-z][a-z0-9-]*) =|\|)(?: (?:(\d+)\|(?: |$))?(.*))?$")
WRITTEN = {"newline": "\n", "space": " "}
DEPTH = 4


class Grammar:
    """What the names of a chapter stand for: ``texts`` maps each to its (weight, text) pairs."""

    def __init__(self, chapter):
        self.texts = {}
        for name in ("common", chapter):
            self._read((CHAPTERS / f"{name}.grammar").read_text(encoding="utf-8"))
        self.depths = self._depths()

    def _read(self, lines):
        name = None
        for line in lines.splitlines():
            if not line.strip() or line.startswith(";"):
                continue
            found = ALTERNATIVE.match(line)
            if not found:
                raise ValueError(f"a line of a grammar is neither `name = text` nor `| text`: {line}")
            if found[1]:
                name = found[1]
                self.texts[name] = []
            self.texts[name].append((int(found[2] or 1), found[3] or ""))

    def _depths(self):
        """How deep each name nests at least."""
        depths = dict.fromkeys([*WRITTEN, "number"], 0)
        for _ in self.texts:
            for name, texts in self.texts.items():
                known = [d for _, text in texts if (d := self._depth(text, depths)) is not None]
                if known:
                    depths[name] = min(known) + 1
        if missing := set(self.texts) - set(depths):
            raise ValueError(f"these names of a grammar never end: {missing}")
        return depths

    def _depth(self, text, depths):
        inner = [depths.get(hole[2]) for hole in HOLE.finditer(text) if hole[3] not in ("*", "?")]
        return None if None in inner else max(inner, default=0)

    def question(self, number, seed):
        """The text of question ``number`` of the series ``seed``; always the same."""
        return self._expand("question", Random(f"{seed} {number}"), 0)

    def _expand(self, name, random, depth):
        if name == "number":
            return "{number}"
        if name in WRITTEN:
            return WRITTEN[name]
        texts = self.texts[name]
        if depth > DEPTH:
            least = min(self._depth(text, self.depths) for _, text in texts)
            texts = [(weight, text) for weight, text in texts if self._depth(text, self.depths) == least]
        text = random.choices([text for _, text in texts], [weight for weight, _ in texts])[0]

        def fill(hole):
            if hole[2] not in self.texts and hole[2] not in WRITTEN and hole[2] != "number":
                raise ValueError(f"a grammar has no name {hole[2]}, which {text} has")
            few = depth >= DEPTH
            count = {"": 1, "?": 0 if few else random.choice((0, 1)), "*": random.randint(0, 1 if few else 3), "+": random.randint(1, 3)}[
                hole[3]
            ]
            parts = [self._expand(hole[2], random, depth + 1) for _ in range(count)]
            return lisp_string(" ".join(parts)) if hole[1] else " ".join(parts)

        return HOLE.sub(fill, text)


def lisp_string(text):
    """``text`` as a literal string of Lisp."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
