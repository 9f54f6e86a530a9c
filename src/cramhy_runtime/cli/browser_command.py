"""``cramhy browser``: the course as static files, for a browser's tab."""

from __future__ import annotations

import sys

from cramhy_runtime import storage


def run(options):
    """Write the site; the exit status."""
    from cramhy_runtime.browser import bundling, pyodide_files, site

    try:
        out = site.write(options.out, options.pyodide or pyodide_files.FETCHED / "pyodide")
    except (site.SiteError, pyodide_files.UnfitPyodide, bundling.NoBundle) as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 1
    except OSError as problem:
        print(f"cramhy: the site cannot be written into {options.out}: {storage.why(problem)}", file=sys.stderr)
        return 1
    size = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
    print(f"Wrote {out}: {size / 1e6:.1f} MB. Any static server shows it, such as: python -m http.server --directory {out}")
    return 0
