"""Reads each file that it can reach: of other submissions, of the exercise, of the system, of other processes."""
# ruff: noqa: F821

import os

WANTED = [word[::-1].encode() for word in ("GIVEN_MARK", "GIVEN_ANSWER", "GIVEN_SECRET")]
GIVEN = [GIVEN_PLACES]
count = 0


def look(path, kind):
    global count
    try:
        with open(path, "rb") as file:
            data = file.read(2_000_000)
    except OSError:
        return
    count += 1
    if kind or any(word in data for word in WANTED):
        print("ESCAPED: read", path)


for path in GIVEN:
    look(path, True)
for path in ("/etc/passwd", "/etc/hostname", "/etc/shadow", "/root/.bashrc", "/proc/1/environ", "/var/log/dpkg.log", "/proc/cmdline"):
    look(path, True)
try:
    processes = [name for name in os.listdir("/proc") if name.isdigit()]
except OSError:
    processes = [str(number) for number in range(1, 2000)]
for process in processes:
    for name in ("environ", "cmdline", "maps", "mem"):
        look(f"/proc/{process}/{name}", process != str(os.getpid()))
look("/proc/self/environ", False)
look(f"/proc/{os.getppid()}/environ", True)
for root in ("/tmp", "/home", "/run", "/dev/shm", "/var/tmp", *GIVEN_ROOTS):
    for place, _, names in os.walk(root):
        for name in names:
            if name.endswith((".toml", ".py", ".lisp", ".md", ".txt", ".hy")) and place != os.getcwd():
                look(os.path.join(place, name), False)
print("looked at", count > 50)
