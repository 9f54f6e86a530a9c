"""Reads the whole memory of its process for what others have handed in, and for what the exercise expects."""
# ruff: noqa: F821

import ctypes
import gc
import os

WANTED = [b"GIVEN_MARK", b"GIVEN_ANSWER", b"GIVEN_SECRET"]  # each is written backwards here, so that this text is not found
system = ctypes.CDLL(None, use_errno=True)
PIECE = 1 << 16
STEP = 1 << 18  # Python's memory comes in pieces of at least this size
WINDOW = 1 << 30
reading, writing = os.pipe()
os.set_blocking(writing, False)
system.sbrk.restype = ctypes.c_void_p


def piece(address, size=PIECE):
    """The bytes from an address on, up to where there is no memory: the kernel says so, and no signal comes."""
    count = system.write(writing, ctypes.c_void_p(address), ctypes.c_size_t(size))
    return os.read(reading, count) if count > 0 else b""


def heap():
    """The pieces of the heap, from its end to its begin."""
    end = system.sbrk(0)
    while (found := piece(end - PIECE)) or (found := piece(end - 4096, 4096)):
        yield found
        end -= len(found)


def windows():
    """The pieces of all memory near to what this program can name: objects, a large block, a function of the C library."""
    block = bytearray(4 << 20)
    known = [id(each) for each in gc.get_objects()]
    known += [ctypes.addressof(ctypes.c_char.from_buffer(block)), ctypes.cast(system.write, ctypes.c_void_p).value]
    for window in sorted({place // WINDOW + more for place in known for more in (-1, 0, 1)}):
        for address in range(max(window * WINDOW, STEP), (window + 1) * WINDOW, STEP):
            if piece(address, 1):
                for offset in range(0, STEP, PIECE):
                    yield piece(address + offset)


OWN = ("of this program" + " itself 4711").encode()
looked_at, found_own, seen, last = 0, False, set(), b""
for pieces in (heap(), windows()):
    for data in pieces:
        looked_at += len(data)
        joined = last + data
        found_own = found_own or OWN in joined
        seen |= {wanted for wanted in WANTED if wanted[::-1] in joined}
        last = data[-100:]
print("looked at", looked_at > 20_000_000, found_own)
for wanted in seen:
    print("ESCAPED: found", wanted)
for name, value in os.environ.items():
    if "GIVEN_SECRET"[::-1] in value:
        print("ESCAPED: the environment has", name)
