"""What the process of a submission has told, sorted. Every line begins with the job's secret, and only the first message of a kind counts.

A line without the secret is not passed over: a stranger has written it, and it may stand where another message was destroyed.
"""

from __future__ import annotations

from .harmless import harmless
from .schema import MOST_HEARD, MOST_MESSAGES, Malformed, read

ONCE = ("value", "took", "run", "tests", "tampered", "faults")
MOST_USES = 50


class Told:
    """The messages of one job: ``value``, ``took``, ``run``, ``tests``, ``tampered``, ``faults``, ``error``; ``None`` if there was none.

    ``answers``: ("answer" or "error", facts) of each question. ``heard``: what reached the simulator. ``uses``: (what, name) of what else
    the submission did to the world. ``doing``, ``what``: the step that was begun last. ``done``: whether the job came to its end. ``held``:
    the locks of the sandbox. ``malformed``: what was wrong with the first message that no process of ours sends, ``None`` if all were good;
    later ones are not read. All texts are `harmless`.
    """

    def __init__(self, lines, nonce):
        self.value = self.took = self.run = self.tests = self.tampered = self.faults = self.error = None
        self.answers, self.held, self.heard, self.uses = [], [], [], []
        self.doing, self.what, self.done = "begin", "", False
        self.malformed = None
        for line in lines[:MOST_MESSAGES]:
            secret, _, text = line.partition(" ")
            if self.done:
                return
            try:
                if secret != nonce:
                    raise Malformed("a line is not from this run")
                self._take(*read(text))
            except Malformed as problem:
                self.malformed = str(problem)
                return

    def _take(self, kind, facts):
        facts = {name: _clean(value) for name, value in facts.items()} if kind != "heard" else facts
        if kind == "done":
            self.done = True
        elif kind == "held":
            self.held = facts["locks"]
        elif kind == "stage":
            self.doing, self.what = facts["doing"], facts["what"]
        elif kind == "heard":
            if self.heard and facts["entries"] and facts["entries"][0][0] < self.heard[-1][0]:
                raise Malformed("commands are not in the order of time")
            self.heard += facts["entries"]
            if len(self.heard) > MOST_HEARD:
                raise Malformed(f"there are more than {MOST_HEARD} commands")
        elif kind == "used":
            if len(self.uses) < MOST_USES and (facts["what"], facts["name"]) not in self.uses:
                self.uses.append((facts["what"], facts["name"]))
        elif kind == "answer" or (kind == "error" and self.doing == "ask"):
            self.answers.append((kind, facts))
        elif kind == "error":
            self.error = self.error or facts
        elif kind in ONCE and getattr(self, kind) is None:
            setattr(self, kind, facts)


def _clean(value):
    if isinstance(value, str):
        return harmless(value)
    if isinstance(value, list):
        return [_clean(each) for each in value]
    return {name: _clean(each) for name, each in value.items()} if isinstance(value, dict) else value
