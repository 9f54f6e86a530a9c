"""Asks two Lisps the same questions and tells where they differ without a reason that is named.

Run with a CHAPTER, a COUNT and perhaps a SEED, it shows differences, each as the smallest question near it. With ``record COUNT`` it
writes recorded.jsonl, SBCL's answers to so many questions of each chapter; with ``answer mended.lisp`` it writes mended.jsonl, SBCL's answers
to the questions of that file.
"""

from __future__ import annotations

import json
import re
import sys
import time
from collections import Counter
from pathlib import Path

from form_grammar import NAMES, Grammar
from named_differences import comparable, named
from shrinking import shrunk
from two_lisps import OurLisp, TheirLisp

FOLDER = Path(__file__).parent
FIRST_NUMBER = 7_700_000_000
DEFINITION_OF_A_COMMON_NAME = re.compile(r"\(def(?!un|macro|var|parameter)[a-z-]+ \(*(?:setf )?(?![^ ()]*\{number\})")


class Asked:
    """Questions with the answers of both Lisps. What each question defines gets a number of its own, which its answer calls ``{number}``."""

    def __init__(self, theirs=None, ours=None):
        self.theirs, self.ours = theirs or TheirLisp(), ours or OurLisp()
        self.asked = FIRST_NUMBER

    def answers(self, question):
        """SBCL's answer and ours."""
        return self.answer(self.theirs, question), self.answer(self.ours, question)

    def answer(self, lisp, question):
        """The answer of one of them."""
        self.asked += 1
        text = lisp.answer(question.replace("{number}", str(self.asked)))
        return comparable(text.replace(str(self.asked), "{number}"))

    def difference(self, question):
        """(SBCL's answer, ours) if they differ and no named difference says why; else ``None``."""
        theirs, ours = self.answers(question)
        return None if theirs == ours or named(question, theirs, ours) else (theirs, ours)

    def smallest(self, question):
        """The smallest question near ``question`` that differs in the same way."""
        theirs, ours = self.answers(question)
        way = ways(theirs, ours)

        def differs(candidate):
            if DEFINITION_OF_A_COMMON_NAME.search(candidate):
                return False  # it would disturb later questions
            found = self.difference(candidate)
            return found is not None and ways(*found) == way

        return shrunk(question, differs)


def ways(theirs, ours):
    """In which way two answers differ: the conditions, or that there are values."""
    lines = [answer.splitlines()[-1] for answer in (theirs, ours)]
    return [line if line.startswith("!!") else line[:2] for line in lines]


def shown(question, theirs, ours):
    """A difference for people to read."""
    return f"{question}\n   SBCL {theirs}\n   ours {ours}"


def questions(chapter, count, seed):
    """``count`` questions of a chapter, of the series ``seed``."""
    grammar = Grammar(chapter)
    return (grammar.question(number, f"{chapter} {seed}") for number in range(count))


def main(chapter, count, seed="1"):
    """Show the differences of a chapter. Time is that of the processor."""
    asked, found, reasons, slow = Asked(), {}, Counter(), []
    differ = 0
    for question in questions(chapter, int(count), seed):
        before = time.process_time()
        theirs, ours = asked.answers(question)
        if time.process_time() - before > 1:
            slow.append(question)
        if theirs == ours:
            continue
        if reason := named(question, theirs, ours):
            reasons[reason.words] += 1
            continue
        differ += 1
        small = asked.smallest(question)
        if small not in found:
            found[small] = question
            print(shown(small, *asked.answers(small)), flush=True)
    print(f"{differ} of {count} differ without a named reason; {len(found)} smallest questions", dict(reasons))
    print("\n".join(f"slow: {question}" for question in slow))
    asked.theirs.close()


def record(count, seed="1"):
    """Write down what SBCL answers to ``count`` questions of each chapter."""
    write_answers("recorded", [(chapter, question) for chapter in NAMES for question in questions(chapter, int(count), seed)])


def answer(path):
    """Write down what SBCL answers to the questions of a file, which has one a line."""
    lines = [line for line in Path(path).read_text(encoding="utf-8").splitlines() if line and not line.startswith(";")]
    write_answers(Path(path).stem, [("", line) for line in lines])


def write_answers(name, asked_for):
    """Write the file of (chapter, question, SBCL's answer)."""
    asked = Asked(ours=object())
    with (FOLDER / f"{name}.jsonl").open("w", encoding="utf-8") as file:
        for chapter, question in asked_for:
            file.write(json.dumps([chapter, question, asked.answer(asked.theirs, question)], ensure_ascii=False) + "\n")
    asked.theirs.close()


def recorded(name):
    """The (chapter, question, SBCL's answer) of a file."""
    return [json.loads(line) for line in (FOLDER / f"{name}.jsonl").read_text(encoding="utf-8").splitlines()]


if __name__ == "__main__":
    {"record": record, "answer": answer}.get(sys.argv[1], lambda *options: main(sys.argv[1], *options))(*sys.argv[2:])
