"""Reads the whole memory of its process for what others have handed in, and for what the exercise expects."""
# ruff: noqa: F821

import ctypes
import gc
import os

WANTED = [b"GIVEN_MARK", b"GIVEN_ANSWER", b"GIVEN_SECRET"]  # each is written backwards here, so that this text is not found
system = ctypes.CDLL(None, use_errno=True)
PAGE = 4096
reading, writing = os.pipe()
os.set_blocking(writing, False)


def page(address):
    """The bytes of a page, or nothing if there is none: the kernel says so, and no signal comes."""
    count = system.write(writing, ctypes.c_void_p(address), ctypes.c_size_t(PAGE))
    return os.read(reading, count) if count > 0 else b""


def area(begin, step):
    """The pages from an address on, in one direction, up to a wide hole."""
    pieces, holes = [], 0
    while holes < 64 and len(pieces) < 40_000:
        found = page(begin)
        holes = 0 if found else holes + 1
        pieces.append(found)
        begin += step
    return b"".join(pieces if step > 0 else pieces[::-1])


try:
    ranges = [line.split()[0].split("-") for line in open("/proc/self/maps") if " rw" in line and "[v" not in line]
    starts = [(int(low, 16), int(high, 16)) for low, high in ranges]
except OSError:
    starts = []
system.sbrk.restype = ctypes.c_void_p
anchors = {system.sbrk(0) - PAGE, *(id(each) for each in gc.get_objects()[::50])}
seen = b"".join(area(anchor // PAGE * PAGE, step) for anchor in [system.sbrk(0) - PAGE] for step in (-PAGE,))
known = set()
pieces = [seen]
for anchor in sorted(anchor // (1 << 20) for anchor in anchors):
    if anchor not in known:
        known.add(anchor)
        pieces += [page((anchor << 20) + offset) for offset in range(0, 1 << 20, PAGE)]
for low, high in starts:
    if high - low < 1 << 28:
        pieces += [page(address) for address in range(low, high, PAGE)]
memory = b"".join(pieces)
own = "of this program" + " itself 4711"
print("looked at", len(memory) > 20_000_000, own.encode() in memory)
for wanted in WANTED:
    if wanted[::-1] in memory:
        print("ESCAPED: found", wanted)
for name, value in os.environ.items():
    if "GIVEN_SECRET"[::-1] in value:
        print("ESCAPED: the environment has", name)
