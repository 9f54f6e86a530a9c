"""The process modules that a projection sees: its own, and those outside under names that it does not define.

So the imagined navigation takes the place of the real one even while that is running, plans outside cannot send requests to it, and two
projections side by side each have their own. In the original the names are global: a module that already runs under the name is used as
it is, and the robot moves.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Mapping

from ..process_modules.registry import Registry


class ProjectedRegistry(Registry):
    """The running modules that a projection sees. ``around`` is the registry outside; ``names`` are its own names."""

    def __init__(self, around, names):
        super().__init__()
        self.modules = ChainMap({}, _Without(around, frozenset(names)))


class _Without(Mapping):
    """The present running modules of ``registry``, except under the names ``hidden``."""

    def __init__(self, registry, hidden):
        self.registry, self.hidden = registry, hidden

    def __getitem__(self, name):
        if name in self.hidden:
            raise KeyError(name)
        return self.registry.modules[name]

    def __iter__(self):
        return (name for name in self.registry.modules if name not in self.hidden)

    def __len__(self):
        return sum(1 for _ in self)
