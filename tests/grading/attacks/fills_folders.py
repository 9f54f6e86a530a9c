"""Leaves what is hard to find, to count and to remove."""
# ruff: noqa: F821

import mmap
import os
import resource
import sys

os.umask(0)


def attempt(name, work):
    try:
        work()
    except (OSError, ValueError) as problem:
        print(name, type(problem).__name__)
        return
    print(name, "done")


def unreadable():
    os.mkdir("d", 0o300)
    os.close(os.open("d/hidden", os.O_CREAT | os.O_WRONLY, 0))
    os.mkdir("e", 0)
    os.mkdir("f", 0o300)
    os.mkdir("f/g", 0)


def links():
    for number, place in enumerate(["/", "GIVEN_OUTSIDE", "..", "/etc"]):
        os.symlink(place, f"link{number}")
        os.mkdir(f"in{number}")
        os.symlink(place, f"in{number}/link")


def long_names():
    here = os.open(".", os.O_RDONLY)
    try:
        for _ in range(30):
            os.mkdir("n" * 250)
            os.chdir("n" * 250)
            os.close(os.open("x" * 250, os.O_CREAT | os.O_WRONLY, 0o200))
    finally:
        os.fchdir(here)


def deep():
    here = os.open(".", os.O_RDONLY)
    try:
        for _ in range(4000):
            os.mkdir("a")
            os.chdir("a")
    finally:
        os.fchdir(here)


def many():
    for number in range(50_000):
        os.close(os.open(f"m{number}", os.O_CREAT | os.O_WRONLY))


def unlinked():
    kept = []
    for number in range(1000):
        file = open(f"u{number}", "w+b")
        file.truncate(0)
        file.write(b"x" * 3_900_000)
        file.flush()
        os.unlink(file.name)
        try:
            kept.append(mmap.mmap(file.fileno(), 4096))
            file.close()
        except OSError:
            kept.append(file)
    raise SystemError("ESCAPED: unlinked files of 4 GB")


def memory_file():
    kept = [os.memfd_create(f"{number}") for number in range(40)]
    for each in kept:
        os.write(each, b"x" * 3_900_000)
    print("ESCAPED: memory that nobody counts")


def shared_memory():
    import ctypes

    system = ctypes.CDLL(None)
    if system.shmget(0, ctypes.c_size_t(64_000_000), 0o1600) >= 0 and not GIVEN_OWN_MEMORY:
        print("ESCAPED: shared memory stays behind")
    for path in ("/dev/shm/x", "/var/tmp/x", "/run/x", "/x", "/usr/x", "GIVEN_OUTSIDE/x", sys.prefix + "/x", "/dev/mqueue/x"):
        try:
            open(path, "w").close()
            print("ESCAPED: wrote", path)
        except OSError:
            pass


def limits():
    for name in dir(resource):
        if name.startswith("RLIMIT"):
            soft, hard = resource.getrlimit(getattr(resource, name))
            try:
                resource.setrlimit(getattr(resource, name), (hard, resource.RLIM_INFINITY))
                hard != resource.RLIM_INFINITY and print("ESCAPED: raised", name)
            except (ValueError, OSError):
                pass


for each in [GIVEN_WHICH]:
    attempt(each.__name__, each)
print("went on")
