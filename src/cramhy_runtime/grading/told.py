"""What the process of a submission has told, sorted; only lines that begin with the job's secret count, and only the first of a kind."""

from __future__ import annotations

import json

ONCE = ("value", "run", "tests", "tampered", "faults")


class Told:
    """The reports of one job, by kind: ``value``, ``run``, ``tests``, ``tampered``, ``faults``, ``error``; ``None`` if there was none.

    ``answers``: ("answer" or "error", facts) of each question. ``doing``, ``what``: the step that was begun last. ``done``: whether the
    job came to its end. ``held``: the locks of the sandbox.
    """

    def __init__(self, lines, nonce):
        self.value = self.run = self.tests = self.tampered = self.faults = self.error = None
        self.answers, self.held = [], []
        self.doing, self.what, self.done = "begin", "", False
        for line in lines:
            secret, _, text = line.partition(" ")
            if secret != nonce or self.done:
                continue
            try:
                facts = json.loads(text)
                self._take(facts.pop("kind"), facts)
            except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
                continue

    def _take(self, kind, facts):
        if kind == "done":
            self.done = True
        elif kind == "held":
            self.held = facts["locks"]
        elif kind == "stage":
            self.doing, self.what = str(facts["doing"]), str(facts["what"])
        elif kind == "answer" or (kind == "error" and self.doing == "ask"):
            if kind == "answer" and not all(isinstance(value, str) for value in facts["values"]):
                raise ValueError(facts)
            self.answers.append((kind, facts))
        elif kind == "error":
            self.error = self.error or {"types": [str(name) for name in facts["types"]], "text": str(facts["text"])}
        elif kind in ONCE and getattr(self, kind) is None:
            setattr(self, kind, facts)
