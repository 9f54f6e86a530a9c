"""``cramhy browser``: the course as static files, for a browser's tab."""

from __future__ import annotations

import contextlib
import sys

from cramhy_runtime import storage


def run(options):
    """Write the site, or show it, or both; the exit status."""
    from cramhy_runtime.browser import bundling, pyodide_files, site

    if not options.out and not options.serve:
        print("cramhy: Say what to do: --out FOLDER writes the site, and --serve FOLDER shows it.", file=sys.stderr)
        return 2
    try:
        if options.out:
            _write(options)
        if options.serve:
            _serve(options)
    except (site.SiteError, pyodide_files.UnfitPyodide, bundling.NoBundle) as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 1
    except OSError as problem:
        print(f"cramhy: the site cannot be written into {options.out}: {storage.why(problem)}", file=sys.stderr)
        return 1
    return 0


def _write(options):
    from cramhy_runtime.browser import pyodide_files, site

    out = site.write(options.out, options.pyodide or pyodide_files.FETCHED / "pyodide")
    size = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
    print(f"Wrote {out}: {size / 1e6:.1f} MB. Any static server shows it, such as: cramhy browser --serve {out}", flush=True)


def _serve(options):
    from cramhy_runtime.browser import local_host
    from cramhy_runtime.view import page

    with local_host.open_host(options.serve, options.port) as host, contextlib.suppress(KeyboardInterrupt):
        print(f"The course is at {local_host.address(host)} until you press Ctrl-C.", flush=True)
        if page.has_screen():
            with contextlib.suppress(OSError):  # the address has been told
                page.browse(local_host.address(host))
        host.serve_forever()
