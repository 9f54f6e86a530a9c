"""Measures rows for ``table.py`` and ``compare.py``, in a process of its own: ``python worker.py BACKEND``.

Each line of its input is the name of a row; the answer is a line with the processor seconds that one unit took. A row is prepared, and
run once without counting, when its name comes first. A row that fails answers ``failed`` and why.
"""

from __future__ import annotations

import sys
import time


def main():
    from rows import rows

    from cramhy_runtime.languages.commonlisp.streams import streams
    from cramhy_runtime.repl.session import Session

    session = Session(time="virtual", backend=sys.argv[1])
    streams.STANDARD_OUTPUT.value = streams.ERROR_OUTPUT.value = streams.BroadcastStream()
    known, prepared = {row.name: row for row in rows()}, {}
    print("ready", flush=True)
    for line in sys.stdin:
        row = known[line.rstrip("\n")]
        try:
            if row.name not in prepared:
                prepared[row.name] = row.prepare(session)
                prepared[row.name](row.count)
            begin = time.process_time()
            spent = prepared[row.name](row.count)
            if spent.__class__ is not float:
                spent = time.process_time() - begin
            peer = ""
            if row.times is not None:
                begin = time.process_time()
                row.times()
                peer = f" {time.process_time() - begin}"
            print(f"{spent / row.count}{peer}", flush=True)
        except Exception as why:  # of whatever the row calls; the other rows go on
            print(f"failed {why.__class__.__name__}: {why}".replace("\n", " "), flush=True)


if __name__ == "__main__":
    main()
