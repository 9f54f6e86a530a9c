"""Hash tables: Python dictionaries under the keys of ``lisp_core/equality.py``.

A value is found by the hash key of its key under the table's test. Most keys are their own hash keys; of the others the table keeps
the key itself, as the program sees it. Entries stay in the order in which they were first stored, so that two runs of a program see
the same order (SBCL's is the same as long as nothing is removed). Functions that walk a table walk the keys of a snapshot and leave out
what was removed meanwhile, so the current entry, or any other, may be removed on the way.

A table made with ``:weakness`` does not keep its keys (or values) alive, where Python can refer to them weakly: symbols,
instances and arrays, but not conses, numbers and strings. `sxhash` gives a number for tables that programs write themselves.
Source: ANSI chapter 18; texts are SBCL's.
"""

from __future__ import annotations

import weakref
from binascii import crc32
from itertools import chain, repeat

from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.kernel.images import per_image

from .arrays import is_bit_vector
from .conditions import error, type_error
from .data import UNSUPPLIED, Character, Cons, Keyword, LispString, MultipleValues, Symbol, one, truth
from .equality import KEYS, OWN_KEYS, eq, eql, equal, equalp, equalp_key, is_number
from .floats import literal_float
from .functions import function_of
from .packages import sym

LISP_NAMES = """
make-hash-table gethash remhash clrhash maphash hash-table-p hash-table-count hash-table-test hash-table-size
hash-table-rehash-size hash-table-rehash-threshold sxhash
"""
EXTENSION_NAMES = "hash-table-weakness hash-table-synchronized-p"
"""Names of package SB-EXT."""

REMOVED = object()
TURN = 2000
"""So many entries are walked between two checkpoints."""
_TESTS = {eq: "EQ", eql: "EQL", equal: "EQUAL", equalp: "EQUALP"}
_BY_KEY = ("KEY", "KEY-AND-VALUE", "KEY-OR-VALUE")
_BY_VALUE = ("VALUE", "KEY-AND-VALUE", "KEY-OR-VALUE")


_GROWTH, _FULL = literal_float(1.5), literal_float(1.0)


class HashTable:
    """A hash table; for Python it is a mapping: ``table[key]``, ``key in table``, ``len(table)``, ``for key in table``.

    test: "EQ", "EQL", "EQUAL" or "EQUALP", or a `UserTest`. weakness: ``None`` or a keyword name such as "KEY". size: what the program
    asked for; the table grows as it likes.

    ``entries``: hash key → value. ``originals``: hash key → key, where these two differ. ``plain``: the classes of keys that are their own
    `hash_key`. So compiled code finds and stores the values of such keys in ``entries`` itself.
    """

    lisp_name = "HASH-TABLE"
    __slots__ = (
        "test",
        "weakness",
        "entries",
        "originals",
        "hash_key",
        "plain",
        "size",
        "rehash_size",
        "rehash_threshold",
        "synchronized",
        "__weakref__",
    )

    def __init__(self, test="EQL", weakness=None, size=7, rehash_size=_GROWTH, rehash_threshold=_FULL, synchronized=False):
        self.test = test
        self.weakness = weakness
        hash_key = KEYS[test] if test.__class__ is str else test.key
        self.hash_key = hash_key if weakness is None else _weak_key(hash_key)
        self.plain = OWN_KEYS[test] if test.__class__ is str and weakness is None else OWN_KEYS["EQUALP"]
        self.entries, self.originals = {}, {}
        self.size, self.rehash_size, self.rehash_threshold = size, rehash_size, rehash_threshold
        self.synchronized = synchronized

    def get(self, key, default=None):
        """The value of ``key``, or ``default``."""
        return _strong(self.entries.get(self.hash_key(key), default))

    def put(self, key, value):
        """Store ``value`` under ``key``. A key that is equal to an old one replaces its value, not the key."""
        hash_key, entries, count = self.hash_key(key), self.entries, len(self.entries)
        entries[hash_key] = value if self.weakness is None else self._held(value, _BY_VALUE, hash_key)
        if hash_key is not key and len(entries) > count:
            self.originals[hash_key] = key if self.weakness is None else self._held(key, _BY_KEY, hash_key)

    def _held(self, thing, when, hash_key):
        if self.weakness not in when or isinstance(thing, type):
            return thing
        table = weakref.ref(self)

        def forget(reference):
            alive = table()
            if alive is not None and any(held.get(hash_key) is reference for held in (alive.originals, alive.entries)):
                alive._forget(hash_key)

        try:
            return _Weak(thing, forget)
        except TypeError:  # Python has no weak references to this
            return thing

    def remove(self, key):
        """Remove the entry of ``key``; whether there was one."""
        return self._forget(self.hash_key(key))

    def _forget(self, hash_key):
        self.originals.pop(hash_key, None)
        return self.entries.pop(hash_key, REMOVED) is not REMOVED

    def clear(self):
        """Remove all entries."""
        self.entries.clear()
        self.originals.clear()

    def walk(self):
        """Iterate over (key, value) in order of first storing. An entry that is removed meanwhile has the value ``REMOVED``."""
        hash_keys = list(self.entries)
        return chain.from_iterable(self._part(hash_keys, start) for start in range(0, len(hash_keys), TURN))

    def _part(self, hash_keys, start):
        if start:
            checkpoint()
        hash_keys = hash_keys[start : start + TURN]
        keys = map(self.originals.get, hash_keys, hash_keys) if self.originals else hash_keys
        pairs = zip(keys, map(self.entries.get, hash_keys, repeat(REMOVED)), strict=False)
        return pairs if self.weakness is None else ((_strong(key), _strong(value)) for key, value in pairs)

    def items(self):
        """Iterate over (key, value) in order of first storing; entries that are removed meanwhile are left out."""
        return (pair for pair in self.walk() if pair[1] is not REMOVED)

    def keys(self):
        return (key for key, _ in self.items())

    def values(self):
        return (value for _, value in self.items())

    __iter__ = keys

    def __len__(self):
        return len(self.entries)

    def __bool__(self):
        return True

    def __contains__(self, key):
        return self.hash_key(key) in self.entries

    def __getitem__(self, key):
        value = self.entries.get(self.hash_key(key), REMOVED)
        if value is REMOVED:
            raise KeyError(key)
        return _strong(value)

    __setitem__ = put

    def __delitem__(self, key):
        if not self.remove(key):
            raise KeyError(key)

    def __repr__(self):
        return f"#<HASH-TABLE :TEST {self.test} :COUNT {len(self)}>"

    def equalp_table(self, other):
        """What ``equalp`` says of two tables: the same test and keys, and values that are ``equalp``."""
        if not isinstance(other, HashTable) or self.test != other.test or len(self) != len(other):
            return None
        return True if all(key in other and equalp(value, other[key]) for key, value in self.items()) else None

    def equalp_table_key(self):
        """The `equalp_key` of a table."""
        return ("hash table", self.test, frozenset((self.hash_key(key), equalp_key(value)) for key, value in self.items()))


def _weak_key(hash_key):
    # A symbol is its own hash key; a weak table must not hold it that way.
    return lambda thing: (id(thing), None) if isinstance(thing, Symbol) else hash_key(thing)


class _Weak(weakref.ref):
    """Our own class of weak references, so that one that a program stores is not mistaken for it."""

    __slots__ = ()


def _strong(thing):
    return thing() if thing.__class__ is _Weak else thing


def need_table(thing):
    """``thing`` if it is a hash table, else a type-error."""
    if not isinstance(thing, HashTable):
        type_error(thing, "HASH-TABLE", "\nwhen binding HASH-TABLE")
    return thing


class UserTest:
    """A test of hash tables that a program has defined: ``name``, its function ``same``, and ``number``, which gives equal numbers for
    keys that are the same."""

    __slots__ = ("name", "same", "number")

    def __init__(self, name, same, number):
        self.name, self.same, self.number = name, same, number

    def __repr__(self):
        return str(getattr(self.name, "name", self.name))

    def key(self, thing):
        """The key of ``thing`` in the dictionary behind a table."""
        return _UserKey(thing, self)


class _UserKey:
    """A key that is the same as another one when the program's function says so."""

    __slots__ = ("thing", "test", "number")

    def __init__(self, thing, test):
        self.thing, self.test = thing, test
        number = one(test.number(thing))
        self.number = number if number.__class__ is int and number >= 0 else type_error(number, "UNSIGNED-BYTE")

    def __hash__(self):
        return hash(self.number)

    def __eq__(self, other):
        return truth(one(self.test.same(self.thing, other.thing)))


_user_tests: dict = per_image({})
"""Symbol → `UserTest`."""


def define_test(name, same, number):
    """Let the symbol ``name`` be a test of tables: ``same`` compares two keys, ``number`` gives equal numbers for same keys."""
    _user_tests[name] = UserTest(name, same, number)


def make_hash_table(
    *, test=UNSUPPLIED, size=7, rehash_size=_GROWTH, rehash_threshold=_FULL, synchronized=None, weakness=None, hash_function=None
):
    """``make-hash-table``: a new table. ``test`` is one of eq, eql (the default), equal, equalp, as symbol or function, or a test of
    the user's (``sb-ext:define-hash-table-test``). With ``hash_function`` any function may be the test."""
    if size.__class__ is not int or size < 0:
        type_error(size, "UNSIGNED-BYTE", "\nwhen binding SB-IMPL::SIZE")
    if hash_function is not None and test is UNSUPPLIED:
        test = sym("EQL")
    if weakness is not None and not (isinstance(weakness, Keyword) and weakness.name in {*_BY_KEY, *_BY_VALUE}):
        type_error(weakness, "(MEMBER :KEY-OR-VALUE :KEY-AND-VALUE :VALUE :KEY NIL)", "\nwhen binding SB-IMPL::WEAKNESS")
    return HashTable(
        _test_name(test) if hash_function is None else UserTest(test, function_of(test), function_of(hash_function)),
        weakness and weakness.name,
        size,
        rehash_size,
        rehash_threshold,
        synchronized is not None and synchronized is not False,
    )


def _test_name(test):
    if test is UNSUPPLIED:
        return "EQL"
    if isinstance(test, Symbol) and test.name in KEYS:
        return test.name
    name = _TESTS.get(test) if callable(test) and not isinstance(test, Symbol) else _user_tests.get(test) if _user_tests else None
    if name is None and callable(test):
        name = next((made for made in _user_tests.values() if made.same is test or function_of(made.name) is test), None)
    if name is None:
        if not isinstance(test, Symbol) and test is not None and not callable(test):
            type_error(test, "(OR FUNCTION SYMBOL)", "\nwhen binding SB-IMPL::TEST")
        error("Unknown :TEST for MAKE-HASH-TABLE: ~S", test)
    return name


def gethash(key, table, default=None):
    """``gethash``: two values, the value of ``key`` (or ``default``) and whether there is one."""
    return MultipleValues(value_and_presence(key, table, default))


def value_in_table(key, table, default=None):
    """The first value of `gethash`, which is what compiled code mostly wants; it saves making two."""
    if table.__class__ is not HashTable:
        need_table(table)
    value = table.entries.get(key if key.__class__ in table.plain else table.hash_key(key), default)
    return value if table.weakness is None else _strong(value)


def value_and_presence(key, table, default=None):
    """The two values of `gethash` as a plain tuple, for compiled code that takes both apart at once."""
    if table.__class__ is not HashTable:
        need_table(table)
    value = table.entries.get(key if key.__class__ in table.plain else table.hash_key(key), REMOVED)
    if value is REMOVED:
        return default, None
    return value if table.weakness is None else _strong(value), True


def set_gethash(value, key, table, default=None):
    """``(setf gethash)``; ``default`` is accepted and not used, as in the standard."""
    if table.__class__ is HashTable and key.__class__ in table.plain:
        table.entries[key] = value
    else:
        need_table(table).put(key, value)
    return value


def remhash(key, table):
    """``remhash``: remove the entry of ``key``; whether there was one."""
    return True if need_table(table).remove(key) else None


def clrhash(table):
    """``clrhash``: remove all entries; returns the table."""
    need_table(table).clear()
    return table


def maphash(function, table):
    """``maphash``: call ``function`` with each key and value; it may change or remove entries. Returns nil."""
    function = function_of(function, "\nwhen binding SB-KERNEL:FUNCTION-DESIGNATOR")
    for key, value in need_table(table).walk():
        if value is not REMOVED:
            function(key, value)


def hash_table_p(thing):
    """``hash-table-p``: whether ``thing`` is a hash table."""
    return True if isinstance(thing, HashTable) else None


def hash_table_count(table):
    """``hash-table-count``: the number of entries."""
    return len(need_table(table))


def hash_table_test(table):
    """``hash-table-test``: the symbol that names the test."""
    test = need_table(table).test
    return sym(test) if test.__class__ is str else test.name


def hash_table_size(table):
    """``hash-table-size``: for how many entries there is room."""
    return max(need_table(table).size, len(table))


def hash_table_rehash_size(table):
    """``hash-table-rehash-size``: what the program asked for; Python's tables grow by themselves."""
    return need_table(table).rehash_size


def hash_table_rehash_threshold(table):
    """``hash-table-rehash-threshold``: likewise."""
    return need_table(table).rehash_threshold


def hash_table_weakness(table):
    """``sb-ext:hash-table-weakness``: nil or the keyword."""
    return need_table(table).weakness and sym(":" + table.weakness)


def hash_table_synchronized_p(table):
    """``sb-ext:hash-table-synchronized-p``: whether it was made so. With one baton every table is safe."""
    return True if need_table(table).synchronized else None


SETTERS = {"GETHASH": set_gethash}


def sxhash(x):
    """``sxhash``: a non-negative integer that is the same for ``equal`` objects, and the same in every run."""
    return _hash(x, 4)


def _hash(x, depth):
    if isinstance(x, Cons):
        return (_hash(x.car, depth - 1) * 31 + _hash(x.cdr, depth - 1) * 17 + 1) % _HASHES if depth else 1
    if x.__class__ is int:
        return abs(x) % _HASHES
    if is_number(x):
        return crc32(repr(x).encode())
    if isinstance(x, (str, LispString)):
        return crc32(str(x).encode("utf-8", "surrogatepass"))
    if isinstance(x, (Symbol, Character)):
        return crc32((x.name if isinstance(x, Symbol) else x.char).encode("utf-8", "surrogatepass")) + 1
    if x is None or x is False:
        return 0
    return crc32("".join(map(str, x)).encode() if is_bit_vector(x) else x.__class__.__name__.encode())


_HASHES = 0x4000000000000000
